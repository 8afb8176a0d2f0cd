#include "hextwist/io/apart.h"

#include <fstream>

#include "hextwist/base/large_array.h"
#include "hextwist/mesh/others.h"

namespace hextwist::io {
namespace {

/// One list for both ways, so that they can't differ: way(member) of all that is handed over.
template <class Way, class File>
void all_of(Way& way, File& file) {
  auto& mesh = file.mesh;
  way(mesh.points), way(mesh.hexes), way(mesh.node_ids), way(mesh.hex_ids);
  way.each(mesh.blocks, [&](auto& group) { way(group.id), way(group.name), way(group.hexes); });
  way.each(mesh.node_sets, [&](auto& group) { way(group.id), way(group.name), way(group.nodes); });
  way.each(mesh.side_sets, [&](auto& group) { way(group.id), way(group.name), way(group.sides); });
  way.each(mesh.fields, [&](auto& field) {
    way(field.name), way(field.on), way(field.components), way(field.values), way(field.integer);
  });
  auto& tags = file.tags;
  way(tags.node_owner), way(tags.node_parameters), way(tags.curve_edges), way(tags.edge_curve);
  way(tags.surface_faces), way(tags.face_surface), way(tags.hex_volume);
  auto& middles = file.middles;
  way(middles.nodes_per_hex), way(middles.edges), way(middles.edge_points), way(middles.faces);
  way(middles.face_points);
  way.each(file.notices, [&](auto& line) { way(line); });
  way.map(file.extras.nodes_per_hex), way.map(file.extras.boundary_types);
}

template <class Way, class Heads>
void all_of_others(Way& way, Heads& heads) {
  way.each(heads.types, [&](auto& type) { way(type.shape), way(type.n_nodes), way(type.name); });
  way(heads.type), way(heads.ids);
  way.each(heads.sets, [&](auto& set) { way(set.id), way(set.elements); });
  way.each(heads.sides, [&](auto& list) {
    way(list.id), way(list.elements);
    way.each(list.sides, [&](auto& side) { way(side); });
  });
  way.each(heads.fields, [&](auto& field) {
    way(field.name), way(field.components), way(field.values), way(field.is_attribute), way(field.integer);
  });
  way.each(heads.rest, [&](auto& line) { way(line); });
  way(heads.format), way(heads.is_rigid);
}

template <class T>
concept Plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

class Putting {
 public:
  explicit Putting(std::ostream& out) : out_(out) {}
  template <Plain T>
  void operator()(const T& value) {
    put(out_, &value, sizeof value);
  }
  void operator()(const std::string& text) { put(out_, text); }
  template <class T>
  void operator()(const std::vector<T>& items) {
    put_all(out_, items);
  }
  template <class T, class F>
  void each(const std::vector<T>& items, F&& f) {
    (*this)(items.size());
    for (const T& item : items) f(item);
  }
  template <class T>
  void map(const std::map<int, T>& items) {
    (*this)(items.size());
    for (const auto& [key, value] : items) (*this)(key), (*this)(value);
  }

 private:
  std::ostream& out_;
};

class Taking {
 public:
  explicit Taking(const Bytes& bytes) : from_(bytes) { from_.binary = true; }
  template <Plain T>
  void operator()(T& value) {
    value = from_.raw<T>("what was handed over");
  }
  void operator()(std::string& text) {
    text.resize(count(1));
    from_.raw_all(std::span(text), "what was handed over");
  }
  template <class T>
  void operator()(std::vector<T>& items) {
    resize_for_overwrite(items, count(sizeof(T)));
    if (items.size() * sizeof(T) > from_.left()) from_.fail_truncated("what was handed over");
    if (items.empty()) return;
    std::memcpy(static_cast<void*>(items.data()), from_.at, items.size() * sizeof(T));
    from_.at += items.size() * sizeof(T);
  }
  template <class T, class F>
  void each(std::vector<T>& items, F&& f) {
    items.resize(count(1));
    for (T& item : items) f(item);
  }
  template <class T>
  void map(std::map<int, T>& items) {
    for (std::size_t n = count(1); n > 0; --n) {
      int key = 0;
      (*this)(key), (*this)(items[key]);
    }
  }

