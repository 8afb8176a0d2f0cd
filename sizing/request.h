// One refinement as asked for: where, how, by which technique, and what is done with the result.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "hextwist/mesh/entity.h"
#include "hextwist/mesh/meshed_model.h"

namespace HEXTWIST_API hextwist {

class SizeField;
struct Levelling;
struct PeriodicBoundary;

/// What is to be refined.
struct Target {
  EntityKind kind = EntityKind::hex;  ///< one of those from node to volume
  /// Mesh entities by index (0-based; edges and faces as numbered by edges() and faces()), CAD entities by id.
  /// Ascending, each once.
  std::vector<Index> ids = {};
  /// Layers of hexes around the target that are refined fully too: 0 exactly the target (for nodes, edges, faces and
  /// what the CAD calls so: the combination technique), 1 every hex that touches it, ... Default: 0; 1 for
  /// Method::single of anything but hexes and volumes, and where levels are graded.
  std::optional<int> depth = std::nullopt;
  /// Instead of depth: hexes whose centroid lies within this distance of the target entity (the CAD entity itself
  /// where it is one).
  std::optional<double> radius = std::nullopt;
};

/// Hexes and volumes are solid targets: they name hexes. All others name nodes, edges and faces.
constexpr bool is_solid(EntityKind kind) {
  return kind == EntityKind::hex || kind == EntityKind::volume;
}

/// Cuts::numsplit is at most this where not all volumes of the model are refined together: 3^8 pieces per edge.
inline constexpr int max_numsplit = 8;

/// Each target edge is cut in three, so often. All volumes of the model together are refined uniformly instead: every
/// edge in numsplit + 1 pieces.
struct Cuts {
  int numsplit = 1;  ///< 1 to max_numsplit; of all volumes 1 to 29
};

/// Until elements have about a wished size: edges are cut while they are longer than sqrt(3) times the wish, so that
/// they end within a factor sqrt(3) of it. A size or a field or both; then the smaller one counts.
struct Sizes {
  /// Wished length of edges, model units, above 0; none: `field` alone.
  std::optional<double> size = std::nullopt;
  /// 1: the size is wished for at the target only (the hexes that depth or radius choose; by default those that touch
  /// it). Above 1: everywhere, growing by bias - 1 per unit of distance from the target entity, so that neighbours grow
  /// by about that factor; depth or radius then limit where. Wished sizes of a field are lowered so that they grow by
  /// at most that much.
  double bias = 1;
  std::shared_ptr<const SizeField> field =
      nullptr;  ///< wished size by place (size_field.h), in the hexes of the target
  /// Where hexes are finer than wished they become coarser, as far as the base of the levels allows: what was cut
  /// before counts no longer. Needs Transition::regular.
  bool coarsen = false;
  /// Sizes are approached in passes that each cut by up to three; after so many the rest is reported as unmet. 1 .. 30.
  int max_passes = 12;
};

/// In one direction only: edges that leave the target (surfaces or faces) are cut in three, numsplit times, and so on
/// from hex to hex to the other side of the mesh.
struct Thickness {
  int numsplit = 1;  ///< 1 .. max_numsplit
};

/// Layers along the target in the hexes that touch it: boundary layers. Of anything but hexes and volumes.
struct Layers {
  int n_layers = 2;  ///< that each of these hexes is cut into, 1 .. 50
  double growth =
      1;  ///< thickness of a layer / thickness of the one before it, which is nearer to the target. 0.1 .. 10
};

/// Instead of a target: the hex sheets (mesh/sheets.h) that edges belong to. Their edges are cut in three, once;
/// nothing else is.
struct AcrossSheets {
  std::vector<Index> edges = {};  ///< as numbered by edges(); each chooses the sheet that cuts it
  /// The sheets that cross those at the edges instead: across the other directions of the hexes around the edges.
  bool crossing = false;
  std::optional<double> greater_than = std::nullopt;  ///< leave edges alone that are no longer than this
  std::optional<double> factor = std::nullopt;        ///< or than this times the shortest edge of the sheets
};

/// Instead of a target: by how many levels each hex is to become finer (> 0) or coarser (< 0). Needs
/// Transition::regular; nothing becomes coarser than the base of the levels.
///  1. finer: the hex becomes 27, and these 27 each, and so on; a piece of a transition first becomes the cell again
///     that it is a piece of;
///  2. coarser: 27 become one again where none of them asks to stay. What only gradation had cut goes by itself.
struct LevelChanges {
  std::vector<std::int8_t> by = {};  ///< per hex
};

/// What is done at the target: one of these.
using How = std::variant<Cuts, Sizes, Thickness, Layers, AcrossSheets, LevelChanges>;

/// Which technique of the paper (table 1).
enum class Method {
  automatic,    ///< single for hexes and volumes and for depth >= 1; combination for all else; with sizes single or
                ///< parallel or combination, whichever comes nearer to them (docs/commands.md has the rule)
  single,       ///< trisecting: section 4
  parallel,     ///< enclosing at half: section 5.1 to 5.3; hexes, volumes and depth >= 1 one into eight (eight.h)
  combination,  ///< enclosing at a third, then trisecting along the target: section 5.4
};
/// "auto", "single", "parallel", "combination".
const char* name(Method method);

/// What to do where a region is concave: templates of their own, or filling it up as the paper does (section 4.3).
enum class Concave {
  templates,  ///< no hex joins the region: it stays as small as asked for
  fill,       ///< hexes join the region until it is convex
};

/// What becomes of the transition around hexes that are cut as a whole, when what is in it or next to it is cut again.
enum class Transition {
  /// Regular, but for sizes on a base either, whichever comes nearer to the wish: regular where nested shapes would be
  /// poor.
  automatic,
  /// Its pieces are never cut: the cell of which they are pieces is cut instead, and the transition moves outwards.
  /// More
  /// hexes; quality does not depend on how often, where and in which order hexes are cut (docs/design.md, "Levels").
  regular,
  /// They are cut like all others. Fewer hexes; the smallest scaled Jacobian falls to about a tenth with each level.
  nested,
};

/// What is done besides cutting.
struct Finish {
  bool smooth = false;            ///< smooth the new hexes and two layers around them (smooth.h) after the last pass
  std::vector<Index> fixed = {};  ///< nodes (0-based) that neither smoothing nor the repair of children moves
  bool dry_run = false;           ///< count only: the result holds no mesh
  /// Keep the hex field "level", which says how often the cell that a hex is, or is a piece of, was cut out of others.
  bool level_field = false;
  /// Fields of hexes whose sum stays (others are copied, and averaged where hexes become coarser). With levels.
  std::vector<std::string> extensive = {};
  /// Hex fields whose jumps smoothing leaves in place (SmoothOptions).
  std::vector<std::string> keep_jumps = {};
  /// New nodes that can't be put on their curve or surface are left off it, and told.
  bool allow_off_cad = false;
  /// Surfaces that repeat others, and still do afterwards; null: none. What can't keep that is refused by name.
  std::shared_ptr<const PeriodicBoundary> periodic = nullptr;
};

/// All that refine() wants to know beside the mesh. What does not go together is refused by name.
struct Request {
  Target target = {};                             ///< where; not looked at by AcrossSheets and LevelChanges
  How how = Cuts{};                               ///< how fine, or in which direction
  Method method = Method::automatic;              ///< by which technique
  Concave concave = Concave::templates;           ///< whether the region may grow
  Transition transition = Transition::automatic;  ///< what becomes of transitions that are cut again
  /// How the input came out of its base (RefineResult::levelling). Null: it is a base, and nobody asks for more than
  /// the result.
  std::shared_ptr<const Levelling> levelling = nullptr;
  Finish finish = {};  ///< what else is done
};

}  // namespace hextwist
