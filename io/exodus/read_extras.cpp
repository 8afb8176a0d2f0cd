// Exodus II: what a file has beyond mesh, groups and the fields of one step.
#include <algorithm>
#include <cmath>
#include <utility>

#include "hextwist/base/memory.h"
#include "hextwist/io/exodus/exodus_internal.h"

namespace hextwist::io {
namespace {

using Of = FileResults::Of;
using Values = std::vector<double>;

std::string of_library(const std::string& text) {
  return std::string(trimmed(text.c_str()));  // what stands before the first zero
}

/// Texts that a call of the library fills in.
struct TextsRead {
  std::vector<std::string> texts;
  std::vector<char*> pointers;
  TextsRead(std::size_t n, std::size_t length) : texts(n, std::string(length + 1, '\0')) {
    for (std::string& text : texts) pointers.push_back(text.data());
  }
  std::vector<std::string> trimmed_ones() const {
    std::vector<std::string> result;
    for (const std::string& text : texts) result.push_back(of_library(text));
    return result;
  }
};

class ExtrasReader {
 public:
  ExtrasReader(const ExodusSource& source, const Mesh& mesh, std::vector<std::string>& notices)
      : in_(source), mesh_(mesh), notices_(notices) {}

  std::shared_ptr<const FileResults> result() {
    out_.wide_ids = in_.wide_ids;
    records();
    properties();
    times();
    results();
    attributes();
    sets(EX_NODE_SET, in_.init.num_node_sets, out_.node_sets);
    sets(EX_SIDE_SET, in_.init.num_side_sets, out_.side_sets);
    left_out();
    if (out_.empty()) return nullptr;
    if (out_.has_places()) {
      Mesh places;
      places.points = mesh_.points;
      places.hexes = mesh_.hexes;
      out_.mesh = std::make_shared<const Mesh>(std::move(places));
    }
    return std::make_shared<const FileResults>(std::move(out_));
  }

  std::shared_ptr<const FileResults> of_whole(std::vector<std::string>& lost) {
    records();
    properties();
    times();
    // The fields are those of the last step, so its time and what the whole has then are kept.
    if (const std::size_t n = out_.times.size(); n > 1) {
      lost.push_back(counted(static_cast<std::int64_t>(n) - 1, "more time step", "more time steps"));
      out_.times = {out_.times.back()};
      steps_ = {steps_.back()};
      out_.step = 0;
    }
    results();
    for (const std::int64_t id : ids(EX_ELEM_BLOCK, in_.init.num_elem_blk))
      if (int n = 0; ex_get_attr_param(in_.file, EX_ELEM_BLOCK, id, &n) >= 0 && n > 0)
        lost.push_back(counted(n, "attribute") + " of block " + std::to_string(id));
    alike_in_sets(EX_NODE_SET, in_.init.num_node_sets, out_.node_sets, lost);
    alike_in_sets(EX_SIDE_SET, in_.init.num_side_sets, out_.side_sets, lost);
    left_out();
    return out_.empty() ? nullptr : std::make_shared<const FileResults>(std::move(out_));
  }

 private:
  void check(int status, const std::string& what) const {
    if (status < 0) throw Error(in_.name + ": " + what + " cannot be read (damaged file)");
  }
  /// A damaged file must not become a huge allocation.
  std::size_t possible(std::int64_t n, std::int64_t most, const char* what) const {
    if (n > most) throw Error(in_.name + ": impossible number of " + what + ": " + std::to_string(n));
    return static_cast<std::size_t>(std::max<std::int64_t>(n, 0));
  }
  std::size_t count(ex_inquiry inquiry, const char* what) const {
    return possible(ex_inquire_int(in_.file, inquiry), 1 << 20, what);
  }
  std::vector<std::int64_t> ids(ex_entity_type type, std::int64_t n) const {
    std::vector<std::int64_t> result(static_cast<std::size_t>(n));
    if (n > 0) check(ex_get_ids(in_.file, type, result.data()), "ids of groups");
    return result;
  }

