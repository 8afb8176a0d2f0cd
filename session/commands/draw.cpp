// draw: the mesh as a picture in a file.

#include <algorithm>
#include <filesystem>
#include <limits>

#include "hextwist/base/sorted.h"
#include "hextwist/command/reader.h"
#include "hextwist/io/file.h"
#include "hextwist/mesh/corners.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/session/commands/commands.h"
#include "hextwist/session/view/page.h"
#include "hextwist/session/view/picture.h"

namespace hextwist {
namespace {

constexpr Colour curve_colour = {50, 50, 60}, chosen_colour = {200, 30, 30}, plain_colour = {225, 228, 232};
constexpr std::size_t max_legend_rows = 20, most_drawn = 20000;

Vec3 view_of(const Command& command) {
  if (!command.has("from")) return {1, -1, 0.7};
  const Vec3 view = {command.find("x")->number, command.find("y")->number, command.find("z")->number};
  if (!(view.norm() > 0))
    throw error_at(command.statement, command.find("x")->token, "this is not a direction to look from");
  return view;
}

class Painter {
 public:
  explicit Painter(const Execution& run) : run_(run), selector_(run.core.selector()), mesh_(selector_.meshed.mesh) {
    local_.assign(mesh_.points.size(), -1);
    row_.assign(mesh_.hexes.size(), -1);
  }

  Picture paint() {
    const Command& command = run_.command;
    const Item* range = command.find("range");
    const EntityKind kind = range ? range->kind : EntityKind::hex;
    const std::vector<Index> positions = range ? run_.chosen(*range) : std::vector<Index>();
    const int dim = range ? dimension(kind) : 3;
    // Of points and lines the whole mesh is the background.
    std::vector<char> chosen(mesh_.hexes.size(), !range || dim == 0 || dim == 1);
    if (kind == EntityKind::sheet) hexes_of_sheets(positions, chosen);
    if (range && (dim == 3 || dim < 0))
      for (const Index h : related(selector_, kind, positions, EntityKind::hex)) chosen[h] = 1;
    const bool plain = range && dim < 2 && dim >= 0 && kind != EntityKind::sheet;
    if (plain)
      plain_ = true;
    else
      colours(kind, positions, dim);
    if (dim == 2)
      faces(related(selector_, kind, positions, EntityKind::face));
    else
      skin(chosen);
    curves();
    if (plain) highlight(kind, positions, dim);
    picture_.view = view_of(run_.command);
    picture_.title = text_of(command.statement);
    return std::move(picture_);
  }

 private:
  const Execution& run_;
  const Selector selector_;
  const Mesh& mesh_;
  Picture picture_;
  std::vector<std::int32_t> local_;  // per node: its place in the picture
  std::vector<int> row_;             // per hex: row of the legend
  std::vector<double> values_;       // per hex, where quality gives the colours
  bool plain_ = false;

  void hexes_of_sheets(const std::vector<Index>& positions, std::vector<char>& chosen) {
    std::ranges::fill(chosen, 0);
    for (const Index sheet : positions)
      for (const Index h : selector_.topology.sheets().hexes[sheet]) chosen[h] = 1;
  }

  void row(const std::string& text, std::span<const Index> hexes) {
    const int i = static_cast<int>(picture_.legend.size());
    picture_.legend.push_back({row_colour(picture_.legend.size()), text});
    for (const Index h : hexes)
      if (row_[h] < 0) row_[h] = i;
  }

