// Abaqus input files: what the keywords say, before it becomes a mesh.
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "hextwist/io/format.h"

namespace hextwist::io {

/// Faces S1..S6 of a C3D8 by their nodes (Abaqus Elements Guide, "Three-dimensional solid element library").
inline constexpr std::array<int, 6> abaqus_face = {
    face_of_file_corners({1, 2, 3, 4}), face_of_file_corners({5, 8, 7, 6}), face_of_file_corners({1, 5, 6, 2}),
    face_of_file_corners({2, 6, 7, 3}), face_of_file_corners({3, 7, 8, 4}), face_of_file_corners({4, 8, 5, 1})};

/// A name or number as it stands in a set or surface; the instance it belongs to, where it says so.
struct AbaqusMember {
  std::string text;
  const char* at;
};

/// *NSET, *ELSET, *SURFACE. Ids are plain numbers; everything else is resolved when all is read.
struct AbaqusSet {
  enum Kind { nodes, elements, surface } kind;
  std::string name;      ///< as written
  std::string instance;  ///< of assembly sets
  std::vector<std::int64_t> ids;
  std::vector<AbaqusMember> members;                                  ///< names of sets, or Instance.17
  std::vector<std::pair<AbaqusMember, std::string>> surface_members;  ///< set or element, face label
  const char* at;
};

/// What stands between *PART and *END PART, or *ASSEMBLY and *END ASSEMBLY, or outside of both.
struct AbaqusScope {
  std::string name;
  std::vector<std::int64_t> node_ids;
  std::vector<Vec3> points;
  std::vector<Run> node_runs;
  std::vector<std::int64_t> hex_ids, hex_nodes;
  std::vector<const char*> hex_at;
  std::vector<std::int64_t> quad_ids, quad_nodes;
  std::vector<std::int64_t> other_ids;  ///< beams, triangles, ...
  std::vector<AbaqusSet> sets;
};

struct AbaqusInstance {
  std::string name;
  AbaqusScope* part;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Vec3 shift = Vec3::Zero();
};

struct AbaqusContents {
  std::vector<std::unique_ptr<Bytes>> sources;       ///< the file and what it includes; positions point into these
  std::vector<std::unique_ptr<AbaqusScope>> scopes;  ///< first: outside of parts and the assembly
  AbaqusScope* assembly = nullptr;
  std::vector<AbaqusInstance> instances;
  /// From comments of our own: kind, name of the set in upper case -> id and real name.
  std::map<std::pair<std::string, std::string>, std::pair<int, std::string>> real_names;
  std::map<std::string, std::int64_t> n_dropped;
  bool ours = false;

  [[noreturn]] void fail(const char* at, const std::string& what) const;
};

MeshFile assemble_abaqus(AbaqusContents&& contents);
std::string upper_case(std::string_view text);

}  // namespace hextwist::io
