// What reading and writing of MED share: the order of nodes, and names of fixed length.
#pragma once

// MED was made with MPI in some places, and its header wants that without including it.
#include <mpi.h>

#include <med.h>

#include "hextwist/io/listing.h"

namespace hextwist::io {

/// MED goes round the lower ring of a hex the other way: its node i is number med_corner[i] of other files (VTK). Of
/// the middle nodes that follow, as VTK has them, likewise. Both are their own inverses.
inline constexpr std::array<std::size_t, 8> med_corner = {0, 3, 2, 1, 4, 7, 6, 5};
/// Middle nodes in MED's order (ring, ring, pillars; faces 1234 1265 2376 3487 4158 5678; centre), by our corners.
inline constexpr MiddleOrder med_middles =
    middle_order({{{1, 4}, {4, 3}, {3, 2}, {2, 1}, {5, 8}, {8, 7}, {7, 6}, {6, 5}, {1, 5}, {4, 8}, {3, 7}, {2, 6}}},
                 {{{1, 4, 3, 2}, {1, 4, 8, 5}, {4, 3, 7, 8}, {3, 2, 6, 7}, {2, 1, 5, 6}, {5, 8, 7, 6}}});

/// Elements beside the hexes (mesh/others.h). MED goes round them the other way too: its node i is number order[i].
struct MedOther {
  med_geometry_type type;
  OtherShape shape;
  std::size_t n_nodes;
  const char* name;
  std::array<std::size_t, 6> order;
};
inline constexpr MedOther med_others[] = {{001, OtherShape::point, 1, "POINT1", {0}},
                                          {102, OtherShape::line, 2, "SEG2", {0, 1}},
                                          {203, OtherShape::triangle, 3, "TRIA3", {0, 2, 1}},
                                          {204, OtherShape::quad, 4, "QUAD4", {0, 3, 2, 1}},
                                          {304, OtherShape::tetrahedron, 4, "TETRA4", {0, 2, 1, 3}},
                                          {305, OtherShape::pyramid, 5, "PYRA5", {0, 3, 2, 1, 4}},
                                          {306, OtherShape::wedge, 6, "PENTA6", {0, 2, 1, 3, 5, 4}}};

/// Open until it goes out of scope.
class MedFile {
 public:
  MedFile(const std::filesystem::path& file, med_access_mode mode) : id_(MEDfileOpen(file.c_str(), mode)) {}
  ~MedFile() {
    if (id_ >= 0) MEDfileClose(id_);
  }
  MedFile(const MedFile&) = delete;
  med_idt id() const { return id_; }
  bool close() { return MEDfileClose(std::exchange(id_, -1)) >= 0; }

 private:
  med_idt id_;
};

/// Text of a fixed length, as the library reads and writes it.
inline std::string med_text(std::string text, std::size_t length) {
  text.resize(length, '\0');
  return text;
}

}  // namespace hextwist::io