  /// What tells hexes apart: quality where it was asked for, else sheets, blocks, volumes.
  void colours(EntityKind kind, const std::vector<Index>& positions, int dim) {
    if (run_.command.has("quality")) return;  // when the hexes are known
    if (kind == EntityKind::sheet) {
      for (const Index sheet : positions)
        row("sheet " + std::to_string(sheet + 1), selector_.topology.sheets().hexes[sheet]);
    } else if (kind == EntityKind::sideset || kind == EntityKind::surface || dim == 2 || mesh_.blocks.size() > 1) {
      for (const Block& block : mesh_.blocks)
        row("block " + std::to_string(block.id) + (block.name.empty() ? "" : " '" + printable(block.name) + "'"),
            block.hexes);
    } else {
      const Association& association = selector_.meshed.association;
      const int n = selector_.meshed.model ? selector_.meshed.model->count(3) : 0;
      for (int volume = 1; volume <= n && n > 1; ++volume) {
        std::vector<Index> hexes;
        for (Index h = 0; h < mesh_.n_hexes(); ++h)
          if (association.hex_volume.at(h) == volume) hexes.push_back(h);
        row("volume " + std::to_string(volume), hexes);
      }
    }
  }

  void facet(Index hex, int face) {
    Picture::Facet facet;
    const auto cycle = face_node_cycle(mesh_.hexes[hex], face);
    for (int i = 0; i < 4; ++i) {
      std::int32_t& local = local_[cycle[i]];
      if (local < 0) {
        local = static_cast<std::int32_t>(picture_.points.size());
        picture_.points.push_back(mesh_.points[cycle[i]]);
      }
      facet.corners[i] = local;
    }
    facet.hex = hex_id(mesh_, hex);
    facet.colour = plain_           ? plain_colour
                   : row_[hex] >= 0 ? picture_.legend[row_[hex]].colour
                                    : row_colour(picture_.legend.empty() ? 0 : picture_.legend.size());
    drawn_.push_back(hex);
    picture_.facets.push_back(facet);
  }

  std::vector<Index> drawn_;  // per facet: its hex

  void skin(const std::vector<char>& chosen) {
    std::vector<Index> hexes;
    for (const auto& sides : selector_.topology.faces().sides) {
      const bool first = chosen[sides[0].hex], second = sides[1].hex >= 0 && chosen[sides[1].hex];
      if (first == second) continue;
      const Side side = sides[first ? 0 : 1];
      facet(side.hex, side.face);
    }
    for (Index h = 0; h < mesh_.n_hexes(); ++h)
      if (chosen[h]) hexes.push_back(h);
    by_quality(hexes);
  }

  void faces(const std::vector<Index>& which) {
    for (const Index f : which) {
      const Side side = selector_.topology.faces().sides[f][0];
      facet(side.hex, side.face);
    }
    std::vector<Index> hexes = drawn_;
    sort_unique(hexes);
    by_quality(hexes);
  }

  void by_quality(const std::vector<Index>& hexes) {
    if (!run_.command.has("quality") || hexes.empty() || plain_) return;
    const Metric metric = metrics_said(run_.command, "quality").front();
    const std::vector<double> all = quality(metric, mesh_, hexes);
    std::vector<double> of_hex(mesh_.hexes.size(), 0);
    for (std::size_t i = 0; i < hexes.size(); ++i) of_hex[hexes[i]] = all[i];
    picture_.metric = name(metric);
    picture_.small_is_better = small_is_better(metric);
    const auto [low, high] = std::ranges::minmax(all);
    const double best = ideal(metric);
    // Good is the ideal where there is one, and bad is 0 for the metrics between 0 and 1.
    picture_.low = picture_.small_is_better ? best : std::isfinite(best) ? std::min(0.0, low) : low;
    picture_.high = picture_.small_is_better ? std::max(high, best + 1e-12) : std::isfinite(best) ? best : high;
    if (!(picture_.high > picture_.low)) picture_.high = picture_.low + 1;
    for (std::size_t i = 0; i < picture_.facets.size(); ++i) {
      const double value = of_hex[drawn_[i]];
      const double t = (value - picture_.low) / (picture_.high - picture_.low);
      picture_.facets[i].value = value;
      picture_.facets[i].colour = scale_colour(picture_.small_is_better ? 1 - t : t);
    }
    run_.say(std::string(name(metric)) + ": from " + short_number(low) + " to " + short_number(high));
  }

