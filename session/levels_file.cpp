#include "hextwist/session/levels_file.h"

#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>

#include "hextwist/base/sorted.h"
#include "hextwist/geom/facet/model.h"
#include "hextwist/io/extras.h"
#include "hextwist/io/format.h"
#include "hextwist/io/io.h"
#include "hextwist/mesh/association/association.h"
#include "hextwist/mesh/association/meant.h"
#include "hextwist/mesh/others.h"
#include "hextwist/refine/levels/reorder.h"
#include "hextwist/session/load.h"
#include "hextwist/sizing/levelling.h"

namespace hextwist {
namespace {

constexpr std::string_view first_line = "hextwist levels 1\n";

class PieceWriter {
 public:
  explicit PieceWriter(const std::filesystem::path& file) : out_(file, std::ios::binary) { out_ << first_line; }

  template <class T>
  void add(const std::string& name, const std::vector<T>& items) {
    out_ << name << ' ' << sizeof(T) << ' ' << items.size() << '\n';
    out_.write(reinterpret_cast<const char*>(items.data()), static_cast<std::streamsize>(items.size() * sizeof(T)));
    out_ << '\n';
  }
  bool close() {
    out_ << "end 0 0\n";
    out_.close();
    return !out_.fail();
  }

 private:
  std::ofstream out_;
};

/// What stands in a file, by name.
class PieceReader {
 public:
  explicit PieceReader(const std::filesystem::path& file) : bytes_(io::read_bytes(file)) {
    const std::string_view text(bytes_.data.get(), bytes_.size);
    if (!text.starts_with(first_line)) fail("is not a file of levels (version 1)");
    std::size_t at = first_line.size();
    for (;;) {
      const std::size_t end = text.find('\n', at);
      if (end == std::string_view::npos) fail("ends too soon, at byte " + std::to_string(at));
      const std::string_view line = text.substr(at, end - at);
      const std::size_t gap = line.find(' '), second = line.find(' ', gap + 1);
      Piece piece{};
      if (second == std::string_view::npos || !number(line.substr(gap + 1, second - gap - 1), piece.width) ||
          !number(line.substr(second + 1), piece.count))
        fail("has no name, width and count at byte " + std::to_string(at));
      const std::string name(line.substr(0, gap));
      at = end + 1;
      if (name == "end") return;
      if (piece.width == 0 || piece.width > 32 || piece.count > (text.size() - at) / piece.width)
        fail("ends too soon, in " + name);
      piece.data = text.data() + at;
      if (!pieces_.emplace(name, piece).second) fail("has " + name + " twice");
      at += piece.width * piece.count + 1;
      if (at > text.size()) fail("ends too soon, after " + name);
    }
  }

  template <class T>
  std::vector<T> get(const std::string& name) const {
    const auto found = pieces_.find(name);
    if (found == pieces_.end()) fail("has no " + name);
    const Piece& piece = found->second;
    if (piece.width != sizeof(T)) fail("has items of " + std::to_string(piece.width) + " bytes in " + name);
    std::vector<T> items(piece.count);
    if (piece.count > 0) std::memcpy(static_cast<void*>(items.data()), piece.data, piece.count * sizeof(T));
    return items;
  }
  const std::string& name() const { return bytes_.name; }
  void check_unchanged() const { io::check_unchanged(bytes_); }
  bool has(const std::string& name) const { return pieces_.contains(name); }
  [[noreturn]] void fail(const std::string& what) const { throw Error(bytes_.name + " " + what); }

