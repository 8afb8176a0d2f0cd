#include "hextwist/parts/join.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "hextwist/base/sorted.h"
#include "hextwist/io/results.h"
#include "hextwist/mesh/arrays.h"

namespace hextwist {
namespace {

using Ids = std::vector<std::int64_t>;

/// The ids of all pieces, ascending, each once.
template <class IdOf>
Ids all_ids(std::span<const MeshedModel* const> pieces, const IdOf& ids_of) {
  Ids all;
  for (const MeshedModel* piece : pieces) {
    const Ids ids = ids_of(piece->mesh);
    all.insert(all.end(), ids.begin(), ids.end());
  }
  sort_unique(all);
  if (all.size() > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
    throw Error("the parts have " + std::to_string(all.size()) + " nodes or hexes together, more than 2147483647");
  return all;
}
Ids node_ids_of(const Mesh& mesh) {
  Ids ids(mesh.points.size());
  for (Index n = 0; n < mesh.n_nodes(); ++n) ids[n] = node_id(mesh, n);
  return ids;
}
Ids hex_ids_of(const Mesh& mesh) {
  Ids ids(mesh.hexes.size());
  for (Index h = 0; h < mesh.n_hexes(); ++h) ids[h] = hex_id(mesh, h);
  return ids;
}
/// Where these ids (ascending) are among all.
std::vector<Index> places(const Ids& ids, const Ids& all) {
  std::vector<Index> place(ids.size());
  std::size_t at = 0;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    while (all[at] != ids[i]) ++at;
    place[i] = static_cast<Index>(at);
  }
  return place;
}
Ids stored(Ids ids) {
  return ids.empty() || ids.back() == std::ssize(ids) ? Ids() : ids;
}

/// Adds the groups and fields that the whole does not have yet.
template <class Group, class Same>
void add_heads(const std::vector<Group>& from, std::vector<Group>& to, const Same& same) {
  std::size_t before = 0;  // where one that is new goes: behind the one before it
  for (const Group& group : from) {
    const auto found = std::ranges::find_if(to, [&](const Group& other) { return same(group, other); });
    if (found != to.end()) {
      before = static_cast<std::size_t>(found - to.begin()) + 1;
      continue;
    }
    Group head = group;
    items_of(head).clear();
    to.insert(to.begin() + static_cast<std::ptrdiff_t>(before++), std::move(head));
  }
}

/// Puts what a piece has into the whole.
struct PutIn {
  const std::vector<Index>&node, &hex;
  std::size_t n_nodes, n_hexes;

