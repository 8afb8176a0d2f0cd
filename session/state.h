// What a session holds beside its mesh.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hextwist/command/group.h"
#include "hextwist/io/extras.h"
#include "hextwist/mesh/smooth/smooth.h"
#include "hextwist/patch/verify.h"
#include "hextwist/sizing/fields/size_field.h"

namespace hextwist {

struct Levelling;
struct PeriodicBoundary;

enum class Glue { automatic, on, off };
/// Are the libraries of others fenced in where they read files? Automatic: where the program for it is there.
enum class Fenced { automatic, on, off };

/// What is known of mesh and model, and is brought back with them by `undo`. Cheap to copy: the heavy parts are shared
/// and never change.
struct ModelState {
  std::shared_ptr<const Association> tags;   ///< what the mesh file said; null once the mesh was refined
  std::shared_ptr<const FileExtras> extras;  ///< what the mesh file said beyond; null: nothing
  std::filesystem::path cad_file;            ///< empty: the model did not come from a file
  bool has_cad = false;                      ///< false: no model, or the skin of the mesh
  bool glued = false;
  Measured measured;
  double cad_volume = 0;
  /// Nodes that smoothing leaves where they are, ascending; null: none.
  std::shared_ptr<const std::vector<Index>> fixed_nodes;
  /// Smoothing schemes of CAD entities that were given one; null: none.
  std::shared_ptr<const std::vector<std::pair<Owner, SmoothScheme>>> schemes;
  std::shared_ptr<const std::vector<Group>> groups;  ///< by ascending id; null: none
  std::shared_ptr<const PeriodicBoundary> periodic;  ///< surfaces that repeat others; null: none
  std::shared_ptr<const Levelling> levelling;        ///< how the mesh came out of its base; null: it is one
};

/// All but the mesh that a command may change; copied before each, so that a failure can put it back.
struct SessionState : ModelState {
  /// Sizing functions by name, and the one that was defined last.
  struct NamedSize {
    SizeFieldPtr field;
    std::string text;  ///< the command that made it
  };
  std::map<std::string, NamedSize> sizing;
  std::string last_sizing;

  Glue glue = Glue::automatic;
  double feature_angle = 35;            ///< degrees
  int order = 0;                        ///< of meshes that are written; 0: as they were read
  double tolerance = 1e-5;              ///< of a mesh on its CAD, relative to the model size
  bool untangle = true;                 ///< repair inverted hexes of a mesh that is read
  std::vector<std::string> keep_jumps;  ///< hex fields whose jumps smoothing leaves in place
  Fenced fenced = Fenced::automatic;
  double reading_seconds = 0, reading_megabytes = 0;  ///< limits there; 0: by the size of the file
  bool snap = true;                                   ///< put its boundary nodes on the CAD
  bool finished = false;
};

}  // namespace hextwist
