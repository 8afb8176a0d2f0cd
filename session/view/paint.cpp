#include "hextwist/session/view/paint.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "hextwist/base/sorted.h"
#include "hextwist/base/text.h"
#include "hextwist/command/error_at.h"
#include "hextwist/mesh/corners.h"

namespace hextwist {
namespace {

constexpr Colour curve_colour = {50, 50, 60}, chosen_colour = {200, 30, 30}, plain_colour = {214, 221, 231},
                 cad_colour = {189, 199, 214};
constexpr int most_places = 24;  // of a label

std::array<Colour, 4> all_four(const Colour& colour) {
  return {colour, colour, colour, colour};
}

Colour shaded(const Colour& colour, double shade) {
  Colour result;
  for (int k = 0; k < 3; ++k) result[k] = static_cast<std::uint8_t>(std::lround(std::min(255.0, shade * colour[k])));
  return result;
}

std::string row_text(EntityKind kind, int id, const std::string& name) {
  return std::string(hextwist::name(kind)) + " " + std::to_string(id) +
         (name.empty() ? "" : " '" + printable(name) + "'");
}

/// The ring in which a plane cuts a hex, and where in the hex its corners are.
struct Ring {
  std::vector<Vec3> points;
  std::vector<std::array<double, 8>> weights;
};
Ring section(const Mesh& mesh, Index hex, const SceneCut& cut) {
  std::array<double, 8> height;
  for (int c = 0; c < 8; ++c) height[c] = cut.normal.dot(mesh.points[mesh.hexes[hex][c]]) - cut.distance;
  const auto [low, high] = std::ranges::minmax(height);
  Ring ring;
  if (!(low < 0 && high >= 0)) return ring;
  for (int e = 0; e < n_hex_edges; ++e) {
    const int i = edge_corner(e, 0), j = edge_corner(e, 1);
    if ((height[i] < 0) == (height[j] < 0)) continue;
    const double w = height[i] / (height[i] - height[j]);
    ring.points.emplace_back((1 - w) * mesh.points[mesh.hexes[hex][i]] + w * mesh.points[mesh.hexes[hex][j]]);
    std::array<double, 8> weights{};
    weights[i] = 1 - w;
    weights[j] = w;
    ring.weights.push_back(weights);
  }
  // In the order of their angles around the middle.
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : ring.points) middle += p / static_cast<double>(ring.points.size());
  const Vec3 u = cut.normal.unitOrthogonal(), v = cut.normal.cross(u);
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < ring.points.size(); ++i) {
    const Vec3 d = ring.points[i] - middle;
    order.emplace_back(std::atan2(d.dot(v), d.dot(u)), i);
  }
  std::ranges::sort(order);
  Ring sorted;
  for (const auto& [angle, i] : order) {
    sorted.points.push_back(ring.points[i]);
    sorted.weights.push_back(ring.weights[i]);
  }
  return sorted;
}

class Painter {
 public:
  Painter(const SceneSource& source, const SceneStart& start)
      : source_(source), start_(start), selector_(source.selector), mesh_(source.selector.meshed.mesh) {
    local_.assign(mesh_.points.size(), -1);
    axes_ = axes_of(start.view, picture_.up);
    picture_.view = start.view;
  }

  Picture paint() {
    const bool has_mesh = mesh_.n_hexes() > 0;
    if (!has_mesh || start_.shows_cad) {
      cad();
      if (start_.cut) clip(picture_, start_.cut->normal, start_.cut->distance);
      highlight();
      order_labels();
      return std::move(picture_);
    }
    const int dim = start_.has_range ? dimension(start_.kind) : 3;
    const bool is_sheet = start_.kind == EntityKind::sheet;
    stands_out_ = start_.has_range && dim < 2 && dim >= 0 && !is_sheet;
    choose(dim);
    colours(dim);
    if (start_.has_range && dim == 2)
      faces(related(selector_, start_.kind, start_.positions, EntityKind::face));
    else
      skin();
    if (start_.cut && !start_.cut->whole) {
      clip(picture_, start_.cut->normal, start_.cut->distance);
      if (dim != 2 || !start_.has_range) sections();
    }
    mesh_labels();
    for (const auto& [a, b] : selector_.meshed.association.curve_edges)
      picture_.lines.push_back({mesh_.points[a], mesh_.points[b], curve_colour, 2.2F, false});
    dots();
    if (stands_out_) highlight();
    order_labels();
    return std::move(picture_);
  }

