// draw: the mesh as a picture in a file.

#include <algorithm>
#include <filesystem>

#include "hextwist/base/text.h"
#include "hextwist/command/reader.h"
#include "hextwist/io/file.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/session/commands/commands.h"
#include "hextwist/session/view/before.h"
#include "hextwist/session/view/page.h"
#include "hextwist/session/view/paint.h"
#include "hextwist/session/view/render_internal.h"
#include "hextwist/session/view/text.h"

namespace hextwist {
namespace {

constexpr std::size_t most_drawn = 20000;
constexpr Index most_before = 200000;  // hexes: with more a page would be twice as large for them

Vec3 view_of(const Command& command) {
  if (!command.has("from")) return {1, -1, 0.7};
  const Vec3 view = {command.find("x")->number, command.find("y")->number, command.find("z")->number};
  if (!(view.norm() > 0))
    throw error_at(command.statement, command.find("x")->token, "this is not a direction to look from");
  return view;
}

/// ": blue", where it is a colour with a name.
std::string colour_note(const Colour& colour) {
  constexpr std::size_t n_named = 10;
  for (std::size_t i = 0; i < n_named; ++i)
    if (row_colour(i) == colour) return std::string(": ") + row_colour_name(i);
  return "";
}

/// What is before the plane, as seen by the eye, is taken away.
SceneCut cut_of(const Command& command, const SceneSource& source, const Vec3& view) {
  SceneCut cut;
  if (const Item* x = command.find("nx")) {
    cut.normal = {x->number, command.find("ny")->number, command.find("nz")->number};
    if (!(cut.normal.norm() > 0)) throw error_at(command.statement, x->token, "this is not the normal of a plane");
    cut.normal.normalize();
  } else {
    for (const Item& item : command.items)
      if (item.is_word && item.option == "clip" && item.name.size() == 1)
        cut.normal = Vec3::Unit(item.name.front() - 'x');
  }
  const Item* position = command.find("position");
  const Box all = scene_box(source);
  cut.distance = position ? position->number : cut.normal.dot((all.min + all.max) / 2);
  cut.whole = command.has("crinkle");
  if (cut.normal.dot(view) < 0) {
    cut.normal = -cut.normal;
    cut.distance = -cut.distance;
  }
  return cut;
}

SceneStart start_of(const Execution& run, const SceneSource& source) {
  const Command& command = run.command;
  SceneStart start{.shows_cad = command.has("geometry") || run.meshed->mesh.n_hexes() == 0, .view = view_of(command)};
  if (const Item* range = command.find("range")) {
    start.has_range = true;
    start.kind = range->kind;
    start.positions = run.chosen(*range);
  }
  // What it is called may be an item of any sort.
  const auto colour = std::ranges::find_if(command.items, [](const Item& item) {
    return item.option == "color" && item.name != "color" && item.name != "colour";
  });
  const bool has_colour = colour != command.items.end();
  const auto quality = std::ranges::find(command.items, "quality", &Item::name);
  if (has_colour && quality != command.items.end())
    throw error_at(command.statement, quality->token, "'quality' gives the colours as well: say one of them");
  if (quality != command.items.end()) start.colour = channel_name(metrics_said(command, "quality").front());
  if (has_colour) {
    const std::vector<std::string> all = scene_colours(source);
    const std::string& called = colour->is_word ? colour->name : colour->text;
    const auto found = std::ranges::find_if(all, [&](const std::string& each) { return same_word(each, called); });
    if (found == all.end())
      throw error_at(command.statement, colour->token,
                     "nothing here is called '" + printable(called) + "' that could give the colours: there are " +
                         joined(all, ", "));
    start.colour = *found;
  }
  for (const Item& item : command.items) {
    if (item.option == "clip" && item.name == "clip") start.cut = cut_of(command, source, start.view);
    if (item.option == "label" && item.name != "label") start.labels = entity_kind(item.name);
  }
  return start;
}

void draw_picture(Execution& run, io::Output& out, const SceneSource& source, const SceneStart& start) {
  const Command& command = run.command;
  Picture picture = paint(source, start);
  picture.source = text_of(command.statement);
  if (const Item* title = command.find("title")) picture.caption = title->text;
  const Item* width = command.find("width");
  const int w = width ? static_cast<int>(width->number) : 1200;
  const int h = width ? static_cast<int>(command.find("height")->number) : 900;
  if (!picture.scale.name.empty())
    run.say(picture.scale.name + ": from " + short_number(picture.scale.least) + " to " +
            short_number(picture.scale.most));
  for (std::size_t i = 0; i < std::min(picture.legend.size(), most_legend_rows); ++i)
    run.say("  " + picture.legend[i].text + colour_note(picture.legend[i].colour));
  const bool has_legend = !command.has("off");
  if (!has_legend) {
    picture.legend.clear();
    picture.scale.name.clear();
  }
  const std::string& file = command.find("file")->text;
  const std::string extension = lower_extension(file);
  const bool writes =
      !picture.caption.empty() || !picture.labels.empty() || !picture.legend.empty() || !picture.scale.name.empty();
  if (extension != ".svg" && writes && !has_text())
    run.note(
        "without text: this program was built without FreeType or a font (Debian: libfreetype-dev fonts-dejavu-core)");
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
  out.commit();
  run.say(file + ": " +
          (start.shows_cad ? counted(run.meshed->model->count(2), EntityKind::surface)
                           : counted(static_cast<std::int64_t>(picture.facets.size()), EntityKind::face)) +
          " drawn");
}

/// The page always has the whole mesh; what the command is about is picked there, and hexes are shown alone.
void draw_page(Execution& run, io::Output& out, SceneSource source, const SceneStart& start,
               const std::unique_ptr<MeshBefore>& before) {
  const std::string& file = run.command.find("file")->text;
  source.title =
      run.command.find("title") ? run.command.find("title")->text : std::filesystem::path(file).stem().string();
  std::optional<SceneSource> other;
  if (source.before && source.before().n_hexes() <= most_before) other.emplace(before->source(source.title));
  const Page made = page(source, start, other ? &*other : nullptr);
  out << made.text;
  for (const std::string& name : made.left_out)
    run.note(name + " is left out of " + file + ", which would be too large");
  const bool has_mesh = run.meshed->mesh.n_hexes() > 0;
  out.commit();
  run.say(file + ": " +
          (has_mesh ? counted(run.meshed->mesh.n_hexes(), EntityKind::hex)
                    : counted(run.meshed->model->count(2), EntityKind::surface)));
}

}  // namespace

void do_draw(Execution& run) {
  const Command& command = run.command;
  if (!run.meshed->model) need_mesh(run, "to draw");
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
  std::unique_ptr<MeshBefore> before;
  SceneSource source{run.core.selector(), run.state, {}};
  if (has_mesh_before(run.core))
    source.before = [&]() -> const Mesh& {
      if (!before) before = mesh_before(run.core);
      return before->mesh();
    };
  const SceneStart start = start_of(run, source);
  io::Output out(file.text, command.has("overwrite") || command.has("append"));
  if (is_page)
    draw_page(run, out, source, start, before);
  else
    draw_picture(run, out, source, start);
}

}  // namespace hextwist
