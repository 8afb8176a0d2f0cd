// Parts, instances and the assembly of an Abaqus file in one numbering.
//
// Each part, each instance and the assembly count nodes and elements for themselves. Where ids are taken already, they
// are counted on from the highest so far, and a notice says so.
#include <limits>

#include "hextwist/base/sorted.h"
#include "hextwist/io/abaqus/abaqus_internal.h"

namespace hextwist::io {
namespace {

class AbaqusAssembly {
 public:
  AbaqusAssembly(const AbaqusContents& contents, MeshFile& out) : in_(contents), out_(out) {}

  AbaqusParts result() {
    place();
    elements();
    others();
    for (const auto& [type, n] : in_.n_dropped)
      out_.notices.push_back("dropped " + counted(n, "element") + " of type " + type + ", which " +
                             (n == 1 ? "leaves" : "leave") + " a node out");
    return std::move(parts_);
  }

 private:
  void place() {
    add({"", {in_.scopes[0].get(), nullptr}}, {});
    std::vector<const AbaqusScope*> unused;
    for (const auto& scope : in_.scopes) {
      if (scope->kind != AbaqusScope::part) continue;
      const bool used = std::ranges::find(in_.instances, scope.get(), &AbaqusInstance::part) != in_.instances.end();
      if (in_.instances.empty())  // no assembly: each part once
        add({scope->name, {scope.get(), nullptr}}, {});
      else if (!used && !scope->node_ids.empty())
        out_.notices.push_back("part '" + scope->name + "' has no instance: its " +
                               counted(std::ssize(scope->hex_ids), "hex", "hexes") + " are left out");
    }
    for (const AbaqusInstance& instance : in_.instances)
      add({instance.own->name, {instance.part, instance.own}}, instance);
    if (in_.assembly) add({"", {in_.assembly, nullptr}}, {});
    say_shifts();
    number();
  }

  static bool has_ids(const AbaqusScope& scope) { return !scope.node_ids.empty() || !scope.hex_ids.empty(); }

  /// Which nodes or hexes of *INSTANCE its part has too: some programs write the mesh in both places.
  template <class Same>
  std::vector<char> repeated(const std::vector<std::int64_t>& first, const std::vector<std::int64_t>& second,
                             const Same& same) {
    std::vector<std::pair<std::int64_t, std::size_t>> known;
    for (std::size_t i = 0; i < first.size(); ++i) known.emplace_back(first[i], i);
    std::ranges::sort(known);
    std::vector<char> result(second.size(), 0);
    for (std::size_t i = 0; i < second.size(); ++i) {
      const auto at = std::ranges::lower_bound(known, std::pair(second[i], std::size_t{0}));
      result[i] = at != known.end() && at->first == second[i] && same(at->second, i);  // else found by Ids
    }
    return result;
  }

  void add(AbaqusPlaced placed, const AbaqusInstance& position) {
    const auto& [first, second] = placed.scopes;
    if (second && has_ids(*first) && has_ids(*second)) {
      placed.repeated_nodes = repeated(first->node_ids, second->node_ids, [a = first, b = second](auto i, auto k) {
        return a->points[i] == b->points[k];
      });
      placed.repeated_hexes = repeated(first->hex_ids, second->hex_ids, [a = first, b = second](auto i, auto k) {
        return std::equal(&a->hex_nodes[8 * i], &a->hex_nodes[8 * i] + 8, &b->hex_nodes[8 * k]);
      });
    }
    placed.nodes = numbers(placed, highest_[0], [](const AbaqusScope& scope, const auto& f) { f(scope.node_ids); });
    placed.elements = numbers(placed, highest_[1], [](const AbaqusScope& scope, const auto& f) {
      for (const auto* ids : {&scope.hex_ids, &scope.other_ids}) f(*ids);
    });
    placed.turn = position.turn;
    placed.shift = position.shift;
    const bool still = position.turn.isIdentity(0) && position.shift.isZero(0);
    for (const AbaqusScope* scope : placed.scopes) {
      if (!scope) continue;
      const auto& skip_nodes = scope == second ? placed.repeated_nodes : no_skip_;
      const auto& skip_hexes = scope == second ? placed.repeated_hexes : no_skip_;
      for (std::size_t i = 0; i < scope->node_ids.size(); ++i) {
        if (!skip_nodes.empty() && skip_nodes[i]) continue;
        node_ids_.push_back(scope->node_ids[i] + placed.nodes.shift);
        node_origin_.emplace_back(scope, i);
        out_.mesh.points.push_back(still ? scope->points[i] : Vec3(position.turn * scope->points[i] + position.shift));
      }
      for (std::size_t i = 0; i < scope->hex_ids.size(); ++i)
        if (skip_hexes.empty() || !skip_hexes[i]) {
          hex_ids_.push_back(scope->hex_ids[i] + placed.elements.shift);
          hex_origin_.push_back(scope->hex_at[i]);
        }
    }
    parts_.placed.push_back(std::move(placed));
  }

