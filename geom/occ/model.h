// CAD from files or from memory through OpenCASCADE.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "hextwist/base/fence.h"
#include "hextwist/geom/model.h"

class TopoDS_Shape;  // OpenCASCADE's; no header of its is reached from here

namespace HEXTWIST_API hextwist {

/// How CAD is read.
struct CadOptions {
  /// Make touching solids of an assembly share their common faces, edges and vertices (a STEP file with several
  /// solids keeps them apart). What was merged is reported in `notices`.
  bool glue = false;
  /// Distance in model units within which faces count as touching; 0: the tolerance of the CAD itself.
  double glue_tolerance = 0;
  /// Where files are read. Default: in this process, which OpenCASCADE can end (segmentation fault), stop (endless
  /// loop) or fill with a damaged file; a Session and the program read in a process of its own.
  Fence fence = {};
};

/// A model and notices about its making (units, merged faces, healed edges), one line each.
struct CadImport {
  std::shared_ptr<const Model> model;  ///< never null
  std::vector<std::string> notices;    ///< empty: there is nothing to say
};

/// Reads .step/.stp, .brep, .iges/.igs (by extension, case ignored; by content where it is missing).
/// Entity ids: 1-based per kind in the order of TopExp::MapShapes over the shape as read (after gluing, if asked).
/// Degenerate edges (sphere poles, cone tips) are curves too: of type "degenerate", length 0, range 0..1, one point.
/// STEP and IGES lengths become millimetres, as OpenCASCADE and Gmsh have it; BREP has no unit.
/// Names come from STEP, and from IGES those of volumes and surfaces (properties, or labels of eight letters).
/// A file without solids whose faces close is sewed into solids, with a notice.
/// Throws Error naming the file when it is missing, unreadable, truncated, damaged, empty or has no solid, and, behind
/// a fence, when reading it crashes or exceeds the limits.
CadImport read_cad(const std::filesystem::path& file, const CadOptions& options = {});

/// The same for a shape in memory. The shape is shared, not copied, and must not be changed while the model lives.
CadImport cad_from_shape(const TopoDS_Shape& shape, const CadOptions& options = {});

/// The same model with touching solids glued (CadOptions::glue), and notices about that alone; ids may be others.
/// Throws Error if it did not come from OpenCASCADE.
CadImport glued(const Model& model, double tolerance = 0);

/// The same model without curves shorter than `length` and surfaces narrower than that, which are merged into those
/// beside them; ids may be others. Without a notice nothing was, as there are none or solids would not stay sound.
/// Throws Error if it did not come from OpenCASCADE.
CadImport without_slivers(const Model& model, double length);

/// Writes the shape behind a model made by the functions above; format by extension (.step, .brep, .iges).
/// Throws Error if the model did not come from OpenCASCADE or the file can't be written.
void write_cad(const std::filesystem::path& file, const Model& model);

}  // namespace hextwist