 private:
  std::size_t count(std::size_t bytes) {
    const auto n = from_.raw<std::size_t>("what was handed over");
    if (n > from_.left() / bytes) from_.fail_truncated("what was handed over");
    return n;
  }
  Cursor from_;
};

/// Does all of it name what is there?
bool fits(const MeshFile& file) {
  const Mesh& mesh = file.mesh;
  const auto n_nodes = mesh.points.size(), n_hexes = mesh.hexes.size();
  constexpr auto most = static_cast<std::size_t>(std::numeric_limits<Index>::max());
  if (n_nodes > most || n_hexes > most) return false;
  const auto nodes = [&](const auto& some) {
    return std::ranges::all_of(some, [&](Index n) { return n >= 0 && n < mesh.n_nodes(); });
  };
  const auto lists_of_nodes = [&](const auto& lists) { return std::ranges::all_of(lists, nodes); };
  const auto sides = [&](const std::vector<Side>& some) {
    return std::ranges::all_of(some, [&](const Side& side) {
      return side.hex >= 0 && side.hex < mesh.n_hexes() && side.face >= 0 && side.face < n_hex_faces;
    });
  };
  const auto none_or = [](const auto& list, std::size_t n) { return list.empty() || list.size() == n; };
  const Association& tags = file.tags;
  const MiddleNodes& middles = file.middles;
  return lists_of_nodes(mesh.hexes) && none_or(mesh.node_ids, n_nodes) && none_or(mesh.hex_ids, n_hexes) &&
         std::ranges::all_of(mesh.blocks,
                             [&](const Block& block) {
                               return std::ranges::all_of(block.hexes,
                                                          [&](Index h) { return h >= 0 && h < mesh.n_hexes(); });
                             }) &&
         std::ranges::all_of(mesh.node_sets, [&](const NodeSet& set) { return nodes(set.nodes); }) &&
         std::ranges::all_of(mesh.side_sets, [&](const SideSet& set) { return sides(set.sides); }) &&
         std::ranges::all_of(mesh.fields,
                             [&](const Field& field) {
                               const bool node = field.on == Field::On::node;
                               return (node || field.on == Field::On::hex) && field.components > 0 &&
                                      field.values.size() ==
                                          static_cast<std::size_t>(field.components) * (node ? n_nodes : n_hexes);
                             }) &&
         none_or(tags.node_owner, n_nodes) && none_or(tags.node_parameters, n_nodes) &&
         lists_of_nodes(tags.curve_edges) && tags.curve_edges.size() == tags.edge_curve.size() &&
         sides(tags.surface_faces) && tags.surface_faces.size() == tags.face_surface.size() &&
         none_or(tags.hex_volume, n_hexes) && lists_of_nodes(middles.edges) && lists_of_nodes(middles.faces) &&
         middles.edges.size() == middles.edge_points.size() && middles.faces.size() == middles.face_points.size();
}

struct Known {
  std::string_view word;
  ReadHere read;
};
constexpr Known known[] = {
#ifdef HEXTWIST_HAS_CGNS
    {"cgns", read_cgns_here},
#endif
#ifdef HEXTWIST_HAS_HDF5
    {"vtkhdf", read_vtkhdf_here},
    {"xdmf", read_xdmf_here},
#endif
#ifdef HEXTWIST_HAS_MED
    {"med", read_med_here},
#endif
    {"", nullptr},
};

}  // namespace

void put_mesh_file(std::ostream& out, const MeshFile& file) {
  Putting putting(out);
  all_of(putting, file);
  const OtherElementsPtr& others = file.mesh.others;
  putting(others != nullptr);
  if (others) all_of_others(putting, *others->heads), putting(others->first), putting(others->nodes);
}

MeshFile take_mesh_file(const Bytes& bytes) {
  MeshFile file;
  Taking taking(bytes);
  all_of(taking, file);
  bool has_others = false;
  taking(has_others);
  if (has_others) {
    OtherHeads heads;
    std::vector<Index> first, nodes;
    all_of_others(taking, heads), taking(first), taking(nodes);
    if (std::ranges::any_of(nodes, [&](Index n) { return n < 0 || n >= file.mesh.n_nodes(); }))
      throw Error(bytes.name + ": an element names a node that is not there (damaged file)");
    file.mesh.others = other_elements(std::move(heads), std::move(first), std::move(nodes));
  }
  if (!fits(file)) throw Error(bytes.name + ": it names nodes or hexes that are not there (damaged file)");
  return file;
}

MeshFile read_apart(const Fence& fence, const std::string& word, ReadHere here, const std::filesystem::path& file,
                    std::uintmax_t more_bytes) {
  const Bytes bytes = read_bytes(file);  // is it there, and does it stay as it is?
  return unchanged_by(bytes, [&] {
    if (!fence.is_there()) return here(file, fence.folder);
    const Handover to;
    read_fenced(fence, "mesh", file, {word, fence.folder.string()}, to, more_bytes);
    Bytes handed_over = read_bytes(to.path());
    handed_over.name = bytes.name;
    return take_mesh_file(handed_over);
  });
}

void serve_mesh(const FencedJob& job) {
  const Known* format = job.words.size() == 2 ? std::ranges::find(known, job.words[0], &Known::word) : std::end(known);
  if (format == std::end(known) || !format->read)
    throw Error(job.file.string() + ": the program that reads it was built without this format");
  const MeshFile read = format->read(job.file, job.words[1]);
  std::ofstream out(job.to, std::ios::binary | std::ios::trunc);
  put_mesh_file(out, read);
  if (!out.flush()) throw std::bad_alloc();
}

}  // namespace hextwist::io
