// What a scene says of itself in words.
#include <algorithm>
#include <cmath>

#include "hextwist/base/text.h"
#include "hextwist/session/view/scene.h"

namespace hextwist {
namespace {

/// Measuring takes time, and nobody reads a list that long.
constexpr int most_measured = 20000;

std::string list(const std::vector<std::string>& items) {
  return "[" + joined(items, ",") + "]";
}

std::string point(const Vec3& p) {
  return list({json_number(p.x()), json_number(p.y()), json_number(p.z())});
}

/// Per id: name, type, length or area or volume.
std::string entities(const Model& model, int dim) {
  std::vector<std::string> rows;
  for (int id = 1; id <= model.count(dim); ++id) {
    const Owner owner{dim, id};
    const double measure = dim > 0 && model.count(dim) <= most_measured ? model.measure(owner) : NAN;
    rows.push_back(list({json_text(model.name(owner)), json_text(model.type(owner)), json_number(measure)}));
  }
  return list(rows);
}

std::string group_row(int id, const std::string& name, std::size_t n) {
  return list({std::to_string(id), json_text(name), std::to_string(n)});
}

std::string channel_row(const SceneSource& source, const Channel& channel, bool is_there) {
  std::vector<std::string> classes;
  for (const auto& [number, text] : channel.classes) classes.push_back(list({std::to_string(number), json_text(text)}));
  std::string row = "{\"name\":" + json_text(channel.name) + ",\"group\":" + json_text(channel.group) +
                    ",\"on\":" + (channel.on_nodes ? "\"node\"" : "\"hex\"") +
                    ",\"is_class\":" + (channel.is_class ? "true" : "false") +
                    ",\"there\":" + (is_there ? "true" : "false") + ",\"classes\":" + list(classes);
  if (channel.what == Channel::What::metric)
    row += std::string(",\"small_is_better\":") + (small_is_better(channel.metric) ? "true" : "false") +
           ",\"ideal\":" + json_number(ideal(channel.metric));
  if (channel.what == Channel::What::field &&
      source.selector.meshed.mesh.fields[static_cast<std::size_t>(channel.field)].integer)
    row += ",\"integer\":true";
  return row + "}";
}

}  // namespace

std::string scene_meta(const SceneSource& source, const std::vector<Channel>& channels, const SceneStart& start,
                       const std::vector<std::string>& left_out) {
  const MeshedModel& meshed = source.selector.meshed;
  const Mesh& mesh = meshed.mesh;
  const Box all = scene_box(source);
  const auto is_there = [&](const std::string& name) { return std::ranges::find(left_out, name) == left_out.end(); };
  std::string text = "{\"title\":" + json_text(source.title);
  text += ",\"n_nodes\":" + std::to_string(mesh.n_nodes()) + ",\"n_hexes\":" + std::to_string(mesh.n_hexes());
  // Without a mesh: what the surfaces bound.
  if (mesh.n_hexes() == 0 && meshed.model) {
    std::vector<std::string> volumes;
    for (int id = 1; id <= meshed.model->count(2); ++id) {
      std::vector<std::string> of_one;
      for (const int volume : meshed.model->adjacent({2, id}, 3)) of_one.push_back(std::to_string(volume));
      volumes.push_back(list(of_one));
    }
    text += ",\"volumes_of_surface\":" + list(volumes);
  }
  text += std::string(",\"has_cad\":") + (source.state.has_cad ? "true" : "false") +
          ",\"has_before\":" + (source.before ? "true" : "false");
  text += ",\"origin\":" + point(scene_origin(source)) + ",\"size\":" + json_number(all.diagonal());
  constexpr const char* names[] = {"vertex", "curve", "surface", "volume"};
  for (int dim = 0; dim < 4; ++dim)
    text += std::string(",\"") + names[dim] + "\":" + (meshed.model ? entities(*meshed.model, dim) : "[]");
  std::vector<std::string> blocks, node_sets, side_sets, groups;
  for (const Block& each : mesh.blocks) blocks.push_back(group_row(each.id, each.name, each.hexes.size()));
  for (const NodeSet& each : mesh.node_sets) node_sets.push_back(group_row(each.id, each.name, each.nodes.size()));
  for (const SideSet& each : mesh.side_sets) side_sets.push_back(group_row(each.id, each.name, each.sides.size()));
  for (const Group& each : source.selector.groups) {
    std::size_t n = 0;
    for (const auto& of_kind : each.members) n += of_kind.size();
    groups.push_back(group_row(each.id, each.name, n));
  }
  text += ",\"block\":" + list(blocks) + ",\"nodeset\":" + list(node_sets) + ",\"sideset\":" + list(side_sets) +
          ",\"group\":" + list(groups);
  std::vector<std::string> rows, missing;
  for (const Channel& channel : channels) rows.push_back(channel_row(source, channel, is_there(channel.name)));
  for (const std::string& name : left_out) missing.push_back(json_text(name));
  text += ",\"channels\":" + list(rows) + ",\"left_out\":" + list(missing);

  std::vector<std::string> ids;
  for (const Index position : start.positions)
    ids.push_back(std::to_string(id_of(source.selector, start.kind, position)));
  text += ",\"start\":{\"view\":" + point(start.view) + ",\"colour\":" + json_text(start.colour) +
          ",\"what\":" + (start.shows_cad ? "\"cad\"" : "\"mesh\"");
  if (start.cut)
    text += std::string(",\"cut\":{\"mode\":") + (start.cut->whole ? "\"crinkle\"" : "\"plane\"") +
            ",\"normal\":" + point(start.cut->normal) +
            ",\"distance\":" + json_number(start.cut->distance - start.cut->normal.dot(scene_origin(source))) + "}";
  if (start.labels) text += ",\"labels\":" + json_text(name(*start.labels));
  if (start.has_range) text += ",\"kind\":" + json_text(name(start.kind)) + ",\"ids\":" + list(ids);
  return text + "}}";
}

}  // namespace hextwist