 private:
  const SceneSource& source_;
  const SceneStart& start_;
  const Selector& selector_;
  const Mesh& mesh_;
  Picture picture_;
  std::array<Vec3, 3> axes_;
  bool stands_out_ = false;          // the mesh is but the background of what was asked for
  std::vector<char> chosen_;         // per hex
  std::vector<std::int32_t> local_;  // per node: its place in the picture

  // What gives the colours: rows of the legend per hex or per face, or values per hex or node.
  std::vector<int> hex_row_, face_row_;
  std::vector<double> values_;
  bool on_nodes_ = false;
  std::vector<std::pair<std::vector<Index>, int>> dots_;  // nodes and their row

  struct Drawn {
    Index hex, face;
  };
  std::vector<Drawn> drawn_;
  std::map<std::int64_t, std::vector<Vec3>> label_places_;

  void choose(int dim) {
    chosen_.assign(mesh_.hexes.size(), !start_.has_range || dim == 0 || dim == 1 || dim == 2);
    if (start_.kind == EntityKind::sheet && start_.has_range) {
      std::ranges::fill(chosen_, 0);
      for (const Index sheet : start_.positions)
        for (const Index h : selector_.topology.sheets().hexes[sheet]) chosen_[h] = 1;
    } else if (start_.has_range && (dim == 3 || dim < 0)) {
      for (const Index h : related(selector_, start_.kind, start_.positions, EntityKind::hex)) chosen_[h] = 1;
    }
    if (start_.cut && start_.cut->whole)
      for (Index h = 0; h < mesh_.n_hexes(); ++h)
        if (start_.cut->normal.dot(centre(h)) > start_.cut->distance) chosen_[h] = 0;
  }
  Vec3 centre(Index h) const {
    Vec3 sum = Vec3::Zero();
    for (const Index n : mesh_.hexes[h]) sum += mesh_.points[n] / n_hex_corners;
    return sum;
  }

  // Colours.

  int add_row(const std::string& text, const Colour& colour) {
    picture_.legend.push_back({colour, text});
    return static_cast<int>(picture_.legend.size()) - 1;
  }
  int add_row(const std::string& text) { return add_row(text, row_colour(picture_.legend.size())); }

  void rows_of_hexes(const std::string& text, std::span<const Index> hexes) {
    hex_row_.resize(mesh_.hexes.size(), -1);
    const int row = add_row(text);
    for (const Index h : hexes)
      if (hex_row_[h] < 0) hex_row_[h] = row;
  }

  void colours(int dim) {
    const std::string& colour = start_.colour;
    if (colour.empty()) return stands_out_ ? void() : usual_colours(dim);
    if (same_word(colour, "none")) return;
    if (same_word(colour, "surface")) return by_surface();
    if (same_word(colour, "sheet")) return by_sheet();
    if (same_word(colour, "owner")) return by_owner();
    if (same_word(colour, "nodeset")) return by_node_set();
    if (same_word(colour, "sideset")) return by_side_set();
    if (same_word(colour, "group")) return by_group();
    for (const Channel& channel : channels(source_))
      if (same_word(channel.name, colour)) return channel.is_class ? by_class(channel) : by_value(channel);
    throw Error("nothing here is called '" + printable(colour) + "' that could give the colours: there are " +
                joined(scene_colours(source_), ", "));
  }

