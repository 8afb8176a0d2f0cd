#include <cmath>

#include "hextwist/base/text.h"
#include "hextwist/command/select/nothing_left_internal.h"

namespace hextwist {

std::string nothing_left(const Selector& selector, const Statement& statement, EntityKind kind,
                         const RangeFilter& filter, const std::vector<Index>& before) {
  const std::string all = before.size() == 1
                              ? "the one " + std::string(name(kind)) + " that is left"
                              : "none of the " + std::to_string(before.size()) + " " + std::string(plural(kind));
  using Kind = RangeFilter::Kind;
  const std::string does = before.size() == 1 ? all + " does not " : all + " ";
  if (filter.kind == Kind::except) return "'except' takes away all of them";
  if (filter.kind != Kind::with) {
    const bool one = before.size() == 1;
    const auto verb = [&](const char* many, const char* single) { return does + (one ? single : many); };
    if (filter.kind == Kind::in || filter.kind == Kind::adjacent)
      return verb("lies in or touches those", "lie in or touch those");
    if (filter.kind == Kind::common_to) return verb("belongs to each of those", "belong to each of those");
    if (filter.kind == Kind::field) return verb("has such values", "have such values");
    if (filter.kind == Kind::inside) return verb("has its middle in there", "have its middle in there");
    return verb("does", "do");
  }
  const Criterion& c = filter.criterion;
  std::string line = does + (before.size() == 1 ? "meet '" : "meets '") + to_string(c) + "'";
  // Of a comparison with a number: the value that comes nearest.
  const Criterion* measure = nullptr;
  double bound = 0;
  for (int side = 0; side < 2 && c.operands.size() == 2; ++side)
    if (c.operands[side].op == Criterion::Op::attribute && c.operands[1 - side].op == Criterion::Op::number) {
      measure = &c.operands[side];
      bound = c.operands[1 - side].value;
    }
  if (!measure) return line;
  const std::vector<double> values = values_of(selector, statement, kind, *measure, before);
  std::size_t best = 0;
  for (std::size_t k = 1; k < values.size(); ++k)
    if (std::abs(values[k] - bound) < std::abs(values[best] - bound)) best = k;
  return line + "; " + std::string(name(kind)) + " " + std::to_string(id_of(selector, kind, before[best])) +
         " comes nearest with " + short_number(values[best]);
}

}  // namespace hextwist