  /// The ids of a place, which are counted in.
  template <class Each>
  AbaqusPlaced::Numbers numbers(const AbaqusPlaced& placed, std::int64_t& highest, const Each& each) const {
    std::int64_t low = std::numeric_limits<std::int64_t>::max(), high = 0;
    for (const AbaqusScope* scope : placed.scopes)
      if (scope)
        each(*scope, [&](const std::vector<std::int64_t>& ids) {
          for (const std::int64_t id : ids) low = std::min(low, id), high = std::max(high, id);
        });
    if (low > high) return {};
    const std::int64_t by = low <= highest ? highest : 0;
    // Ids that are too large by themselves are found later, with their line.
    if (by > 0 && high > highest_readable_id - by)
      in_.fail(placed.scopes[0]->at, "id " + std::to_string(high) + " of " + name(placed) +
                                         " is too large to be counted on from " + std::to_string(by));
    highest = std::max(highest, std::min(high, highest_readable_id) + by);
    return {low, high, by};
  }
  static std::string name(const AbaqusPlaced& placed) {
    if (placed.name.empty()) return "the assembly";
    return (placed.scopes[1] ? "instance '" : "part '") + placed.name + "'";
  }

  void say_shifts() const {
    std::string text;
    std::int64_t n = 0;
    for (const AbaqusPlaced& placed : parts_.placed)
      if (placed.nodes.shift > 0 || placed.elements.shift > 0) {
        if (++n > 3) continue;
        text += (n > 1 ? ", of " : "of ") + name(placed);
        const auto add = [&](const char* what, std::int64_t by) {
          if (by > 0) text += std::string(" ") + what + " by " + std::to_string(by);
        };
        add("nodes", placed.nodes.shift);
        add("elements", placed.elements.shift);
      }
    if (n > 3) text += " and " + std::to_string(n - 3) + " more";
    if (n > 0) out_.notices.push_back("ids that occur in several places of the file are moved: " + text);
  }

  void number() {
    if (hex_ids_.empty()) throw Error(in_.sources[0]->name + ": there is no hex in the file" + only_others());
    const auto few = [&](const char* what, std::size_t n, std::int64_t announced) {
      if (static_cast<std::int64_t>(n) < announced)
        throw Error(in_.sources[0]->name + ": " + std::to_string(n) + " of the " + std::to_string(announced) + " " +
                    what + " that the file announces: it is cut short");
    };
    few("nodes", node_ids_.size(), in_.announced[0]);
    few("hexes", hex_ids_.size(), in_.announced[1]);
    parts_.nodes = Ids(std::move(node_ids_), "node", [&](std::size_t i, const std::string& what) {
      const auto [part, k] = node_origin_[i];
      const auto run = std::ranges::upper_bound(part->node_runs, k, {}, &Run::first) - 1;
      fail_at_item(Cursor(*in_.source(run->at)), {&*run, 1}, k, what);
    });
    parts_.nodes.sort(out_.mesh.points);
    out_.mesh.node_ids = parts_.nodes.stored();
    parts_.hexes = Ids(std::move(hex_ids_), "element",
                       [&](std::size_t i, const std::string& what) { in_.fail(hex_origin_[i], what); });
    out_.mesh.hex_ids = parts_.hexes.stored();
  }