  void records() {
    out_.title = of_library(in_.init.title);
    if (out_.title == "hextwist") out_.title.clear();
    TextsRead names(3, in_.name_length);
    if (ex_get_coord_names(in_.file, names.pointers.data()) >= 0) out_.coordinate_names = names.trimmed_ones();
    if (const auto plain = std::vector<std::string>{"x", "y", "z"};
        out_.coordinate_names == plain || out_.coordinate_names == std::vector<std::string>(3))
      out_.coordinate_names.clear();
    const std::size_t n_qa = count(EX_INQ_QA, "QA records"), n_info = count(EX_INQ_INFO, "info records");
    TextsRead qa(4 * n_qa, MAX_STR_LENGTH), info(n_info, MAX_LINE_LENGTH);
    if (n_qa > 0) check(ex_get_qa(in_.file, reinterpret_cast<char*(*)[4]>(qa.pointers.data())), "QA records");
    if (n_info > 0) check(ex_get_info(in_.file, info.pointers.data()), "info records");
    const std::vector<std::string> words = qa.trimmed_ones();
    for (std::size_t i = 0; i < n_qa; ++i)
      out_.qa.push_back({words[4 * i], words[4 * i + 1], words[4 * i + 2], words[4 * i + 3]});
    for (const std::string& line : info.texts) out_.info.emplace_back(line.c_str());
  }

  void properties() {
    const auto read = [&](ex_entity_type type, Of of, ex_inquiry inquiry, std::int64_t n_groups) {
      const std::size_t n = count(inquiry, "properties");
      if (n == 0 || n_groups == 0) return;
      TextsRead names(n, std::max<std::size_t>(in_.name_length, MAX_STR_LENGTH));
      check(ex_get_prop_names(in_.file, type, names.pointers.data()), "names of properties");
      const std::vector<std::int64_t> of_groups = ids(type, n_groups);
      for (const std::string& name : names.trimmed_ones()) {
        if (name == "ID" || name.empty()) continue;
        std::vector<std::int64_t> values(of_groups.size());
        check(ex_get_prop_array(in_.file, type, name.c_str(), values.data()), "property " + name);
        FileResults::Property property{of, name, {}};
        for (std::size_t i = 0; i < values.size(); ++i)
          property.values.emplace_back(in_.group(type, of_groups[i]), values[i]);
        out_.properties.push_back(std::move(property));
      }
    };
    read(EX_ELEM_BLOCK, Of::block, EX_INQ_EB_PROP, in_.init.num_elem_blk);
    read(EX_NODE_SET, Of::node_set, EX_INQ_NS_PROP, in_.init.num_node_sets);
    read(EX_SIDE_SET, Of::side_set, EX_INQ_SS_PROP, in_.init.num_side_sets);
  }

  std::vector<std::string> variables(ex_entity_type type) const {
    int n = 0;
    check(ex_get_variable_param(in_.file, type, &n), "variables");
    TextsRead names(possible(n, 1 << 20, "variables"), in_.name_length);
    if (n > 0) check(ex_get_variable_names(in_.file, type, n, names.pointers.data()), "names of variables");
    return names.trimmed_ones();
  }

  /// Which steps are kept: all, but for a file that is too large for that.
  void times() {
    const std::size_t n = count(EX_INQ_TIME, "time steps");
    if (n == 0) return;
    std::vector<double> all(n);
    check(ex_get_all_times(in_.file, all.data()), "the times");
    const double bytes =
        8.0 * static_cast<double>(n) *
        (static_cast<double>(variables(EX_NODAL).size()) * static_cast<double>(mesh_.points.size()) +
         static_cast<double>(variables(EX_ELEM_BLOCK).size()) * static_cast<double>(mesh_.hexes.size()));
    const bool fits = bytes < static_cast<double>(available_memory()) / 3;
    if (!fits)
      notices_.push_back("dropped " + std::to_string(n - 1) + " time steps, all but the last: together they take " +
                         std::to_string(std::llround(bytes / (1 << 30))) + " GiB of memory");
    for (std::size_t t = fits ? 0 : n - 1; t < n; ++t) {
      out_.times.push_back(all[t]);
      steps_.push_back(static_cast<int>(t) + 1);
    }
    out_.step = steps_.size() - 1;
  }