  /// What tells hexes apart: sheets, blocks, volumes.
  void usual_colours(int dim) {
    if (start_.has_range && start_.kind == EntityKind::sheet) {
      for (const Index sheet : start_.positions)
        rows_of_hexes("sheet " + std::to_string(sheet + 1), selector_.topology.sheets().hexes[sheet]);
    } else if (dim == 2 || mesh_.blocks.size() > 1) {
      for (const Block& block : mesh_.blocks)
        rows_of_hexes(row_text(EntityKind::block, block.id, block.name), block.hexes);
    } else if (selector_.meshed.model && selector_.meshed.model->count(3) > 1) {
      by_class(channels(source_).front());
    }
  }

  void by_class(const Channel& channel) {
    const std::vector<std::uint32_t> numbers = classes_of(source_, channel);
    std::map<std::uint32_t, int> row;
    for (Index h = 0; h < mesh_.n_hexes(); ++h)
      if (chosen_[h]) row[numbers[h]] = 0;
    const double most = row.empty() ? 1 : std::max(1.0, static_cast<double>(row.rbegin()->first));
    for (auto& [number, place] : row) {
      const auto named =
          std::ranges::find(channel.classes, static_cast<int>(number), &std::pair<int, std::string>::first);
      const bool has_name = named != channel.classes.end();
      const Colour colour = channel.what == Channel::What::level
                                ? scale_colour(ScaleKind::plain, 0.3 + 0.7 * number / most)
                            : has_name ? row_colour(static_cast<std::size_t>(named - channel.classes.begin()))
                                       : row_colour(number == 0 ? 9 : number - 1);
      place = add_row(has_name ? printable(named->second) : channel.name + " " + std::to_string(number), colour);
    }
    hex_row_.assign(mesh_.hexes.size(), -1);
    for (Index h = 0; h < mesh_.n_hexes(); ++h)
      if (chosen_[h]) hex_row_[h] = row[numbers[h]];
  }

  void by_value(const Channel& channel) {
    values_ = values_of(source_, channel);
    on_nodes_ = channel.on_nodes;
    Picture::Scale& scale = picture_.scale;
    scale.name = channel.name;
    double low = INFINITY, high = -INFINITY;
    const auto add = [&](double v) {
      low = std::min(low, std::isnan(v) ? low : v);
      high = std::max(high, std::isnan(v) ? high : v);
    };
    for (Index h = 0; h < mesh_.n_hexes(); ++h) {
      if (!chosen_[h]) continue;
      if (on_nodes_)
        for (const Index n : mesh_.hexes[h]) add(values_[n]);
      else
        add(values_[h]);
    }
    if (!(low <= high)) low = 0, high = 1;
    scale.least = scale.low = low;
    scale.most = scale.high = high;
    scale.kind = ScaleKind::plain;
    if (channel.what == Channel::What::metric) {
      // Good is the ideal where there is one, and bad is 0 for the metrics between 0 and 1.
      const bool is_small = small_is_better(channel.metric);
      const double best = ideal(channel.metric);
      scale.kind = is_small ? ScaleKind::bad : ScaleKind::good;
      if (is_small && std::isfinite(best)) scale.low = best;
      if (!is_small && std::isfinite(best)) scale.low = std::min(0.0, low), scale.high = best;
    }
    if (!(scale.high > scale.low)) scale.high = scale.low + std::max(std::abs(scale.low) * 1e-6, 1e-12);
  }

  void by_surface() {
    const Association& association = selector_.meshed.association;
    face_row_.assign(selector_.topology.faces().sides.size(), -1);
    std::map<int, int> row;
    for (const int id : association.face_surface) row[id] = 0;
    for (auto& [id, place] : row)
      place = add_row(row_text(EntityKind::surface, id, selector_.meshed.model->name({2, id})),
                      row_colour(static_cast<std::size_t>(id - 1)));
    for (std::size_t i = 0; i < association.surface_faces.size(); ++i)
      face_row_[face_of(association.surface_faces[i])] = row[association.face_surface[i]];
  }