  template <class T>
  void operator()(const ArrayTag& tag, const std::vector<T>& piece, std::vector<T>& whole) const {
    if (tag.fresh == Fresh::id || tag.name == "file_hexes" || piece.empty()) return;
    const std::vector<Index>& place = tag.per == Per::node ? node : hex;
    if (whole.empty()) {
      T none{};
      if constexpr (std::same_as<T, double>) none = std::numeric_limits<double>::quiet_NaN();
      if constexpr (std::same_as<T, Vec3>) none = Vec3::Zero();
      whole.resize((tag.per == Per::node ? n_nodes : n_hexes) * tag.width, none);
    }
    for (std::size_t i = 0; i < place.size(); ++i)
      for (std::size_t c = 0; c < tag.width; ++c) {
        T& item = whole[static_cast<std::size_t>(place[i]) * tag.width + c];
        item = piece[i * tag.width + c];
        if constexpr (std::same_as<T, Hex>) rename(item, [&](Index n) { return node[n]; });
      }
  }
  template <IsList Piece, IsList Whole>
  void operator()(const ArrayTag& tag, const Piece& piece, const Whole& whole) const {
    for (std::size_t i = 0; i < piece.items.size(); ++i) {
      auto item = piece.items[i];
      rename(item, [&](Index j) { return (tag.per == Per::node ? node : hex)[j]; });
      whole.items.push_back(item);
      if (whole.values) whole.values->push_back((*piece.values)[i]);
    }
  }
};

/// Members ascend, each once.
struct Tidy {
  template <class T>
  void operator()(const ArrayTag&, std::vector<T>&) const {}
  template <IsList List>
  void operator()(const ArrayTag&, const List& list) const {
    if (!list.values) return sort_unique(list.items);
    std::vector<Index> order(list.items.size());
    std::iota(order.begin(), order.end(), 0);
    sort_unique(order, [&](Index i) { return list.items[i]; });
    list.items = items_at(list.items, order);
    *list.values = items_at(*list.values, order);
  }
};

}  // namespace

MeshedModel join(std::span<const MeshedModel> pieces, const std::function<std::string(std::size_t)>& name) {
  std::vector<const MeshedModel*> all;
  for (const MeshedModel& piece : pieces) all.push_back(&piece);
  return join(std::span<const MeshedModel* const>(all), name);
}

MeshedModel join(std::span<const MeshedModel* const> pieces, const std::function<std::string(std::size_t)>& name) {
  MeshedModel whole;
  const Ids nodes = all_ids(pieces, node_ids_of), hexes = all_ids(pieces, hex_ids_of);
  const auto same_id = [](const auto& a, const auto& b) { return a.id == b.id; };
  for (const MeshedModel* piece : pieces) {
    if (!whole.model) whole.model = piece->model;
    add_heads(piece->mesh.blocks, whole.mesh.blocks, same_id);
    add_heads(piece->mesh.node_sets, whole.mesh.node_sets, same_id);
    add_heads(piece->mesh.side_sets, whole.mesh.side_sets, same_id);
    add_heads(piece->mesh.fields, whole.mesh.fields,
              [](const Field& a, const Field& b) { return a.on == b.on && a.name == b.name; });
  }
  std::vector<int> piece_of_hex(hexes.size(), -1), piece_of_node(nodes.size(), -1);
  whole.mesh.points.resize(nodes.size());
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const MeshedModel& piece = *pieces[p];
    const std::vector<Index> node = places(node_ids_of(piece.mesh), nodes), hex = places(hex_ids_of(piece.mesh), hexes);
    const int me = static_cast<int>(p);
    for (const Index h : hex)
      if (const int other = std::exchange(piece_of_hex[h], me); other >= 0)
        throw Error("hex " + std::to_string(hexes[h]) + " is in " + name(static_cast<std::size_t>(other)) + " and in " +
                    name(p));
    for (std::size_t i = 0; i < node.size(); ++i)
      if (const int other = std::exchange(piece_of_node[node[i]], me);
          other >= 0 && whole.mesh.points[node[i]] != piece.mesh.points[i])
        throw Error("node " + std::to_string(nodes[node[i]]) + " is at one place in " +
                    name(static_cast<std::size_t>(other)) + " and at another in " + name(p));
    for_each_array(PutIn{node, hex, nodes.size(), hexes.size()}, piece, whole);
  }
  for_each_array(Tidy(), whole);
  whole.mesh.node_ids = stored(nodes);
  whole.mesh.hex_ids = stored(hexes);
  return whole;
}

void join_results(std::shared_ptr<const FileResults>& whole, const std::shared_ptr<const FileResults>& part) {
  if (!whole) whole = part;
  if (!part || whole == part) return;
  FileResults joined = *whole;
  for (const FileResults::Property& more : part->properties) {
    const auto known = std::ranges::find_if(joined.properties, [&](const FileResults::Property& property) {
      return property.of == more.of && property.name == more.name;
    });
    if (known == joined.properties.end()) {
      joined.properties.push_back(more);
      continue;
    }
    for (const auto& value : more.values)
      if (std::ranges::find(known->values, value.first, &std::pair<int, std::int64_t>::first) == known->values.end())
        known->values.push_back(value);
  }
  whole = std::make_shared<const FileResults>(std::move(joined));
}

}  // namespace hextwist
