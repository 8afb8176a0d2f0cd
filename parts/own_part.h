// What a part writes in the end: its own hexes, and what it shares with others.
#pragma once

#include <memory>

#include "hextwist/io/file_part.h"
#include "hextwist/parts/local_mesh.h"

namespace hextwist {

struct OwnPart {
  Mesh mesh;  ///< with its ids
  Association association;
  FilePart file;  ///< counts of the whole are not there yet
  /// Sums over all parts make up the whole: hexes; nodes that no lower part has; the same of each node set; sides of
  /// each side set; hexes of each block.
  std::vector<std::int64_t> counts;
};

/// Others are known from the halo, of which one ring at least must be there. The local mesh is used up.
OwnPart take_own(LocalMesh local, GlobalIds ids, int number, int n_parts);

/// To be summed as well, when the sizes of blocks are known: what the element blocks have of each.
std::vector<std::int64_t> block_shares(const OwnPart& part, std::span<const std::int64_t> counts_of_whole);
/// counts, shares: summed over all parts.
void fill_in_whole(OwnPart& part, std::span<const std::int64_t> counts, std::span<const std::int64_t> shares,
                   std::int64_t highest_id);

/// Throws Error where a name ends as files of another format do, which parts are not written in: they would be Exodus
/// under that name. Endings that no format has are as good as any.
void check_output_name(const std::filesystem::path& name);

/// Files that parts are written to, which are there when all are complete: NAME.n.i (Exodus); where NAME ends in .msh,
/// NAME_i.msh, i from 1, as Gmsh splits meshes; where it ends in .pvtu, NAME_i.vtu and the file NAME that lists them.
class PartOutput {
 public:
  PartOutput(std::filesystem::path name, int n_parts);
  ~PartOutput();
  PartOutput(const PartOutput&) = delete;
  PartOutput& operator=(const PartOutput&) = delete;
  /// Under a name of its own for the time being. Throws Error naming the file.
  void write(const OwnPart& part, std::vector<std::string>& notices);
  /// Those that were written; with part 0 the list.
  void commit();

 private:
  std::filesystem::path piece(int part) const;
  void write_list(const std::filesystem::path& first_piece);
  std::filesystem::path name_;
  int n_parts_;
  bool is_vtk_;
  std::vector<std::unique_ptr<Replacement>> files_;
  std::vector<std::array<std::filesystem::path, 2>> renamed_;  // from, to
};

}  // namespace hextwist