  void by_sheet() {
    const std::vector<Index> sheets = smallest_sheets(source_);
    std::map<Index, int> row;
    for (Index h = 0; h < mesh_.n_hexes(); ++h)
      if (chosen_[h]) row[sheets[h]] = 0;
    for (auto& [sheet, place] : row)
      place = add_row("sheet " + std::to_string(sheet + 1), row_colour(static_cast<std::size_t>(sheet)));
    hex_row_.assign(mesh_.hexes.size(), -1);
    for (Index h = 0; h < mesh_.n_hexes(); ++h)
      if (chosen_[h]) hex_row_[h] = row[sheets[h]];
  }

  void by_owner() {
    stands_out_ = true;
    std::array<std::vector<Index>, 3> nodes;
    for (Index n = 0; n < mesh_.n_nodes(); ++n) {
      const Owner owner = owner_of_node(selector_.meshed.association, n);
      if (owner && owner.dim < 3) nodes[static_cast<std::size_t>(owner.dim)].push_back(n);
    }
    for (int dim = 0; dim < 3; ++dim)
      dots_.emplace_back(std::move(nodes[static_cast<std::size_t>(dim)]),
                         add_row(std::string("nodes of ") + (dim == 0   ? "vertices"
                                                             : dim == 1 ? "curves"
                                                                        : "surfaces"),
                                 row_colour(static_cast<std::size_t>(dim) + 1)));
  }

  void by_node_set() {
    stands_out_ = true;
    for (const NodeSet& set : mesh_.node_sets)
      dots_.emplace_back(set.nodes, add_row(row_text(EntityKind::nodeset, set.id, set.name)));
  }

  void by_side_set() {
    stands_out_ = true;
    face_row_.assign(selector_.topology.faces().sides.size(), -1);
    for (const SideSet& set : mesh_.side_sets) {
      const int row = add_row(row_text(EntityKind::sideset, set.id, set.name));
      for (const Side& side : set.sides)
        if (int& of = face_row_[face_of(side)]; of < 0) of = row;
    }
  }

  void by_group() {
    stands_out_ = true;
    hex_row_.assign(mesh_.hexes.size(), -1);
    face_row_.assign(selector_.topology.faces().sides.size(), -1);
    for (const Group& group : selector_.groups) {
      const int row = add_row(row_text(EntityKind::group, group.id, group.name));
      GroupShape shape = shape_of(selector_, group);
      for (const Index f : shape.faces)
        if (face_row_[f] < 0) face_row_[f] = row;
      for (const Index h : shape.hexes)
        if (hex_row_[h] < 0) hex_row_[h] = row;
      dots_.emplace_back(std::move(shape.nodes), row);
    }
  }

  Index face_of(const Side& side) const { return selector_.topology.faces().of_hex[side.hex][side.face]; }

  Colour value_colour(double value) const {
    const Picture::Scale& scale = picture_.scale;
    if (std::isnan(value)) return {128, 128, 128};
    return scale_colour(scale.kind, (value - scale.low) / (scale.high - scale.low));
  }
  Colour colour_of(Index hex, Index face) const {
    if (!values_.empty()) return value_colour(values_[hex]);
    if (face >= 0 && !face_row_.empty() && face_row_[face] >= 0) return picture_.legend[face_row_[face]].colour;
    if (!hex_row_.empty() && hex_row_[hex] >= 0) return picture_.legend[hex_row_[hex]].colour;
    if (stands_out_ || !face_row_.empty()) return plain_colour;
    return row_colour(hex_row_.empty() ? 0 : picture_.legend.size());
  }

  // Facets.

  void facet(Index hex, int face) {
    Picture::Facet facet;
    const auto cycle = face_node_cycle(mesh_.hexes[hex], face);
    const Index of = face_of({hex, static_cast<std::uint8_t>(face)});
    facet.colours = all_four(on_nodes_ ? plain_colour : colour_of(hex, of));
    for (int i = 0; i < 4; ++i) {
      std::int32_t& local = local_[cycle[i]];
      if (local < 0) {
        local = static_cast<std::int32_t>(picture_.points.size());
        picture_.points.push_back(mesh_.points[cycle[i]]);
      }
      facet.corners[i] = local;
      if (on_nodes_) facet.colours[i] = value_colour(values_[cycle[i]]);
    }
    drawn_.push_back({hex, of});
    picture_.facets.push_back(facet);
  }

