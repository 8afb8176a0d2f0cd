// The levels of a session in a file of their own, so that a program that stops can go on refining and coarsening.
//
//   hextwist levels 1
//   <name> <bytes per item> <number of items>
//   <items, little-endian>                          ... and so on until
//   end 0 0
//
//   base              the base mesh, as a .vtu file
//   base_parameters   two per node of the base: on its curve (t, -) or surface (u, v)
//   base_owners       two 32-bit integers per node: dimension and id of its CAD entity
//   skin_*            without CAD: what the skin was made of that the mesh began with (FacetSource, geom/facet/model.h)
//   base_edges, base_edge_curves, base_faces, base_face_surfaces, base_volumes    then: the rest of who owns what
//   base_meant        three 32-bit integers each: a node set, and dimension and id of what it is meant to hold
//   nodes_per_hex     two 32-bit integers each: block (0: all others) and 8, 20 or 27
//   cells_<k>         64-bit numbers of the cells of level k on which there are marks (refine/levels/cells.h)
//   corners_<k>       8 bits per cell: its marked corners
//   node_ids, hex_ids 64-bit ids of the mesh as it is
//   node_order, hex_order   32-bit: its places level by level (refine/levels/forest.h); none: the same
//   next_ids          64-bit: of nodes and hexes
//   smoothed, smoothed_points, smoothed_parameters    nodes that smoothing has moved, and where to
#pragma once

#include <filesystem>

#include "hextwist/session/transaction.h"

namespace hextwist {

/// Throws Error when there are no levels; otherwise as writers do (io/io.h).
void write_levels(const Transaction& run, const std::filesystem::path& file, bool overwrite);

/// Makes the mesh of the file that of the session, on its CAD. Where the session has a mesh already it must be the same
/// one (by ids; places may be rounded): its fields are kept. Throws Error when it is another, when the file is damaged,
/// or when it does not fit the CAD.
void read_levels(Transaction& run, const std::filesystem::path& file);

}  // namespace hextwist