  /// Values at all steps: read(step, where they go).
  template <class Read>
  void at_all_times(TimedValues& values, std::size_t n, const Read& read) const {
    for (const int step : steps_) {
      Values at(n, std::numeric_limits<double>::quiet_NaN());
      read(step, at);
      values.at.push_back(std::make_shared<const Values>(std::move(at)));
    }
  }

  void results() {
    if (steps_.empty()) return;
    const std::vector<std::string> global = variables(EX_GLOBAL);
    for (std::size_t v = 0; v < global.size(); ++v) out_.of_all.push_back({global[v], {}});
    for (const int step : steps_) {
      Values all(global.size());
      if (!all.empty())
        check(ex_get_var(in_.file, step, EX_GLOBAL, 1, 0, std::ssize(all), all.data()), "global variables");
      for (std::size_t v = 0; v < all.size(); ++v)
        out_.of_all[v].at.push_back(std::make_shared<const Values>(1, all[v]));
    }
    if (steps_.size() < 2) return;  // the fields of the mesh are all there is
    const std::vector<std::string> nodal = variables(EX_NODAL), of_hexes = variables(EX_ELEM_BLOCK);
    for (std::size_t v = 0; v < nodal.size(); ++v) {
      TimedValues values{nodal[v], {}};
      bool there = true;
      at_all_times(values, mesh_.points.size(), [&](int step, Values& at) {
        const int status = ex_get_var(in_.file, step, EX_NODAL, static_cast<int>(v) + 1, 1, std::ssize(at), at.data());
        check(status, "variable " + nodal[v]);
        there = there && status == 0;  // else the library's warning: it is named only
        in_.nodes.sort(at);
      });
      if (there) out_.on_nodes.push_back(std::move(values));
    }
    for (std::size_t v = 0; v < of_hexes.size(); ++v) {
      bool any = false;
      TimedValues values{of_hexes[v], {}};
      at_all_times(values, mesh_.hexes.size(), [&](int step, Values& at) {
        Values of_block;
        for (const ExodusSource::Block& block : in_.blocks) {
          if (!block.hexes || block.n == 0) continue;
          of_block.resize(static_cast<std::size_t>(block.n));
          if (ex_get_var(in_.file, step, EX_ELEM_BLOCK, static_cast<int>(v) + 1, block.id, block.n, of_block.data()) !=
              0)
            continue;  // not on this block
          any = true;
          for (std::int64_t i = 0; i < block.n; ++i) at[in_.hex_of_element[block.first + i]] = of_block[i];
        }
      });
      if (any) out_.on_hexes.push_back(std::move(values));
    }
  }

  void attributes() {
    for (const ExodusSource::Block& block : in_.blocks) {
      int n = 0;
      if (!block.hexes || block.n == 0 || ex_get_attr_param(in_.file, EX_ELEM_BLOCK, block.id, &n) < 0 || n <= 0)
        continue;
      TextsRead texts(static_cast<std::size_t>(n), std::max<std::size_t>(in_.name_length, MAX_STR_LENGTH));
      check(ex_get_attr_names(in_.file, EX_ELEM_BLOCK, block.id, texts.pointers.data()), "names of attributes");
      std::vector<std::string> names = texts.trimmed_ones();
      for (std::size_t a = 0; a < names.size(); ++a) {
        if (names[a].empty()) names[a] = "attribute_" + std::to_string(a + 1);
        Values of_block(static_cast<std::size_t>(block.n));
        check(ex_get_one_attr(in_.file, EX_ELEM_BLOCK, block.id, static_cast<int>(a) + 1, of_block.data()),
              "attribute " + names[a]);
        auto known = std::ranges::find(attributes_, names[a], [](const auto& item) { return item.first; });
        if (known == attributes_.end())
          known = attributes_.insert(known,
                                     {names[a], Values(mesh_.hexes.size(), std::numeric_limits<double>::quiet_NaN())});
        for (std::int64_t i = 0; i < block.n; ++i) known->second[in_.hex_of_element[block.first + i]] = of_block[i];
      }
      out_.blocks.push_back({in_.group(EX_ELEM_BLOCK, block.id), std::move(names)});
    }
    for (auto& [name, values] : attributes_)
      out_.attributes.push_back({name, {std::make_shared<const Values>(std::move(values))}});
  }