  void skin() {
    for (const auto& sides : selector_.topology.faces().sides) {
      const bool first = chosen_[sides[0].hex], second = sides[1].hex >= 0 && chosen_[sides[1].hex];
      if (first == second) continue;
      const Side side = sides[first ? 0 : 1];
      facet(side.hex, side.face);
    }
  }

  void faces(const std::vector<Index>& which) {
    for (const Index f : which) {
      const auto& sides = selector_.topology.faces().sides[f];
      const int of = chosen_[sides[0].hex] ? 0 : sides[1].hex >= 0 && chosen_[sides[1].hex] ? 1 : -1;
      if (of >= 0) facet(sides[of].hex, sides[of].face);
    }
  }

  /// Only those that are on what is drawn.
  void dots() {
    constexpr float width = 14;
    std::vector<char> has_dot(mesh_.points.size(), 0);
    for (const auto& [nodes, row] : dots_)
      for (const Index n : nodes)
        if (local_[n] >= 0 && !has_dot[n] && !is_beyond(mesh_.points[n])) {
          has_dot[n] = 1;
          picture_.lines.push_back({mesh_.points[n], mesh_.points[n], picture_.legend[row].colour, width, false});
        }
  }

  /// What the plane cuts of the hexes.
  void sections() {
    for (Index h = 0; h < mesh_.n_hexes(); ++h) {
      if (!chosen_[h]) continue;
      const Ring ring = section(mesh_, h, *start_.cut);
      if (ring.points.size() < 3) continue;
      const auto first = static_cast<std::int32_t>(picture_.points.size());
      std::vector<Colour> colours(ring.points.size(), on_nodes_ ? plain_colour : colour_of(h, -1));
      Vec3 middle = Vec3::Zero();
      for (std::size_t i = 0; i < ring.points.size(); ++i) {
        picture_.points.push_back(ring.points[i]);
        middle += ring.points[i] / static_cast<double>(ring.points.size());
        if (!on_nodes_) continue;
        double value = 0;
        for (int c = 0; c < 8; ++c)
          if (ring.weights[i][c] != 0) value += ring.weights[i][c] * values_[mesh_.hexes[h][c]];
        colours[i] = value_colour(value);
      }
      const auto n = static_cast<int>(ring.points.size());
      for (int i = 1; i + 1 < n; i += 2) {
        const int last = std::min(i + 2, n - 1);
        Picture::Facet piece{.corners = {first, first + i, first + i + 1, first + last},
                             .colours = {colours[0], colours[i], colours[i + 1], colours[last]}};
        // The rim alone is drawn: from corner to corner, and back to the first one at both ends.
        piece.edges =
            static_cast<std::uint8_t>((i == 1 ? 1 : 0) | 2 | (last > i + 1 ? 4 : 0) | (last == n - 1 ? 8 : 0));
        picture_.facets.push_back(piece);
      }
      if (start_.labels == EntityKind::hex) label(hex_id(mesh_, h), middle);
      if (start_.labels == EntityKind::volume) label(selector_.meshed.association.hex_volume[h], middle);
    }
  }