 private:
  struct Piece {
    const char* data;
    std::size_t width, count;
  };
  static bool number(std::string_view text, std::size_t& value) {
    const auto [end, bad] = std::from_chars(text.data(), text.data() + text.size(), value);
    return bad == std::errc() && end == text.data() + text.size();
  }
  io::Bytes bytes_;
  std::map<std::string, Piece> pieces_;
};

struct OwnerRow {
  std::int32_t dim, id;
  bool operator==(const OwnerRow&) const = default;
};
std::vector<OwnerRow> owner_rows(const Association& association) {
  std::vector<OwnerRow> rows;
  for (const Owner& owner : association.node_owner) rows.push_back({owner.dim, owner.id});
  return rows;
}

/// A file that is gone in the end.
struct Scratch {
  std::filesystem::path file;
  explicit Scratch(const std::filesystem::path& beside) : file(beside.string() + ".base.vtu") {}
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
  }
};

/// Each list of the skin that a mesh without CAD began with, and the name that it has here.
template <class Skin, class F>
void for_each_list(Skin& skin, const F& f) {
  f("skin_points", skin.points);
  f("skin_quads", skin.quads);
  f("skin_volumes", skin.quad_volumes);
  if (skin.has_labels) {
    f("skin_surfaces", skin.quad_labels);
    f("skin_edges", skin.labelled_edges);
    f("skin_curves", skin.edge_labels);
    f("skin_vertices", skin.labelled_vertices);
  }
  if (skin.has_middles) {
    f("skin_middle_edges", skin.middle_edges);
    f("skin_edge_points", skin.edge_points);
    f("skin_middle_faces", skin.middle_faces);
    f("skin_face_points", skin.face_points);
  }
}
/// The same of what is said of the base beside its nodes.
template <class Owners, class F>
void for_each_owner_list(Owners& association, const F& f) {
  f("base_edges", association.curve_edges);
  f("base_edge_curves", association.edge_curve);
  f("base_faces", association.surface_faces);
  f("base_face_surfaces", association.face_surface);
  f("base_volumes", association.hex_volume);
}

/// Later refinements lie on the skin.
void write_skin(PieceWriter& out, const FacetSource& skin, const Association& association) {
  const auto write = [&](const char* name, const auto& list) { out.add(name, list); };
  out.add("skin_angle", std::vector<double>{skin.feature_angle});
  for_each_list(skin, write);
  for_each_owner_list(association, write);
}

/// The base on the skin of the file.
MeshedModel on_skin(const PieceReader& in, Mesh mesh) {
  const auto read = [&]<class T>(const char* name, std::vector<T>& list) { list = in.get<T>(name); };
  FacetSource skin;
  const auto angle = in.get<double>("skin_angle");
  if (angle.size() != 1) in.fail("has no skin_angle");
  skin.feature_angle = angle[0];
  skin.has_labels = in.has("skin_surfaces");
  skin.has_middles = in.has("skin_edge_points");
  for_each_list(skin, read);
  MeshedModel base{std::move(mesh), nullptr, {}};
  try {
    base.model = facet_model(skin).model;
  } catch (const Error& error) {
    in.fail("is damaged: " + std::string(error.what()));
  }
  Association& association = base.association;
  for (const OwnerRow row : in.get<OwnerRow>("base_owners")) association.node_owner.push_back({row.dim, row.id});
  association.node_parameters = in.get<Parameters>("base_parameters");
  for_each_owner_list(association, read);
  for (const std::string& line : check_association(base.mesh, association, *base.model))
    in.fail("has owners that do not fit its mesh: " + line);
  return base;
}

/// What a node set of the base is meant to hold.
struct MeantRow {
  std::int32_t set, dim, id;
};
void read_meant(const PieceReader& in, MeshedModel& base) {
  if (!in.has("base_meant")) {
    std::vector<std::string> told;  // when the file of the mesh was read
    find_meant_entities(base.mesh, base.association, told);
    return;
  }
  for (const MeantRow& row : in.get<MeantRow>("base_meant")) {
    const auto set = std::ranges::find(base.mesh.node_sets, row.set, &NodeSet::id);
    if (set == base.mesh.node_sets.end() || row.dim < 1 || row.dim > 3 || row.id < 1 ||
        row.id > base.model->count(row.dim))
      in.fail("has a base_meant that cannot be");
    set->meant.push_back({row.dim, row.id});
  }
  for (NodeSet& set : base.mesh.node_sets) sort_unique(set.meant);
}

MeshedModel read_base(Transaction& run, const PieceReader& in) {
  const auto bytes = in.get<char>("base");
  auto copy = std::make_unique_for_overwrite<char[]>(bytes.size());
  std::ranges::copy(bytes, copy.get());
  MeshFile read = io::read_vtu({in.name() + ", its base", {copy.release(), io::ReleaseBytes{}}, bytes.size()});
  MeshedModel base;
  if (!run.state.has_cad && in.has("skin_points")) return on_skin(in, std::move(read.mesh));
  if (run.state.has_cad) {
    AssociateResult on_cad =
        associate(read.mesh, *run.meshed->model, &read.tags, {.relative_tolerance = run.state.tolerance});
    base = {std::move(read.mesh), run.meshed->model, std::move(on_cad.association)};
  } else {
    FacetResult skin =
        associate_with_own_skin(read.mesh, {.feature_angle = run.state.feature_angle, .middles = &read.middles});
    base = {std::move(read.mesh), std::move(skin.model), std::move(skin.association)};
  }
  if (owner_rows(base.association) != in.get<OwnerRow>("base_owners"))
    in.fail(run.state.has_cad ? "is of a mesh on other CAD: its nodes do not lie on the same entities"
                              : "is of a mesh on CAD, which is not there: import it first");
  base.association.node_parameters = in.get<Parameters>("base_parameters");
  if (base.association.node_parameters.size() != base.mesh.points.size()) in.fail("has too few base_parameters");
  return base;
}

LevelMarks read_marks(const PieceReader& in, const Mesh& base) {
  LevelMarks marks;
  CellNumber n_cells = base.n_hexes();
  for (int k = 0; in.has("cells_" + std::to_string(k)); ++k, n_cells *= n_cell_children) {
    check_levels(k + 1, base.n_hexes());
    CellMarks level{in.get<CellNumber>("cells_" + std::to_string(k)),
                    in.get<std::uint8_t>("corners_" + std::to_string(k))};
    if (level.cell.empty() || level.cell.size() != level.corners.size() || level.cell.front() < 0 ||
        level.cell.back() >= n_cells ||
        std::ranges::adjacent_find(level.cell, std::greater_equal{}) != level.cell.end() ||
        std::ranges::count(level.corners, 0) > 0)
      in.fail("has cells of level " + std::to_string(k) + " that cannot be");
    marks.push_back(std::move(level));
  }
  if (closed(marks) != marks) in.fail("has cells of which the larger ones around are missing");
  return marks;
}

bool is_permutation(const std::vector<Index>& order, Index n) {
  if (order.empty()) return true;
  std::vector<std::uint8_t> seen(static_cast<std::size_t>(n), 0);
  for (const Index i : order) {
    if (i < 0 || i >= n || seen[i]) return false;
    seen[i] = 1;
  }
  return static_cast<Index>(order.size()) == n;
}

/// Throws Error unless both are the same mesh, but for rounded places, and for ids where the file of `other` had none.
/// Returns whether ids are the same.
bool check_same(const PieceReader& in, const Mesh& mesh, const Mesh& other) {
  const double close = 1e-5 * box(mesh).diagonal();
  const auto fail = [&](const std::string& what) { in.fail("is of another mesh than the one that is there: " + what); };
  if (mesh.n_nodes() != other.n_nodes() || mesh.n_hexes() != other.n_hexes())
    fail(counted(mesh.n_hexes(), EntityKind::hex) + " and " + counted(mesh.n_nodes(), EntityKind::node) +
         ", there are " + std::to_string(other.n_hexes()) + " and " + std::to_string(other.n_nodes()));
  for (Index h = 0; h < mesh.n_hexes(); ++h)
    if (mesh.hexes[h] != other.hexes[h]) fail("the corners of hex " + std::to_string(hex_id(other, h)) + " differ");
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if (!((mesh.points[n] - other.points[n]).norm() <= close))
      fail("the place of node " + std::to_string(node_id(other, n)) + " differs");
  bool same = true;
  const auto compare = [&](const char* what, std::int64_t id, std::int64_t there, bool has_ids) {
    if (id == there) return;
    if (has_ids) fail(std::string(what) + " " + std::to_string(id) + " is " + std::to_string(there) + " there");
    same = false;
  };
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    compare("node", node_id(mesh, n), node_id(other, n), !other.node_ids.empty());
  for (Index h = 0; h < mesh.n_hexes(); ++h) compare("hex", hex_id(mesh, h), hex_id(other, h), !other.hex_ids.empty());
  return same;
}

/// Blocks and sets of one kind that are not, or otherwise, in another mesh.
template <class Groups, class Members>
void add_lost_groups(const Groups& there, const Groups& now, const char* kind, const Members& members,
                     std::vector<std::string>& lost) {
  for (const auto& group : there) {
    const auto same = std::ranges::find(now, group.id, &std::remove_cvref_t<decltype(group)>::id);
    if (same == now.end() || same->name != group.name || members(*same) != members(group))
      lost.push_back(std::string(kind) + " " + std::to_string(group.id) +
                     (group.name.empty() ? "" : " '" + group.name + "'"));
  }
}
std::vector<std::string> lost_groups(const Mesh& there, const Mesh& now) {
  std::vector<std::string> lost;
  add_lost_groups(
      there.blocks, now.blocks, "block", [](const Block& of) { return of.hexes; }, lost);
  add_lost_groups(
      there.node_sets, now.node_sets, "nodeset", [](const NodeSet& of) { return of.nodes; }, lost);
  add_lost_groups(
      there.side_sets, now.side_sets, "sideset", [](const SideSet& of) { return of.sides; }, lost);
  return lost;
}

}  // namespace

