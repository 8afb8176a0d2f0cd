// Meshes that are split into files, and how they become one file or several.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hextwist/base/fence.h"
#include "hextwist/io/file_part.h"
#include "hextwist/io/io.h"
#include "hextwist/parts/partition.h"

namespace hextwist {

/// The name of a split mesh from that of any of its parts: "mesh.e" of "mesh.e.8.3", "mesh.msh" of "mesh_2.msh" where
/// Gmsh has put one part into that. n_parts 0: it is no such file.
struct SplitName {
  std::filesystem::path name;
  int n_parts = 0;
};
SplitName split_name(const std::filesystem::path& part);

/// Reads all parts. Throws Error naming the file: one is missing, belongs to another mesh, has another number of parts,
/// or the parts do not make up what they say they are parts of.
MeshFile read_parts(const std::filesystem::path& any_part, const Fence& fence = {});

/// Refining asks for more than joining does (refuse_more()).
enum class PartUse { join, refine };
/// Reads one of them; of what comes beside the mesh what is of the whole (results_of_parts()). first: what the parts
/// before say of the whole; none was read yet where its n_parts is 0. Throws Error as above.
Mesh read_one_part(const SplitName& split, int part, PartHead& first, std::vector<std::string>& notices,
                   const Fence& fence = {}, PartUse use = PartUse::join);

/// Throws Error where all parts together do not have what they say (`said`) of the whole.
void check_counts(const SplitName& split, const PartHead& said, std::int64_t n_nodes, std::int64_t n_hexes);

/// Throws Error where a part, by itself, is no mesh that can be refined. name: what messages call it.
void check_part(const Mesh& part, const std::string& name);
/// Throws Error where parts would lose what a mesh has, or refine it in another way than a single process. extras: what
/// its file said beyond, null where that is nothing.
void refuse_more(const Mesh& mesh, const FileExtras* extras, const std::string& name);
/// Fills in ids that were left out.
void need_ids(Mesh& mesh);

/// Reads a mesh and writes it in parts, as PartOutput names them; slice by slice where the file can be read so
/// (split_on_disk()), but for SCOTCH, which looks at all of it. Returns what is to be said, one line each; throws
/// Error, then no part was written.
std::vector<std::string> split_file(const std::filesystem::path& mesh, const std::filesystem::path& name, int n_parts,
                                    PartitionBy by, const Fence& fence = {});
inline constexpr const char* without_owners = "parts are made without the owners that the file names: left out";
inline constexpr const char* joined_without_owners = "parts are joined without the owners that they name: left out";
/// "1000 hexes in 8 parts of at most 125, 300 faces between them"
std::string split_text(std::int64_t n_hexes, int n_parts, std::int64_t largest, std::int64_t n_shared_faces);
/// Reads parts and writes one file, with a part in memory at a time where that can be done (join_on_disk()).
std::vector<std::string> join_files(const std::filesystem::path& any_part, const std::filesystem::path& to,
                                    const Fence& fence = {});

/// "1000 hexes and 1331 nodes of 8 parts"
std::string joined_text(std::int64_t n_hexes, std::int64_t n_nodes, int n_parts);

}  // namespace hextwist
