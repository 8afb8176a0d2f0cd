// Nodal values of nodes that several parts have. Programs that write their parts themselves sum in their own order, so
// such values may differ by a last bit, or be there in one part only; then parts could not agree about what comes of
// them. The lowest part that has a number there is right, for all of them.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "hextwist/mesh/meshed_model.h"

namespace hextwist {

/// By the name of the field: ids of the nodes where parts have different values of it.
using Disagreements = std::map<std::string, std::vector<std::int64_t>>;
/// One line for each field. name: what messages call the mesh. The ids are in any order, and may be there several
/// times.
std::vector<std::string> disagreement_lines(Disagreements differ, const std::string& name);

/// Takes the value of the next part along: `kept` becomes that where there was no number yet. Returns whether the two
/// are different values; all that are no numbers are the same.
bool settle_value(double& kept, double next);

/// Parts one after the other, the lowest first.
class SharedValues {
 public:
  /// ids: of the nodes that several parts have, ascending.
  explicit SharedValues(std::vector<std::int64_t> ids) : ids_(std::move(ids)) {}
  /// Gives the part the values that are right, as far as they are known from it and those before. The part has ids.
  void settle(Mesh& part);
  /// Are all parts to be settled (once more)? Twice where one before had no number: its values are right then.
  bool begins_turn() { return n_turns_++ == 0 || (n_turns_ == 2 && has_come_late_); }
  const Disagreements& differ() const { return differ_; }

 private:
  struct Known {
    std::vector<double> values;
    std::vector<std::uint8_t> is_there;  // per id
  };
  std::vector<std::int64_t> ids_;
  std::map<std::pair<std::string, int>, Known> known_;  // by field and components
  Disagreements differ_;
  bool has_come_late_ = false;
  int n_turns_ = 0;
};

/// All parts at once; they may have no ids yet, which are then those of need_ids().
Disagreements settle_values(std::span<MeshedModel> parts);

}  // namespace hextwist
