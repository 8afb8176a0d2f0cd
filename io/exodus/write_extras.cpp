// Exodus II: values at all times, and what else came with the file of the mesh.
#include <algorithm>
#include <cmath>

#include "hextwist/base/text.h"
#include "hextwist/io/exodus/write_internal.h"
#include "hextwist/io/others.h"
#include "hextwist/mesh/arrays.h"

namespace hextwist::io {
namespace {

using Of = FileResults::Of;

}  // namespace

std::string exodus_name(const std::string& name) {
  return std::string(trimmed(trimmed(name).substr(0, 255)));  // readers cut blanks around it
}

std::vector<double> with_middle_factors(std::span<const double> of_corners, int each) {
  std::vector<double> result;
  for (std::size_t i = 0; i + 4 <= of_corners.size(); i += 4) {
    const auto f = of_corners.subspan(i, 4);
    result.insert(result.end(), f.begin(), f.end());
    for (std::size_t c = 0; c < 4; ++c) result.push_back((f[c] + f[(c + 1) % 4]) / 2);
    if (each == 9) result.push_back((f[0] + f[1] + f[2] + f[3]) / 4);
  }
  return result;
}

ExodusValues::ExodusValues(const Mesh& mesh, std::vector<std::string>& notices)
    : mesh_(mesh),
      notices_(notices),
      extras_(mesh.results ? *mesh.results : none_),
      now_(mesh, extras_),
      has_places_(extras_.mesh && now_.knows()),
      fields_(split_components(
          mesh.fields, [](int) { return false; }, notices)),
      times_(extras_.times) {
  if (extras_.has_places() && !has_places_) {
    notices_.push_back("left out, as it is no longer known where in their file the hexes lie: " + extras_text(extras_));
    if (times_.size() > 1) times_ = {times_[extras_.step]};
  }
  if (times_.empty() && !fields_.empty()) times_ = {0};
  on_nodes_ = variables(Field::On::node, extras_.on_nodes);
  on_hexes_ = variables(Field::On::hex, extras_.on_hexes);
}

std::vector<ExodusValues::Variable> ExodusValues::variables(Field::On on, const std::vector<TimedValues>& timed) {
  std::vector<Variable> result;
  const char* const of = on == Field::On::node ? "nodes" : "hexes";
  for (const Field& field : fields_) {
    if (field.on != on) continue;
    // Names are unique in the file; components of one field may be called like another.
    std::string name = exodus_name(field.name);
    for (int k = 2; std::ranges::find(result, name, &Variable::name) != result.end(); ++k)
      name = exodus_name(field.name).substr(0, 250) + "_" + std::to_string(k);
    say_renamed(std::string("field of ") + of, field.name, name, notices_);
    const auto same = std::ranges::find(timed, field.name, &TimedValues::name);
    result.push_back({name, &field.values, has_places_ && same != timed.end() ? &*same : nullptr});
  }
  for (const TimedValues& values : timed)
    if (has_places_ && std::ranges::find(fields_, std::pair(on, values.name), [](const Field& field) {
                         return std::pair(field.on, field.name);
                       }) == fields_.end())
      result.push_back({values.name, nullptr, &values});
  return result;
}

const SetExtras* ExodusValues::extras_of(const NodeSet& set) const {
  const auto found = std::ranges::find(extras_.node_sets, set.id, &SetExtras::id);
  return found != extras_.node_sets.end() ? &*found : nullptr;
}
const SetExtras* ExodusValues::extras_of(const SideSet& set) const {
  const auto found = std::ranges::find(extras_.side_sets, set.id, &SetExtras::id);
  return found != extras_.side_sets.end() ? &*found : nullptr;
}

std::vector<double> ExodusValues::factors(const NodeSet& set) {
  const SetExtras* of = extras_of(set);
  if (!of || of->factors.empty()) return {};
  if (of->factors.size() == 1) return std::vector<double>(set.nodes.size(), of->factors[0]);
  return has_places_ ? now_.in_set(set.nodes, *of, of->factors, 1) : std::vector<double>();
}
std::vector<double> ExodusValues::factors(const SideSet& set) {
  const SetExtras* of = extras_of(set);
  if (!of || of->factors.empty()) return {};
  if (of->factors.size() == 1) return std::vector<double>(4 * set.sides.size(), of->factors[0]);
  return has_places_ ? now_.factors(set.sides, *of) : std::vector<double>();
}

std::vector<std::string> ExodusValues::attributes(const ExodusPart& part) const {
  const auto found = std::ranges::find(extras_.blocks, part.id, &FileResults::OfBlock::id);
  return found != extras_.blocks.end() && has_places_ && !part.hexes.empty() ? found->attributes
                                                                             : std::vector<std::string>();
}
std::vector<double> ExodusValues::attribute(const ExodusPart& part, const std::string& name) const {
  const auto& all = *std::ranges::find(extras_.attributes, name, &TimedValues::name)->at[0];
  std::vector<double> values;
  for (const Index h : part.hexes) values.push_back(all[mesh_.file_hexes[h]]);
  return values;
}

std::size_t ExodusValues::longest_name() const {
  std::size_t longest = 0;
  const auto measure = [&](const auto& items) {
    for (const auto& item : items) longest = std::max(longest, item.name.size());
  };
  measure(on_nodes_), measure(on_hexes_), measure(extras_.of_all), measure(extras_.attributes);
  measure(extras_.properties);
  for (const auto* sets : {&extras_.node_sets, &extras_.side_sets})
    for (const SetExtras& set : *sets) measure(set.variables);
  return longest;
}

bool ExodusValues::are_wide() const {
  const auto is_wide = [](const auto& value) { return std::abs(value.second) > highest_narrow_id; };
  return !extras_.wide_ids.empty() || std::ranges::any_of(extras_.properties, [&](const auto& of) {
    return std::ranges::any_of(of.values, is_wide);
  });
}

void ExodusValues::write_records(const ExodusTarget& to) const {
  if (!extras_.qa.empty()) {
    std::vector<std::string> words;
    for (const auto& record : extras_.qa) words.insert(words.end(), record.begin(), record.end());
    TextsWritten texts(std::move(words));
    to.check(
        ex_put_qa(to.file, static_cast<int>(extras_.qa.size()), reinterpret_cast<char*(*)[4]>(texts.pointers.data())));
  }
  if (!extras_.info.empty()) {
    to.check(ex_put_info(to.file, static_cast<int>(extras_.info.size()), TextsWritten(extras_.info).pointers.data()));
  }
}

void ExodusValues::write_properties(const ExodusTarget& to) const {
  const auto write = [&](Of of, ex_entity_type type, const auto& groups) {
    std::vector<std::string> names;
    for (const FileResults::Property& property : extras_.properties)
      if (property.of == of) names.push_back(property.name);
    if (names.empty() || groups.empty()) return;
    to.check(ex_put_prop_names(to.file, type, static_cast<int>(names.size()), TextsWritten(names).pointers.data()));
    for (const FileResults::Property& property : extras_.properties)
      for (const auto& [id, value] : property.values)
        if (property.of == of &&
            std::ranges::find(groups, id, [](const auto& group) { return group.id; }) != groups.end())
          to.check(ex_put_prop(to.file, type, extras_.in_file(of, id), property.name.c_str(), value));
  };
  write(Of::block, EX_ELEM_BLOCK, to.parts);
  write(Of::node_set, EX_NODE_SET, mesh_.node_sets);
  write(Of::side_set, EX_SIDE_SET, mesh_.side_sets);
}

void ExodusValues::declare_results(const ExodusTarget& to, std::vector<int>& is_on) const {
  if (times_.empty()) return;
  const auto declare = [&](ex_entity_type type, std::vector<std::string> names) {
    if (names.empty()) return;
    to.check(ex_put_variable_param(to.file, type, static_cast<int>(names.size())));
    to.check(ex_put_variable_names(to.file, type, static_cast<int>(names.size()), TextsWritten(names).pointers.data()));
  };
  const auto names_of = [](const auto& variables) {
    std::vector<std::string> names;
    for (const auto& variable : variables) names.push_back(variable.name);
    return names;
  };
  declare(EX_GLOBAL, names_of(extras_.of_all));
  declare(EX_NODAL, names_of(on_nodes_));
  declare(EX_ELEM_BLOCK, names_of(on_hexes_));
  if (!on_hexes_.empty())
    to.check(ex_put_truth_table(to.file, EX_ELEM_BLOCK, static_cast<int>(to.parts.size()),
                                static_cast<int>(on_hexes_.size()), is_on.data()));
}

void ExodusValues::put_globals(const ExodusTarget& to, std::size_t t) const {
  if (t >= times_.size()) return;
  const int step = static_cast<int>(t) + 1;
  to.check(ex_put_time(to.file, step, &times_[t]));
  std::vector<double> global;
  for (const TimedValues& values : extras_.of_all)
    global.push_back((*values.at[times_.size() == values.at.size() ? t : extras_.step])[0]);
  if (!global.empty()) to.check(ex_put_var(to.file, step, EX_GLOBAL, 1, 0, std::ssize(global), global.data()));
}

void ExodusValues::write_results(const ExodusTarget& to) {
  if (times_.empty()) return;
  // Where a block has no value at all, the variable is not on it.
  const std::size_t n = on_hexes_.size();
  std::vector<int> is_on(to.parts.size() * n, 0);
  for (std::size_t p = 0; p < to.parts.size(); ++p)
    for (std::size_t v = 0; v < n; ++v)
      is_on[p * n + v] = std::ranges::any_of(to.parts[p].hexes, [&, &variable = on_hexes_[v]](Index h) {
        return !std::isnan(variable.now ? (*variable.now)[h] : (*variable.timed->at[0])[mesh_.file_hexes[h]]);
      });
  declare_results(to, is_on);
  std::size_t kept = times_.size() == extras_.times.size() ? extras_.step : 0;
  for (std::size_t t = 0; t < times_.size(); ++t) {
    const int step = static_cast<int>(t) + 1;
    put_globals(to, t);
    const auto values_of = [&](const Variable& variable, const auto& look_up,
                               std::vector<double>& made) -> const auto& {
      if (variable.now && (t == kept || !variable.timed)) return *variable.now;
      return made = look_up(*variable.timed->at[t]);
    };
    std::vector<double> made, of_part;
    for (std::size_t v = 0; v < on_nodes_.size(); ++v) {
      const auto& values = values_of(
          on_nodes_[v], [&](const auto& all) { return now_.on_nodes(all); }, made);
      to.check(ex_put_var(to.file, step, EX_NODAL, static_cast<int>(v) + 1, 1, std::ssize(values), values.data()));
    }
    for (std::size_t v = 0; v < n; ++v) {
      const auto& values = values_of(
          on_hexes_[v], [&](const auto& all) { return now_.on_hexes(all); }, made);
      for (std::size_t p = 0; p < to.parts.size(); ++p) {
        if (!is_on[p * n + v]) continue;
        of_part.clear();
        for (const Index h : to.parts[p].hexes) of_part.push_back(values[h]);
        to.check(ex_put_var(to.file, step, EX_ELEM_BLOCK, static_cast<int>(v) + 1, to.parts[p].in_file,
                            std::ssize(of_part), of_part.data()));
      }
    }
  }
  write_sets(to, EX_NODE_SET, mesh_.node_sets);
  write_sets(to, EX_SIDE_SET, mesh_.side_sets);
}

template <class Groups>
void ExodusValues::write_sets(const ExodusTarget& to, ex_entity_type type, const Groups& groups) {
  if (!has_places_) return;
  constexpr bool of_nodes = requires(const Groups& g) {
    g[0].nodes;
  };
  std::vector<std::string> names;
  for (const auto& group : groups)
    if (const SetExtras* of = extras_of(group))
      for (const TimedValues& values : of->variables)
        if (std::ranges::find(names, values.name) == names.end()) names.push_back(values.name);
  if (names.empty()) return;
  const std::size_t n = names.size();
  to.check(ex_put_variable_param(to.file, type, static_cast<int>(n)));
  to.check(ex_put_variable_names(to.file, type, static_cast<int>(n), TextsWritten(names).pointers.data()));
  std::vector<const TimedValues*> values(groups.size() * n, nullptr);
  std::vector<int> is_on(values.size(), 0);
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (const SetExtras* of = extras_of(groups[g]))
      for (const TimedValues& variable : of->variables) {
        const auto v = static_cast<std::size_t>(std::ranges::find(names, variable.name) - names.begin());
        values[g * n + v] = &variable;
        is_on[g * n + v] = !items_of(groups[g]).empty();
        if constexpr (!of_nodes)
          if (!other_sides_of(mesh_, groups[g].id).empty()) {
            is_on[g * n + v] = 0;
            notices_.push_back("side set " + std::to_string(groups[g].id) + ": left out its variable '" +
                               variable.name + "', as it has sides of other elements");
          }
      }
  to.check(ex_put_truth_table(to.file, type, static_cast<int>(groups.size()), static_cast<int>(n), is_on.data()));
  for (std::size_t t = 0; t < times_.size(); ++t)
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!is_on[i]) continue;
      const auto& group = groups[i / n];
      const std::vector<double> now = now_.in_set(items_of(group), *extras_of(group), *values[i]->at[t], 0);
      to.check(ex_put_var(to.file, static_cast<int>(t) + 1, type, static_cast<int>(i % n) + 1,
                          extras_.in_file(of_nodes ? Of::node_set : Of::side_set, group.id), std::ssize(now),
                          now.data()));
    }
}

}  // namespace hextwist::io
