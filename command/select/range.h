// Ranges as written: `1 3 to 17 by 2 except 5 in volume 2 with x_coord > 3`. What they mean is decided in selection.h.
//
//   range      list filter ...                                        an empty list stands for all
//   list       {id [to id [by step]] | name | all | (at x y z [ordinal n]) | (within r of x y z)} ...
//   filter     {in | common_to | adjacent to} term [kind range] ...  |  with criterion  |  except {list | kind range}
//              in field "name" {above v | below v | top p [%]}  |  {largest | smallest} n by attribute
//              in {box corner corner | sphere x y z radius r | cylinder x y z to x y z radius r}
//              {parallel | perpendicular} to {x | y | z | term}  |  [in] loop of surface id [(at x y z)]  |  chain from
//              term
//   term       kind range | name | ( {kind range | name} ... )
//
// What binds to what: `except` belongs to the list of ids before it, and so does a kind word behind it; `in` and
// `common_to` go with the kind before them, from right to left (hex in face in surface 2); `with` looks at the entities
// that the whole range is about, unless it follows a kind that has no ids of its own (curve in surface with area > 3).
// Parentheses around a term end its range.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "hextwist/command/select/criterion.h"
#include "hextwist/command/token.h"
#include "hextwist/mesh/entity.h"

namespace hextwist {

/// One id, one span of ids, a name, everything, or the entity nearest to a point.
struct RangeItem {
  enum class Kind { id, span, name, all, at, within };
  Kind kind = Kind::all;
  std::int64_t first = 0, last = 0, step = 1;  ///< of an id (first) or a span; of `at`, first is the ordinal
  std::string name;                            ///< may hold the wildcards * and ?
  std::array<double, 3> point = {};            ///< of `at` and `within`
  double distance = 0;                         ///< of `within`
  Token token;                                 ///< where it starts
  Token last_token;                            ///< of a span: its end
};

struct RangeTerm;

/// What the entities of a list must be, besides being in it.
struct RangeFilter {
  enum class Kind {
    in,         ///< lie in, or touch, any of the terms
    common_to,  ///< lie in, or touch, each entity of the terms
    with,       ///< meet the criterion
    except,     ///< are none of the term, which is of the same kind
    field,      ///< have values of a field of the mesh that pass the test
    adjacent,   ///< meet any of the terms without being one of them
    parallel,   ///< run, or lie, as the terms or the axis `field` (x, y, z) do
    perpendicular,
    loop,    ///< curves of one loop around the surface of the term: the outer one, or the one nearest to `point`
    chain,   ///< go on smoothly from the terms, and from there, and so on
    most,    ///< those with the largest (test is top) or smallest values of the criterion, `value` of them
    inside,  ///< have their middle in the solid `field` (box, sphere, cylinder) of `numbers`
  };
  enum class Test { above, below, top, bottom };
  Kind kind = Kind::in;
  std::vector<RangeTerm> terms;
  Criterion criterion;
  std::string field;            ///< its name
  std::vector<double> numbers;  ///< of loop the point, if there is one; of inside two corners, or ends and radius
  Test test = Test::above;      ///< `top`, `bottom`: the largest, smallest so many percent of those so far
  double value = 0;
  Token token;  ///< of the field's name
};

/// The items that pass every filter, one after the other. No items: all.
struct Range {
  std::vector<RangeItem> items;
  std::vector<RangeFilter> filters;
  Token token;  ///< where the range starts
};

/// A kind of entity and which of them: `volume 2`. Or something of that name, of any kind: then the kind means nothing
/// and the range is the one name.
struct RangeTerm {
  EntityKind kind = EntityKind::hex;
  bool any_kind = false;
  Range range;
};

/// The range as the language writes it; parsing that gives the same range.
std::string to_string(const Range& range);
std::string to_string(const RangeTerm& term);

}  // namespace hextwist
