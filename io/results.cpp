#include "hextwist/io/results.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "hextwist/base/parallel.h"
#include "hextwist/base/sorted.h"
#include "hextwist/io/exodus/exodus_internal.h"
#include "hextwist/mesh/move.h"
#include "hextwist/mesh/nodal_fields.h"

namespace hextwist {
namespace {

/// A value from those of some nodes; nothing where none of them counts.
std::optional<double> weighted(const std::array<double, 8>& weight, const std::array<double, 8>& value) {
  double sum = 0, total = 0;
  for (int c = 0; c < n_hex_corners; ++c) {
    if (weight[c] == 0 || std::isnan(value[c])) continue;
    sum += weight[c] * value[c];
    total += weight[c];
  }
  return total > 0.5 ? std::optional(total == 1 ? sum : sum / total) : std::nullopt;
}

}  // namespace

bool FileResults::empty() const {
  return times.size() < 2 && (times.empty() || times[0] == 0) && of_all.empty() && attributes.empty() &&
         node_sets.empty() && side_sets.empty() && properties.empty() && wide_ids.empty() && title.empty() &&
         coordinate_names.empty() && info.empty() && qa.empty();
}

bool FileResults::has_places() const {
  const auto has_members = [](const SetExtras& set) { return !set.nodes.empty() || !set.sides.empty(); };
  return !on_nodes.empty() || !on_hexes.empty() || !attributes.empty() || std::ranges::any_of(node_sets, has_members) ||
         std::ranges::any_of(side_sets, has_members);
}

std::int64_t FileResults::in_file(Of of, int id) const {
  for (const WideId& wide : wide_ids)
    if (wide.of == of && wide.id == id) return wide.in_file;
  return id;
}

void place_in_itself(Mesh& mesh, FileResults& results) {
  auto file = std::make_shared<Mesh>();
  file->points = mesh.points;
  file->hexes = mesh.hexes;
  results.mesh = std::move(file);
  mesh.file_hexes.resize(mesh.hexes.size());
  std::iota(mesh.file_hexes.begin(), mesh.file_hexes.end(), 0);
}

std::string extras_text(const FileResults& extras) {
  std::string text;
  const auto add = [&](const std::string& what) { text += (text.empty() ? "" : ", ") + what; };
  if (extras.times.size() > 1) {
    const std::size_t n = extras.times.size() - 1;
    add(std::to_string(n) + (n == 1 ? " more time step" : " more time steps"));
  }
  for (const TimedValues& values : extras.of_all) add("global variable '" + values.name + "'");
  for (const TimedValues& values : extras.attributes) add("attribute '" + values.name + "' of hexes");
  const auto add_sets = [&](const std::vector<SetExtras>& sets, const char* kind) {
    for (const SetExtras& set : sets) {
      const std::string of = std::string(" of ") + kind + " " + std::to_string(set.id);
      if (std::ranges::any_of(set.factors, [](double f) { return f != 1; })) add("distribution factors" + of);
      for (const TimedValues& values : set.variables) add("variable '" + values.name + "'" + of);
    }
  };
  add_sets(extras.node_sets, "nodeset");
  add_sets(extras.side_sets, "sideset");
  for (const FileResults::Property& property : extras.properties) add("property '" + property.name + "'");
  return text;
}

std::shared_ptr<const FileResults> results_of_parts(const FileResults& results, std::string& lost) {
  FileResults kept, rest = results;
  kept.title = results.title;
  kept.coordinate_names = results.coordinate_names;
  kept.info = results.info;
  kept.qa = results.qa;
  kept.wide_ids = results.wide_ids;
  kept.properties = std::move(rest.properties);
  rest.properties.clear();
  rest.of_all.clear();
  if (!results.times.empty()) {
    kept.times = {results.times[results.step]};
    for (const TimedValues& values : results.of_all) kept.of_all.push_back({values.name, {values.at[results.step]}});
  }
  const auto take_factors = [](std::vector<SetExtras>& from, std::vector<SetExtras>& to) {
    for (SetExtras& set : from)
      if (set.factors.size() == 1) to.push_back({set.id, {}, {}, std::exchange(set.factors, {}), {}});
  };
  take_factors(rest.node_sets, kept.node_sets);
  take_factors(rest.side_sets, kept.side_sets);
  lost = extras_text(rest);
  return kept.empty() ? nullptr : std::make_shared<const FileResults>(std::move(kept));
}

const std::vector<ExtrasNow::NodeNow>& ExtrasNow::nodes() {
  if (!nodes_.empty()) return nodes_;
  std::vector<Index> all(mesh_.points.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<Index> begin = hexes_to_begin_with(mesh_, all, mesh_.file_hexes);
  constexpr Index of_no_hex = std::numeric_limits<Index>::max();
  for (Index& hex : begin)
    if (hex == of_no_hex) hex = 0;
  nodes_.resize(all.size());
  // Nodes that are where one of the file was have its values to the bit.
  std::vector<Index> elsewhere = indices_where(mesh_.n_nodes(), [&](Index n) {
    NodeNow& node = nodes_[n];
    node.nodes = of_.mesh->hexes[begin[n]];
    for (int c = 0; c < n_hex_corners; ++c)
      if (of_.mesh->points[node.nodes[c]] == mesh_.points[n]) {
        node.weight = {};
        node.weight[c] = 1;
        return false;
      }
    return true;
  });
  const std::vector<Vec3> points = items_at(mesh_.points, elsewhere);
  const std::vector<HexPlace> places = find_places(*of_.mesh, points, items_at(begin, elsewhere));
  parallel_each(elsewhere.size(), [&](std::size_t i) {
    const Index hex = places[i].hex;
    nodes_[elsewhere[i]] = {of_.mesh->hexes[hex], weights_at(corners_of(*of_.mesh, hex), places[i].at, points[i])};
  });
  return nodes_;
}

std::vector<double> ExtrasNow::on_nodes(const std::vector<double>& of_file) {
  std::vector<double> values(mesh_.points.size());
  const std::vector<NodeNow>& now = nodes();
  parallel_each(values.size(), [&](std::size_t n) {
    double sum = 0;
    for (int c = 0; c < n_hex_corners; ++c)
      if (now[n].weight[c] != 0) sum += now[n].weight[c] * of_file[now[n].nodes[c]];
    values[n] = sum;
  });
  return values;
}

std::vector<double> ExtrasNow::on_hexes(const std::vector<double>& of_file) const {
  std::vector<double> values(mesh_.hexes.size());
  parallel_each(values.size(), [&](std::size_t h) { values[h] = of_file[mesh_.file_hexes[h]]; });
  return values;
}

std::vector<double> ExtrasNow::in_set(std::span<const Index> members, const SetExtras& set,
                                      const std::vector<double>& of_members, double none) {
  const std::vector<NodeNow>& now = nodes();
  std::vector<double> values;
  values.reserve(members.size());
  for (const Index n : members) {
    std::array<double, 8> of_corner;
    for (int c = 0; c < n_hex_corners; ++c) {
      const Index at = position_in(set.nodes, now[n].nodes[c]);
      of_corner[c] = at < 0 ? std::numeric_limits<double>::quiet_NaN() : of_members[at];
    }
    values.push_back(weighted(now[n].weight, of_corner).value_or(none));
  }
  return values;
}

Index ExtrasNow::side_then(const Side& side, const SetExtras& set) const {
  const Index hex = mesh_.file_hexes[side.hex];
  const auto of_hex = std::ranges::equal_range(set.sides, hex, {}, &Side::hex);
  if (of_hex.size() < 2) return of_hex.empty() ? -1 : static_cast<Index>(of_hex.begin() - set.sides.begin());
  Vec3 centre = Vec3::Zero();
  for (const Index n : face_nodes(mesh_.hexes[side.hex], side.face)) centre += mesh_.points[n] / 4;
  const std::array<Vec3, 8> corners = corners_of(*of_.mesh, hex);
  HexPlace place;
  if (!find_natural_coordinates(corners, centre, place.at)) place = closest_place(corners, centre);
  const auto away = [&](const Side& then) { return std::abs(place.at[then.face >> 1] - (then.face & 1)); };
  return static_cast<Index>(std::ranges::min_element(of_hex, {}, away) - set.sides.begin());
}

std::vector<double> ExtrasNow::in_set(std::span<const Side> sides, const SetExtras& set,
                                      const std::vector<double>& of_members, double none) const {
  std::vector<double> values(sides.size());
  parallel_each(sides.size(), [&](std::size_t i) {
    const Index then = side_then(sides[i], set);
    values[i] = then < 0 ? none : of_members[then];
  });
  return values;
}

std::vector<double> ExtrasNow::factors(std::span<const Side> sides, const SetExtras& set) const {
  std::vector<double> values(4 * sides.size(), 1);
  parallel_each(sides.size(), [&](std::size_t i) {
    const Index at = side_then(sides[i], set);
    if (at < 0) return;
    const Side then = set.sides[at];
    const std::array<Vec3, 8> corners = corners_of(*of_.mesh, then.hex);
    const auto& cycle_then = io::exodus_cycle(then.face);
    std::array<double, 8> of_corner;
    of_corner.fill(std::numeric_limits<double>::quiet_NaN());
    for (std::size_t k = 0; k < 4; ++k) of_corner[cycle_then[k]] = set.factors[4 * static_cast<std::size_t>(at) + k];
    const auto& cycle = io::exodus_cycle(sides[i].face);
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3& p = mesh_.points[mesh_.hexes[sides[i].hex][cycle[k]]];
      std::array<double, 8> weight{};
      const auto same = std::ranges::find(corners, p);
      if (same != corners.end()) {
        weight[same - corners.begin()] = 1;
      } else {
        // On the face, and on in its directions for a node that has slid over its rim.
        Vec3 place;
        if (!find_natural_coordinates(corners, p, place)) place = closest_place(corners, p).at;
        place[then.face >> 1] = then.face & 1;
        for (int c = 0; c < n_hex_corners; ++c) {
          weight[c] = 1;
          for (int axis = 0; axis < 3; ++axis) weight[c] *= c >> axis & 1 ? place[axis] : 1 - place[axis];
        }
      }
      values[4 * i + k] = weighted(weight, of_corner).value_or(1);
    }
  });
  return values;
}

std::shared_ptr<const FileResults> moved(const FileResults& results, const Similarity& similarity) {
  auto result = std::make_shared<FileResults>(results);
  if (results.mesh) {
    auto mesh = std::make_shared<Mesh>(*results.mesh);
    move(*mesh, similarity);
    result->mesh = std::move(mesh);
  }
  if (!similarity.mirrors()) return result;
  for (SetExtras& set : result->side_sets) {
    const SetExtras before = set;
    std::vector<Index> order(set.sides.size());
    std::iota(order.begin(), order.end(), 0);
    for (Side& side : set.sides) side.face = mirrored_face(side.face);
    std::ranges::sort(order, {}, [&](Index i) { return set.sides[i]; });
    std::ranges::sort(set.sides);
    for (TimedValues& variable : set.variables)
      for (auto& values : variable.at) values = std::make_shared<const std::vector<double>>(items_at(*values, order));
    if (set.factors.size() != 4 * set.sides.size()) continue;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const auto& then = io::exodus_cycle(before.sides[order[i]].face);
      const auto& now = io::exodus_cycle(set.sides[i].face);
      for (std::size_t k = 0; k < 4; ++k) {
        const auto corner = std::ranges::find(then, mirrored_corner(now[k])) - then.begin();
        set.factors[4 * i + k] =
            before.factors[4 * static_cast<std::size_t>(order[i]) + static_cast<std::size_t>(corner)];
      }
    }
  }
  return result;
}

void take_step(Mesh& mesh, std::size_t step) {
  auto extras = std::make_shared<FileResults>(*mesh.results);
  extras->step = step;
  ExtrasNow now(mesh, *extras);
  std::vector<Field> fields;
  for (const TimedValues& values : extras->on_nodes)
    fields.push_back({values.name, Field::On::node, 1, now.on_nodes(*values.at[step])});
  for (const TimedValues& values : extras->on_hexes)
    fields.push_back({values.name, Field::On::hex, 1, now.on_hexes(*values.at[step])});
  for (Field& field : io::merge_components(std::move(fields))) {
    const auto same = std::ranges::find_if(
        mesh.fields, [&](const Field& other) { return other.on == field.on && other.name == field.name; });
    if (same != mesh.fields.end())
      *same = std::move(field);
    else
      mesh.fields.push_back(std::move(field));
  }
  mesh.results = std::move(extras);
}

}  // namespace hextwist