  Values factors(ex_entity_type type, std::int64_t id, int n_members, int n_factors) const {
    const bool of_sides = type == EX_SIDE_SET;
    const std::string who = std::string(of_sides ? "side set " : "node set ") + std::to_string(id);
    // Per side one for each of its nodes: the corners first, then middle nodes of edges, then that of the face.
    std::size_t each = of_sides ? 4 : 1;
    for (const std::size_t of_second_order : {8, 9})
      if (of_sides && n_factors == static_cast<std::int64_t>(of_second_order) * n_members) each = of_second_order;
    if (n_factors > 0 && n_factors != static_cast<std::int64_t>(each) * n_members)
      notices_.push_back("dropped the distribution factors of " + who + ", of which there are " +
                         std::to_string(n_factors) + " for " + std::to_string(n_members) + " members");
    Values result;
    if (n_factors <= 0 || n_factors != static_cast<std::int64_t>(each) * n_members) return result;
    result.resize(static_cast<std::size_t>(n_factors));
    check(ex_get_set_dist_fact(in_.file, type, id, result.data()), "distribution factors of " + who);
    if (each > 4) {
      const Values given = std::exchange(result, {});
      for (std::size_t i = 0; i < given.size(); i += each)
        for (std::size_t c = 0; c < 4; ++c) result.push_back(given[i + c]);
      if (with_middle_factors(result, static_cast<int>(each)) != given)
        notices_.push_back("distribution factors of " + who + " are kept at corners; at middle nodes they are means");
    }
    // Most programs write factors, all of them 1: one for all takes no room.
    if (std::ranges::adjacent_find(result, std::ranges::not_equal_to{}) == result.end()) result.resize(1);
    return result;
  }

  /// Of slices: factors that are alike; what else sets have is lost.
  void alike_in_sets(ex_entity_type type, std::int64_t n_sets, std::vector<SetExtras>& out,
                     std::vector<std::string>& lost) const {
    const char* const kind = type == EX_SIDE_SET ? "sideset" : "nodeset";
    for (const std::string& name : variables(type)) lost.push_back("variable '" + name + "' of " + kind + "s");
    for (const std::int64_t id : ids(type, n_sets)) {
      int n = 0, n_factors = 0;
      check(ex_get_set_param(in_.file, type, id, &n, &n_factors), std::string(kind) + " " + std::to_string(id));
      Values all = factors(type, id, n, n_factors);
      if (all.size() == 1)
        out.push_back({in_.group(type, id), {}, {}, std::move(all), {}});
      else if (!all.empty())
        lost.push_back("distribution factors of " + std::string(kind) + " " + std::to_string(id));
    }
  }

  void sets(ex_entity_type type, std::int64_t n_sets, std::vector<SetExtras>& out) {
    const bool of_sides = type == EX_SIDE_SET;
    const std::vector<std::string> names = steps_.empty() ? std::vector<std::string>() : variables(type);
    for (const std::int64_t id : ids(type, n_sets)) {
      const std::string who = std::string(of_sides ? "side set " : "node set ") + std::to_string(id);
      int n = 0, n_factors = 0;
      check(ex_get_set_param(in_.file, type, id, &n, &n_factors), who);
      if (n <= 0) continue;
      const auto size = static_cast<std::size_t>(n);
      SetExtras set{in_.group(type, id), {}, {}, factors(type, id, n, n_factors), {}};
      std::vector<int> numbers(size), sides(of_sides ? size : 0);
      check(ex_get_set(in_.file, type, id, numbers.data(), of_sides ? sides.data() : nullptr), who);
      for (std::size_t v = 0; v < names.size(); ++v) {
        TimedValues values{names[v], {}};
        bool any = false;
        at_all_times(values, size, [&](int step, Values& at) {
          any |= ex_get_var(in_.file, step, type, static_cast<int>(v) + 1, id, n, at.data()) == 0;
        });
        if (any) set.variables.push_back(std::move(values));
      }
      if (set.factors.size() > 1 || !set.variables.empty()) take_members(set, numbers, sides);
      if (!set.factors.empty() || !set.variables.empty()) out.push_back(std::move(set));
    }
  }