  /// The curves of the model, for orientation.
  void curves() {
    for (const auto& [a, b] : selector_.meshed.association.curve_edges)
      picture_.lines.push_back({mesh_.points[a], mesh_.points[b], curve_colour, 2.2F, false});
  }

  void highlight(EntityKind kind, const std::vector<Index>& positions, int dim) {
    if (dim == 1)
      for (const Index e : related(selector_, kind, positions, EntityKind::edge)) {
        const auto [a, b] = selector_.topology.edges().nodes[e];
        picture_.lines.push_back({mesh_.points[a], mesh_.points[b], chosen_colour, 5, true});
      }
    else
      for (const Index n : related(selector_, kind, positions, EntityKind::node))
        picture_.lines.push_back({mesh_.points[n], mesh_.points[n], chosen_colour, 9, true});
  }
};

void draw_picture(Execution& run, io::Output& out) {
  const Command& command = run.command;
  const Picture picture = Painter(run).paint();
  const Item* width = command.find("width");
  const int w = width ? static_cast<int>(width->number) : 1200;
  const int h = width ? static_cast<int>(command.find("height")->number) : 900;
  const std::string& file = command.find("file")->text;
  const std::string extension = lower_extension(file);
  if (extension == ".svg") {
    if (picture.facets.size() > most_drawn)
      throw Error("a drawing of " + counted(static_cast<std::int64_t>(picture.facets.size()), EntityKind::face) +
                  " is too large for .svg, which takes " + std::to_string(most_drawn) + ": write a .png");
    out << svg(picture, w, h);
  } else if (extension == ".gif") {
    std::string before;
    if (command.has("append") && std::filesystem::exists(file)) {
      const io::Bytes bytes = io::read_bytes(file);
      before.assign(bytes.data.get(), bytes.size);
    }
    out << gif(before, render(picture, w, h), w, h);
  } else {
    out << png(render(picture, w, h), w, h);
  }
  for (std::size_t i = 0; i < std::min(picture.legend.size(), max_legend_rows) && picture.metric.empty(); ++i)
    run.say("  " + picture.legend[i].text + ": " + row_colour_name(i));
  run.say(command.find("file")->text + ": " +
          counted(static_cast<std::int64_t>(picture.facets.size()), EntityKind::face) + " drawn");
}

/// The page always has the whole mesh; what the command is about is picked there, and hexes are shown alone.
void draw_page(Execution& run, io::Output& out) {
  const Command& command = run.command;
  const std::string& file = command.find("file")->text;
  SceneStart start{.view = view_of(command)};
  if (const Item* range = command.find("range")) {
    start.has_range = true;
    start.kind = range->kind;
    start.positions = run.chosen(*range);
  }
  if (command.has("quality")) start.colour = name(metrics_said(command, "quality").front());
  const Page made = page({run.core.selector(), run.state, std::filesystem::path(file).stem().string()}, start, nullptr);
  out << made.text;
  for (const std::string& name : made.left_out)
    run.note(name + " is left out of " + file + ", which would be too large");
  run.say(file + ": " + counted(run.meshed->mesh.n_hexes(), EntityKind::hex));
}

}  // namespace

void do_draw(Execution& run) {
  const Command& command = run.command;
  need_mesh(run, "to draw");
  const Item& file = *command.find("file");
  const std::string extension = lower_extension(file.text);
  const bool is_page = extension == ".html" || extension == ".htm";
  if (!is_page && extension != ".png" && extension != ".svg" && extension != ".gif")
    throw error_at(command.statement, file.token,
                   "pictures end in .png, .svg, .gif or .html, not in '" + printable(extension) + "'");
  check_file(run, file, ".png .svg .gif .html .htm");
  if (command.has("append") && extension != ".gif")
    throw error_at(command.statement, file.token, "only a .gif takes further pictures");
  if (is_page) page_text();  // better said before the work
  run.stage("draw");
  io::Output out(file.text, command.has("overwrite") || command.has("append"));
  if (is_page)
    draw_page(run, out);
  else
    draw_picture(run, out);
  out.commit();
}

}  // namespace hextwist