void write_levels(const Transaction& run, const std::filesystem::path& file, bool overwrite) {
  if (!run.state.levelling) throw Error("there are no levels to export: this mesh is a base");
  if (run.meshed->mesh.others)
    throw Error("levels of a mesh with other elements can't be exported: it has " + others_text(run.meshed->mesh));
  Levelling levelling = *run.state.levelling;
  levelling.forest = with_stack(grown(std::move(levelling.forest)), run.meshed->mesh);
  const MeshedModel& base = *levelling.forest.base;
  const GrownForest& forest = *levelling.forest.grown;
  Replacement replacement(file, overwrite);
  const Scratch scratch(replacement.temporary());
  write_mesh(scratch.file, base.mesh, &base.association, {.write_quality = false, .order = 1});
  const io::Bytes vtu = io::read_bytes(scratch.file);
  PieceWriter out(replacement.temporary());
  out.add("base", std::vector<char>(vtu.data.get(), vtu.data.get() + vtu.size));
  out.add("base_parameters", base.association.node_parameters);
  out.add("base_owners", owner_rows(base.association));
  if (const FacetSource* skin = base.model ? facet_source(*base.model) : nullptr)
    write_skin(out, *skin, base.association);
  std::vector<MeantRow> meant;
  for (const NodeSet& set : base.mesh.node_sets)
    for (const Owner& owner : set.meant) meant.push_back({set.id, owner.dim, owner.id});
  out.add("base_meant", meant);
  for (std::size_t k = 0; k < levelling.forest.wished.size(); ++k) {
    out.add("cells_" + std::to_string(k), levelling.forest.wished[k].cell);
    out.add("corners_" + std::to_string(k), levelling.forest.wished[k].corners);
  }
  const Mesh& mesh = run.meshed->mesh;
  std::vector<std::int64_t> node_ids, hex_ids;
  for (Index n = 0; n < mesh.n_nodes(); ++n) node_ids.push_back(node_id(mesh, n));
  for (Index h = 0; h < mesh.n_hexes(); ++h) hex_ids.push_back(hex_id(mesh, h));
  out.add("node_ids", node_ids);
  out.add("hex_ids", hex_ids);
  out.add("node_order", forest.node_order);
  out.add("hex_order", forest.hex_order);
  out.add("next_ids", std::vector<std::int64_t>{forest.next_node_id, forest.next_hex_id});
  out.add("smoothed", levelling.overlay.nodes);
  out.add("smoothed_points", levelling.overlay.points);
  out.add("smoothed_parameters", levelling.overlay.parameters);
  if (run.state.extras && !run.state.extras->nodes_per_hex.empty()) {
    std::vector<std::array<std::int32_t, 2>> rows;
    for (const auto& [block, n] : run.state.extras->nodes_per_hex) rows.push_back({block, n});
    out.add("nodes_per_hex", rows);
  }
  if (!out.close()) replacement.fail("cannot be written (disk full?)");
  replacement.commit();
}