  /// Members in ascending order, each once, and their values with them.
  void take_members(SetExtras& set, const std::vector<int>& numbers, const std::vector<int>& sides) const {
    const bool of_sides = !sides.empty();
    std::vector<Side> members;  // of nodes: node, 0
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (of_sides)
        members.push_back(
            {in_.hex_of_element[numbers[i] - 1], sides[i] >= 1 && sides[i] <= 6 ? exodus_face[sides[i] - 1] : 0});
      else
        members.push_back({in_.nodes.place().empty() ? numbers[i] - 1 : in_.nodes.place()[numbers[i] - 1], 0});
      if (members.back().hex >= 0) order.push_back(i);
    }
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return members[i]; });
    const auto repeated = std::ranges::unique(order, {}, [&](std::size_t i) { return members[i]; });
    order.erase(repeated.begin(), repeated.end());
    for (const std::size_t i : order)
      if (of_sides)
        set.sides.push_back(members[i]);
      else
        set.nodes.push_back(members[i].hex);
    const auto sorted = [&](const Values& values, std::size_t width) {
      Values result;
      for (const std::size_t i : order)
        for (std::size_t c = 0; c < width; ++c) result.push_back(values[i * width + c]);
      return result;
    };
    if (set.factors.size() > 1) set.factors = sorted(set.factors, of_sides ? 4 : 1);
    for (TimedValues& values : set.variables)
      for (auto& at : values.at) at = std::make_shared<const Values>(sorted(*at, 1));
  }

  /// Says what has no place here.
  void left_out() {
    const auto drop = [&](std::int64_t n, const char* what) {
      if (n > 0) notices_.push_back("dropped " + std::to_string(n) + " " + what);
    };
    drop(in_.init.num_edge_blk, "edge blocks");
    drop(in_.init.num_face_blk, "face blocks");
    drop(in_.init.num_edge_sets, "edge sets");
    drop(in_.init.num_face_sets, "face sets");
    drop(in_.init.num_node_maps, "node maps beside the node ids");
    drop(in_.init.num_elem_maps, "element maps beside the element ids");
    drop(static_cast<std::int64_t>(count(EX_INQ_COORD_FRAMES, "coordinate frames")), "coordinate frames");
    for (const std::string& name : variables(EX_ELEM_SET))
      notices_.push_back("dropped variable '" + name + "' of element sets");
    const auto drop_attributes = [&](ex_entity_type type, std::int64_t id, const std::string& who) {
      int n = 0;
      if (ex_get_attr_param(in_.file, type, id, &n) >= 0) drop(n, ("attributes of " + who).c_str());
    };
    drop_attributes(EX_NODAL, 0, "nodes");
    for (const std::int64_t id : ids(EX_NODE_SET, in_.init.num_node_sets))
      drop_attributes(EX_NODE_SET, id, "node set " + std::to_string(id));
    for (const std::int64_t id : ids(EX_SIDE_SET, in_.init.num_side_sets))
      drop_attributes(EX_SIDE_SET, id, "side set " + std::to_string(id));
  }

  const ExodusSource& in_;
  const Mesh& mesh_;
  std::vector<std::string>& notices_;
  FileResults out_;
  std::vector<int> steps_;  // of the file, from 1
  std::vector<std::pair<std::string, Values>> attributes_;
};

}  // namespace

std::shared_ptr<const FileResults> read_extras(const ExodusSource& source, const Mesh& mesh,
                                               std::vector<std::string>& notices) {
  return ExtrasReader(source, mesh, notices).result();
}

std::shared_ptr<const FileResults> read_extras_of_whole(const ExodusSource& source, std::vector<std::string>& notices,
                                                        std::vector<std::string>& lost) {
  return ExtrasReader(source, {}, notices).of_whole(lost);
}

}  // namespace hextwist::io
