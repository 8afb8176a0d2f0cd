// What `with` asks of entities: `length > 3 and (is_planar or not x_min < 0)`.
//
// From tight to loose: parentheses, minus sign, * /, + -, comparisons, not, then and/or from left to right. `with` may
// be repeated behind and/or. A comparison for equality holds within a tolerance (`= 5 tolerance 1e-3`; without:
// rounding).
#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hextwist/command/token.h"
#include "hextwist/mesh/entity.h"

namespace hextwist {

struct RangeTerm;
class Reader;

/// What can be asked about an entity.
enum class Attribute {
  id,
  x_coord,  ///< of a node or vertex; else of the middle: of the corners, or of the box, brought onto the CAD entity
  y_coord,
  z_coord,
  x_min,  ///< of the box
  y_min,
  z_min,
  x_max,
  y_max,
  z_max,
  length,
  area,
  volume,
  radius,  ///< of a circle, cylinder, sphere or the tube of a torus; else 0
  quality,
  is_planar,
  is_spline,
  is_meshed,
  element_count,  ///< mesh entities of its own dimension
  num_parents,    ///< CAD entities of the next dimension that it bounds
  block_assigned,
  is_hole,  ///< a curve of a loop inside another around the same surface
  name,
};

struct AttributeSpec {
  Attribute attribute = Attribute::id;
  std::string_view word;
  unsigned kinds = 0;             ///< bit k: makes sense for EntityKind k
  bool is_truth = false;          ///< true or false rather than a number
  bool is_length = false;         ///< measured in model units
  std::string_view spelled = {};  ///< for which the word is another spelling
};
std::span<const AttributeSpec> attributes();

/// A node of an expression.
struct Criterion {
  enum class Op {
    number,     ///< value
    truth,      ///< value 0 or 1
    attribute,  ///< attribute; of the entity in `of` if there is one. text: metric of quality
    named,      ///< name matches text
    negate,
    add,
    subtract,
    multiply,
    divide,
    less,
    less_equal,
    greater,
    greater_equal,
    equal,
    not_equal,
    not_,
    and_,
    or_,
  };
  Op op = Op::truth;
  double value = 1;
  double tolerance = std::numeric_limits<double>::quiet_NaN();  ///< of equal and not_equal; NaN: rounding
  Attribute attribute = Attribute::id;
  std::string text;
  std::vector<Criterion> operands;
  std::vector<RangeTerm> of;
  Token token;
};

/// Reads what stands behind `with`. Throws CommandError where it makes no sense for the kind, or is no condition.
Criterion read_criterion(Reader& reader, EntityKind kind);
/// Reads one attribute that is a number, as behind `largest 3 by`.
Criterion read_measure(Reader& reader, EntityKind kind);
/// As the language writes it, with the parentheses it needs.
std::string to_string(const Criterion& criterion);

}  // namespace hextwist
