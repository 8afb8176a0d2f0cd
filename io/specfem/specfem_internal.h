// The files of a mesh for SPECFEM3D Cartesian, one folder (SPECFEM3D Cartesian, User Manual, "Mesh Generation").
#pragma once

#include "hextwist/io/listing.h"

namespace hextwist::io {

/// Hexes of 27 nodes: edges below, the pillars, edges above; faces below, front, right, back, left, above; the centre.
inline constexpr MiddleOrder specfem_middles = middle_order(
    ring_pillars_ring, {{{1, 2, 3, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 4, 8, 7}, {4, 1, 5, 8}, {5, 6, 7, 8}}});

/// Files of sides, which are the names of their side sets too; the place is the id of a set that is read.
inline constexpr const char* specfem_surfaces[] = {
    "free_or_absorbing_surface_file_zmax", "absorbing_surface_file_xmin", "absorbing_surface_file_xmax",
    "absorbing_surface_file_ymin",         "absorbing_surface_file_ymax", "absorbing_surface_file_bottom"};
/// All other files of a mesh.
inline constexpr const char* specfem_files[] = {"nodes_coords_file", "mesh_file", "materials_file",
                                                "nummaterial_velocity_file"};
/// Elements that absorb, by number; not read.
inline constexpr const char* specfem_cpml = "absorbing_cpml_file";

/// In a line of nummaterial_velocity_file behind all numbers that SPECFEM3D reads: which block a material is.
inline constexpr std::string_view specfem_mark = "! hextwist block ";

}  // namespace hextwist::io