  void elements() {
    out_.mesh.hexes.reserve(hex_origin_.size());
    parts_.type_of_hex.reserve(hex_origin_.size());
    for (const AbaqusPlaced& placed : parts_.placed)
      for (const AbaqusScope* scope : placed.scopes)
        if (scope) hexes(placed, *scope);
    parts_.middles.finish(out_.mesh.hexes.size());
    if (parts_.middles.any()) {
      parts_.hexes.sort(parts_.middles.nodes, FoundMiddles::width);
      parts_.is_middle.assign(out_.mesh.points.size(), 0);
      for (const Index node : parts_.middles.nodes)
        if (node >= 0) parts_.is_middle[node] = 1;
    }
    parts_.hexes.sort(out_.mesh.hexes);
    parts_.hexes.sort(parts_.type_of_hex);
  }

  /// ", but 12 elements S4, 3 elements MASS"
  std::string only_others() const {
    std::map<std::string, std::size_t> n;
    for (const auto& scope : in_.scopes)
      for (std::size_t run = 0; run < scope->other_types.size(); ++run) {
        const std::size_t end =
            run + 1 < scope->other_types.size() ? scope->other_types[run + 1].first : scope->other_ids.size();
        n[scope->other_types[run].second] += end - scope->other_types[run].first;
      }
    std::string text;
    for (const auto& [type, count] : n)
      text += (text.empty() ? ", but " : ", ") + counted(static_cast<std::int64_t>(count), "element") + " " + type;
    return text;
  }

  int type_number(const std::string& type) {
    const auto at = std::ranges::find(parts_.types, type);
    if (at == parts_.types.end()) {
      parts_.types.push_back(type);
      return static_cast<int>(parts_.types.size()) - 1;
    }
    return static_cast<int>(at - parts_.types.begin());
  }

  Index node_of(const AbaqusPlaced& placed, const AbaqusScope& scope, std::size_t hex, std::int64_t id) const {
    const Index node = find_node(placed, id);
    if (node < 0)
      in_.fail(scope.hex_at[hex], "element " + std::to_string(scope.hex_ids[hex]) + " names node " +
                                      std::to_string(id) + ", which is not there");
    return node;
  }

  void hexes(const AbaqusPlaced& placed, const AbaqusScope& scope) {
    const bool skip = &scope == placed.scopes[1] && !placed.repeated_hexes.empty();
    std::size_t run = 0, middles = 0;
    int type = 0;
    for (std::size_t i = 0; i < scope.hex_ids.size(); ++i) {
      if (run < scope.hex_types.size() && scope.hex_types[run].first == i)
        type = type_number(scope.hex_types[run++].second);
      if (skip && placed.repeated_hexes[i]) continue;
      parts_.type_of_hex.push_back(type);
      Hex& hex = out_.mesh.hexes.emplace_back();
      for (std::size_t c = 0; c < 8; ++c) {
        hex[file_corner[c]] = node_of(placed, scope, i, scope.hex_nodes[8 * i + c]);
      }
      while (middles < scope.hex_middles.size() && scope.hex_middles[middles].first < i) ++middles;
      if (middles == scope.hex_middles.size() || scope.hex_middles[middles].first != i) continue;
      std::vector<Index> nodes;
      for (const std::int64_t id : scope.hex_middles[middles].second) nodes.push_back(node_of(placed, scope, i, id));
      parts_.middles.add(out_.mesh.hexes.size() - 1, nodes, abaqus_middles);
    }
  }

  /// Where a node is that an element names.
  Index other_node(const AbaqusPlaced& placed, const AbaqusScope& scope, std::size_t element, std::size_t at) const {
    const std::int64_t id = scope.other_nodes[at];
    const auto named = std::ranges::lower_bound(scope.named_nodes, at, {}, [](const auto& one) { return one.first; });
    std::string text = std::to_string(id);
    Index node = find_node(placed, id);
    if (named != scope.named_nodes.end() && named->first == at) {
      text = shown(named->second.text);
      node = -1;
      const std::string_view said = named->second.text;
      for (const AbaqusPlaced& other : parts_.placed) {
        if (other.name.empty() || said.size() <= other.name.size() + 1 || said[other.name.size()] != '.') continue;
        const std::string_view rest = said.substr(other.name.size() + 1);
        std::int64_t in_part = 0;
        const auto [stop, error] = std::from_chars(rest.data(), rest.data() + rest.size(), in_part);
        if (same_word(said.substr(0, other.name.size()), other.name) && error == std::errc{} &&
            stop == rest.data() + rest.size())
          node = find_node(other, in_part);
      }
    }
    if (node < 0)
      in_.fail(scope.other_at[element],
               "element " + std::to_string(scope.other_ids[element]) + " names node " + text + ", which is not there");
    return node;
  }

