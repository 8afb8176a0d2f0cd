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
    for (const auto& [type, n] : in_.n_dropped)
      out_.notices.push_back("dropped " + counted(n, "element") + " of type " + type);
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
      for (const auto* ids : {&scope.hex_ids, &scope.quad_ids, &scope.other_ids}) f(*ids);
    });
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
    if (hex_ids_.empty()) throw Error(in_.sources[0]->name + ": there is no hex in the file");
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
    for (const AbaqusPlaced& placed : parts_.placed)
      for (const AbaqusScope* scope : placed.scopes)
        if (scope) quads(placed, *scope);
    parts_.quad_sides = oriented_sides(out_.mesh, parts_.quads);
    if (const auto lost = std::ranges::count(parts_.quad_sides, -1, &Side::hex))
      out_.notices.push_back("dropped " + counted(lost, "quad") + (lost == 1 ? " that is" : " that are") +
                             " no side of a hex");
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
  void quads(const AbaqusPlaced& placed, const AbaqusScope& scope) {
    for (std::size_t i = 0; i < scope.quad_ids.size(); ++i) {
      Quad quad;
      for (std::size_t c = 0; c < 4; ++c) {
        const std::int64_t id = scope.quad_nodes[4 * i + c];
        quad[c] = find_node(placed, id);
        if (quad[c] < 0)
          in_.fail(scope.at ? scope.at : in_.sources[0]->data.get(), "element " + std::to_string(scope.quad_ids[i]) +
                                                                         " names node " + std::to_string(id) +
                                                                         ", which is not there");
      }
      const auto at =
          parts_.quad_of_id.emplace(scope.quad_ids[i] + placed.elements.shift, static_cast<Index>(parts_.quads.size()));
      if (at.second) parts_.quads.push_back(quad);
    }
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
