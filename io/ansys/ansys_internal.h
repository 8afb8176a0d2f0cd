// ANSYS archives, .cdb: the blocks that CDWRITE makes (Mechanical APDL, Programmer's Reference, "CDWRITE", "NBLOCK",
// "EBLOCK", "CMBLOCK").
#pragma once

#include "hextwist/io/listing.h"

namespace hextwist::io {

/// SOLID186: the lower ring, the upper ring, the pillars.
inline constexpr const MiddleOrder& ansys_middles = vtk_middles;

inline constexpr int ansys_solid_8 = 185, ansys_solid_20 = 186, ansys_surface = 154;

/// What is made of the elements of a type, by its number in the name (SOLID185).
enum class AnsysShape { hex, quad, tetrahedron, other };
AnsysShape ansys_shape(int type);

/// Fields of a line as its block's format says: "(3i9,6e21.13e3)".
struct AnsysFormat {
  std::size_t n_integers = 0, integer_width = 0, n_reals = 0, real_width = 0;
};

/// Numbers of hexes in EBLOCK beside the type, as fields are called that have them (io/hex_numbers.h).
inline constexpr std::array<const char*, 4> ansys_columns = {"material", "real", "section", "esys"};

/// The materials of hexes where no field says them: the ids of their blocks, and another where that is none.
struct AnsysMaterials {
  std::vector<int> of_hex;
  int nobody = 0;  ///< of hexes in no block, or in block 0; 0: there are none
};
AnsysMaterials ansys_materials(const Mesh& mesh);

}  // namespace hextwist::io