  void others() {
    struct One {
      std::int64_t id;
      const char* at;
      int type;
      std::size_t begin, end;  // of its nodes
    };
    std::vector<One> all;
    std::vector<Index> nodes;
    OtherHeads heads;
    heads.format = "abaqus";
    for (const AbaqusPlaced& placed : parts_.placed)
      for (const AbaqusScope* scope : placed.scopes) {
        if (!scope) continue;
        // Some programs write the mesh both in a part and in its instance.
        std::vector<std::int64_t> repeated;
        if (scope == placed.scopes[1]) repeated = sorted_unique(placed.scopes[0]->other_ids);
        std::size_t run = 0;
        int type = 0;
        for (std::size_t e = 0; e < scope->other_ids.size(); ++e) {
          if (run < scope->other_types.size() && scope->other_types[run].first == e)
            type = other_type(heads, scope->other_types[run++].second);
          if (std::ranges::binary_search(repeated, scope->other_ids[e])) continue;
          const std::size_t begin = nodes.size();
          const std::size_t end =
              e + 1 < scope->other_first.size() ? scope->other_first[e + 1] : scope->other_nodes.size();
          for (std::size_t i = scope->other_first[e]; i < end; ++i) nodes.push_back(other_node(placed, *scope, e, i));
          // Here corners come first, there the middle node of a line is the second.
          if (is_bent_line(heads.types[type])) std::swap(nodes[begin + 1], nodes[begin + 2]);
          all.push_back({scope->other_ids[e] + placed.elements.shift, scope->other_at[e], type, begin, nodes.size()});
        }
      }
    if (all.empty()) return;
    std::vector<std::int64_t> ids;
    for (const One& one : all) {
      if (parts_.hexes.find(one.id) >= 0) in_.fail(one.at, "element id " + std::to_string(one.id) + " occurs twice");
      ids.push_back(one.id);
    }
    parts_.others =
        Ids(std::move(ids), "element", [&](std::size_t i, const std::string& what) { in_.fail(all[i].at, what); });
    parts_.others.sort(all);
    std::vector<Index> in_order, starts = {0};
    for (const One& one : all) {
      heads.ids.push_back(one.id);
      heads.type.push_back(one.type);
      in_order.insert(in_order.end(), nodes.begin() + static_cast<std::ptrdiff_t>(one.begin),
                      nodes.begin() + static_cast<std::ptrdiff_t>(one.end));
      starts.push_back(static_cast<Index>(in_order.size()));
    }
    out_.mesh.others = other_elements(std::move(heads), std::move(starts), std::move(in_order));
  }
  static int other_type(OtherHeads& heads, const std::string& name) {
    const auto at = std::ranges::find(heads.types, name, &OtherType::name);
    if (at != heads.types.end()) return static_cast<int>(at - heads.types.begin());
    const AbaqusElement element = abaqus_element(name);
    heads.types.push_back({element.shape, element.n_nodes, name});
    return static_cast<int>(heads.types.size()) - 1;
  }

  Index find_node(const AbaqusPlaced& placed, std::int64_t id) const { return parts_.nodes.find(placed.nodes(id)); }

  const AbaqusContents& in_;
  MeshFile& out_;
  AbaqusParts parts_;
  std::array<std::int64_t, 2> highest_ = {0, 0};  // ids of nodes, of elements
  std::vector<std::int64_t> node_ids_, hex_ids_;
  std::vector<std::pair<const AbaqusScope*, std::size_t>> node_origin_;
  std::vector<const char*> hex_origin_;
  const std::vector<char> no_skip_;
};

}  // namespace

AbaqusParts place_abaqus(const AbaqusContents& contents, MeshFile& out) {
  return AbaqusAssembly(contents, out).result();
}

}  // namespace hextwist::io