  /// The true surfaces, and the curves on them; light is in their colours, since they are smooth.
  void cad() {
    const Model* model = selector_.meshed.model.get();
    if (!model) throw Error("there is no CAD to draw");
    const bool by_surface = same_word(start_.colour, "surface"), by_volume = same_word(start_.colour, "volume");
    if (!start_.colour.empty() && !by_surface && !by_volume && !same_word(start_.colour, "none"))
      throw Error("surfaces of the CAD have colours by surface or volume, not by '" + printable(start_.colour) + "'");
    const bool some = start_.has_range && dimension(start_.kind) >= 2 && start_.kind != EntityKind::face;
    const std::vector<Index> positions =
        some ? related(selector_, start_.kind, start_.positions, EntityKind::surface) : std::vector<Index>();
    std::map<int, int> rows;
    for (int id = 1; id <= model->count(2); ++id) {
      if (some && !std::ranges::binary_search(positions, id - 1)) continue;
      const CadSurface surface = cad_surface(*model, id);
      int owner = id;
      if (by_volume) {
        const std::vector<int> volumes = model->adjacent({2, id}, 3);
        owner = volumes.empty() ? 0 : volumes.front();
      }
      if ((by_surface || by_volume) && owner > 0 && !rows.contains(owner))
        rows[owner] = add_row(row_text(by_surface ? EntityKind::surface : EntityKind::volume, owner,
                                       model->name({by_surface ? 2 : 3, owner})),
                              row_colour(static_cast<std::size_t>(owner - 1)));
      const Colour colour = rows.contains(owner) ? picture_.legend[rows[owner]].colour : cad_colour;
      const auto first = static_cast<std::int32_t>(picture_.points.size());
      picture_.points.insert(picture_.points.end(), surface.points.begin(), surface.points.end());
      for (const auto& [a, b, c] : surface.triangles) {
        Picture::Facet facet{
            .corners = {first + a, first + b, first + c, first + c}, .colours = {}, .edges = 0, .is_lit = false};
        const std::array<std::int32_t, 4> corners = {a, b, c, c};
        for (int i = 0; i < 4; ++i) facet.colours[i] = shaded(colour, shade_of(surface.normals[corners[i]], axes_));
        picture_.facets.push_back(facet);
        const Vec3 middle = (surface.points[a] + surface.points[b] + surface.points[c]) / 3;
        if (start_.labels == EntityKind::surface) label(id, middle);
        if (start_.labels == EntityKind::volume)
          for (const int volume : model->adjacent({2, id}, 3)) label(volume, middle);
      }
    }
    for (int id = 1; id <= model->count(1); ++id) {
      const std::vector<Vec3> points = cad_curve(*model, id);
      for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        picture_.lines.push_back({points[i], points[i + 1], curve_colour, 2.2F, false});
        if (start_.labels == EntityKind::curve) label(id, (points[i] + points[i + 1]) / 2);
      }
    }
    for (int id = 1; id <= model->count(0) && start_.labels == EntityKind::vertex; ++id)
      label(id, model->point({0, id}, {}));
  }

  /// Edges and nodes, curves and vertices stand out red.
  void highlight() {
    const int dim = start_.has_range ? dimension(start_.kind) : -1;
    const auto dot = [&](const Vec3& p) { picture_.lines.push_back({p, p, chosen_colour, 9, true}); };
    const auto line = [&](const Vec3& a, const Vec3& b) { picture_.lines.push_back({a, b, chosen_colour, 5, true}); };
    const Model* model = selector_.meshed.model.get();
    if (start_.kind == EntityKind::sheet || dim < 0 || dim > 1) return;
    if (mesh_.n_hexes() == 0 || start_.shows_cad) {
      for (const Index i : start_.positions) {
        if (start_.kind == EntityKind::vertex) dot(model->point({0, static_cast<int>(i) + 1}, {}));
        if (start_.kind != EntityKind::curve) continue;
        const std::vector<Vec3> points = cad_curve(*model, static_cast<int>(i) + 1);
        for (std::size_t k = 0; k + 1 < points.size(); ++k) line(points[k], points[k + 1]);
      }
    } else if (dim == 1) {
      for (const Index e : related(selector_, start_.kind, start_.positions, EntityKind::edge)) {
        const auto [a, b] = selector_.topology.edges().nodes[e];
        line(mesh_.points[a], mesh_.points[b]);
      }
    } else {
      for (const Index n : related(selector_, start_.kind, start_.positions, EntityKind::node)) dot(mesh_.points[n]);
    }
  }

  // Labels.

  void label(std::int64_t id, const Vec3& place) {
    if (id > 0) label_places_[id].push_back(place);
  }
  bool is_beyond(const Vec3& p) const {
    return start_.cut && !start_.cut->whole && start_.cut->normal.dot(p) > start_.cut->distance;
  }

  void mesh_labels() {
    if (!start_.labels) return;
    const EntityKind kind = *start_.labels;
    const MeshedModel& meshed = selector_.meshed;
    std::map<Index, int> surface_of;
    if (kind == EntityKind::surface)
      for (std::size_t i = 0; i < meshed.association.surface_faces.size(); ++i)
        surface_of[face_of(meshed.association.surface_faces[i])] = meshed.association.face_surface[i];
    if (kind == EntityKind::vertex && meshed.model)
      for (int id = 1; id <= meshed.model->count(0); ++id) place(id, meshed.model->point({0, id}, {}));
    if (kind == EntityKind::curve)
      for (std::size_t i = 0; i < meshed.association.curve_edges.size(); ++i) {
        const auto [a, b] = meshed.association.curve_edges[i];
        place(meshed.association.edge_curve[i], (mesh_.points[a] + mesh_.points[b]) / 2);
      }
    std::vector<char> is_seen(kind == EntityKind::node ? mesh_.points.size() : 0, 0);
    std::vector<char> has_edge(kind == EntityKind::edge ? selector_.topology.edges().nodes.size() : 0, 0);
    for (const Drawn& each : drawn_) {
      const Side side = selector_.topology.faces().sides[each.face][0];
      const auto nodes = face_node_cycle(mesh_.hexes[side.hex], side.face);
      Vec3 middle = Vec3::Zero();
      for (const Index n : nodes) middle += mesh_.points[n] / 4;
      switch (kind) {
        case EntityKind::hex:
          place(hex_id(mesh_, each.hex), middle);
          break;
        case EntityKind::face:
          place(each.face + 1, middle);
          break;
        case EntityKind::volume:
          place(meshed.association.hex_volume[each.hex], middle);
          break;
        case EntityKind::surface:
          if (const auto found = surface_of.find(each.face); found != surface_of.end()) place(found->second, middle);
          break;
        case EntityKind::node:
          for (const Index n : nodes)
            if (!std::exchange(is_seen[n], 1)) place(node_id(mesh_, n), mesh_.points[n]);
          break;
        case EntityKind::edge:
          for (int j = 0; j < 4; ++j) {
            const Index e = selector_.topology.edges().of_hex[side.hex][face_edge(side.face, j)];
            if (!std::exchange(has_edge[e], 1)) {
              const auto [a, b] = selector_.topology.edges().nodes[e];
              place(e + 1, (mesh_.points[a] + mesh_.points[b]) / 2);
            }
          }
          break;
        default:
          break;
      }
    }
  }
  void place(std::int64_t id, const Vec3& p) {
    if (!is_beyond(p)) label(id, p);
  }

  /// Of each id places near the middle of it first, then others all over it.
  void order_labels() {
    std::vector<std::int64_t> wanted;
    const bool some = start_.has_range && start_.kind == start_.labels;
    if (some)
      for (const Index position : start_.positions) wanted.push_back(id_of(selector_, start_.kind, position));
    sort_unique(wanted);
    for (auto& [id, places] : label_places_) {
      if (some && !std::ranges::binary_search(wanted, id)) continue;
      Vec3 middle = Vec3::Zero();
      for (const Vec3& p : places) middle += p / static_cast<double>(places.size());
      std::ranges::stable_sort(places, {}, [&](const Vec3& p) { return (p - middle).squaredNorm(); });
      const double step = std::max(1.0, static_cast<double>(places.size()) / most_places);
      std::vector<Vec3> chosen;
      for (double i = 0; i < static_cast<double>(places.size()) && chosen.size() < most_places; i += step)
        chosen.push_back(places[static_cast<std::size_t>(i)]);
      picture_.labels.push_back({std::to_string(id), std::move(chosen)});
    }
  }
};

}  // namespace

Picture paint(const SceneSource& source, const SceneStart& start) {
  return Painter(source, start).paint();
}

}  // namespace hextwist