void read_levels(Transaction& run, const std::filesystem::path& file) {
  const PieceReader in(file);
  Levelling levelling;
  Forest& forest = levelling.forest;
  MeshedModel base = read_base(run, in);
  read_meant(in, base);
  forest.base = std::make_shared<const MeshedModel>(std::move(base));
  forest.wished = read_marks(in, forest.base->mesh);
  auto made = std::make_shared<GrownForest>();
  MeshedModel mesh = grown_mesh(forest, *made);
  made->node_order = in.get<Index>("node_order");
  made->hex_order = in.get<Index>("hex_order");
  const Index n_nodes = mesh.mesh.n_nodes(), n_hexes = mesh.mesh.n_hexes();
  if (!is_permutation(made->node_order, n_nodes) || !is_permutation(made->hex_order, n_hexes))
    in.fail("has orders of nodes or hexes that do not fit its cells");
  mesh = reordered(mesh, made->node_order, made->hex_order);
  mesh.mesh.node_ids = in.get<std::int64_t>("node_ids");
  mesh.mesh.hex_ids = in.get<std::int64_t>("hex_ids");
  const auto next = in.get<std::int64_t>("next_ids");
  const auto ascend = [](const std::vector<std::int64_t>& ids, Index n) {
    return static_cast<Index>(ids.size()) == n && ids.front() > 0 &&
           std::ranges::adjacent_find(ids, std::greater_equal{}) == ids.end();
  };
  if (!ascend(mesh.mesh.node_ids, n_nodes) || !ascend(mesh.mesh.hex_ids, n_hexes) || next.size() != 2 ||
      next[0] <= mesh.mesh.node_ids.back() || next[1] <= mesh.mesh.hex_ids.back())
    in.fail("has ids that do not fit its cells");
  if (mesh.mesh.node_ids.back() == n_nodes && forest.base->mesh.node_ids.empty()) mesh.mesh.node_ids = {};
  made->hexes = handed_hexes(made->pieces, made->hex_order, forest.base->mesh.n_hexes());
  made->next_node_id = next[0];
  made->next_hex_id = next[1];
  forest.grown = made;

  Overlay& overlay = levelling.overlay;
  overlay = {in.get<Index>("smoothed"), in.get<Vec3>("smoothed_points"), in.get<Parameters>("smoothed_parameters")};
  const auto fits = [&](Index n) { return n >= 0 && n < n_nodes; };
  if (overlay.nodes.size() != overlay.points.size() || overlay.nodes.size() != overlay.parameters.size() ||
      !std::ranges::all_of(overlay.nodes, fits) ||
      std::ranges::adjacent_find(overlay.nodes, std::greater_equal{}) != overlay.nodes.end() ||
      !std::ranges::all_of(overlay.points, [](const Vec3& p) { return p.allFinite(); }))
    in.fail("has smoothed nodes that cannot be");
  for (std::size_t i = 0; i < overlay.nodes.size(); ++i) {
    mesh.mesh.points[overlay.nodes[i]] = overlay.points[i];
    mesh.association.node_parameters[overlay.nodes[i]] = overlay.parameters[i];
  }
  const Mesh& there = run.meshed->mesh;
  if (there.n_hexes() > 0) {
    if (!check_same(in, mesh.mesh, there))
      run.note(file.string() + ": nodes and hexes have the ids of the levels; the mesh came without");
    mesh.mesh.fields = there.fields;
    mesh.mesh.results = there.results;
    mesh.mesh.file_hexes = there.file_hexes;
    if (std::vector<std::string> lost = lost_groups(there, mesh.mesh); !lost.empty()) {
      constexpr std::size_t most = 5;
      const std::size_t n_more = lost.size() - std::min(lost.size(), most);
      lost.resize(lost.size() - n_more);
      run.note(file.string() + ": blocks and sets are those of the levels; the mesh had others: " + joined(lost, ", ") +
               (n_more > 0 ? " and " + std::to_string(n_more) + " more" : ""));
    }
  }
  const bool is_alone = there.n_hexes() == 0;
  in.check_unchanged();
  load_meshed(run, std::move(mesh));
  run.state.periodic = nullptr;
  if (is_alone) forget_members(run.state, !run.state.has_cad);  // else they are the same nodes and hexes
  if (is_alone && in.has("nodes_per_hex")) {
    FileExtras extras;
    for (const auto& [block, n] : in.get<std::array<std::int32_t, 2>>("nodes_per_hex"))
      if (n == 8 || n == 20 || n == 27) extras.nodes_per_hex[block] = n;
    run.state.extras = std::make_shared<const FileExtras>(std::move(extras));
  }
  run.state.tags = nullptr;
  run.state.levelling = std::make_shared<const Levelling>(std::move(levelling));
}

}  // namespace hextwist
