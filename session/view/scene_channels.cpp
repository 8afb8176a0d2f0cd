// Values that can give the colours of a scene.
#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

#include "hextwist/base/parallel.h"
#include "hextwist/base/text.h"
#include "hextwist/refine/templates/trisect.h"
#include "hextwist/session/view/scene.h"
#include "hextwist/sizing/levelling.h"
#include "hextwist/sizing/size_report.h"

namespace hextwist {
namespace {

/// Of meshes with more hexes values are rounded to four digits: pages would be twice as large.
constexpr Index most_exact = 300000;

const SizeField* last_wish(const SessionState& state) {
  const auto found = state.sizing.find(state.last_sizing);
  return found == state.sizing.end() ? nullptr : found->second.field.get();
}

/// What each hex is a piece of, null where that is not known. After a first pass it is made for this.
std::shared_ptr<const HandedHexes> pieces_of(const SceneSource& source) {
  const Levelling* levelling = source.state.levelling.get();
  if (!levelling || levelling->forest.is_bare()) return nullptr;
  const Forest forest = levelling->forest.grown ? levelling->forest : grown(levelling->forest);
  if (forest.grown->hexes.n_hexes() != source.selector.meshed.mesh.n_hexes()) return nullptr;
  return {forest.grown, &forest.grown->hexes};
}

std::vector<std::uint32_t> levels(const HandedHexes& hexes) {
  std::vector<std::uint32_t> result(static_cast<std::size_t>(hexes.n_hexes()), 0);
  for (std::size_t piece = 0; piece < hexes.origin.size(); ++piece)
    result[static_cast<std::size_t>(hexes.n_whole()) + piece] =
        static_cast<std::uint32_t>(hexes.leaf_of_piece(piece).level);
  return result;
}

/// What became of the hex that this one is a piece of: twice the number of pieces, odd where it is concave.
std::vector<std::uint32_t> cuts(const HandedHexes& hexes) {
  const auto table = trisect_table();
  std::vector<std::uint32_t> result(static_cast<std::size_t>(hexes.n_hexes()), 0);
  for (std::size_t piece = 0; piece < hexes.origin.size(); ++piece) {
    const int code = static_cast<int>(hexes.origin[piece] >> 16 & (n_trisect_codes - 1));
    result[static_cast<std::size_t>(hexes.n_whole()) + piece] =
        2 * static_cast<std::uint32_t>(table->hex(code).children.size()) + (is_convex(code) ? 0 : 1);
  }
  return result;
}

/// The same for hexes with the same corners, wherever these stand in the arrays.
std::uint64_t key_of_corners(const Mesh& mesh, const Hex& hex) {
  const auto mixed = [](std::uint64_t v) {
    v ^= v >> 33;
    v *= 0xff51afd7ed558ccdULL;
    v ^= v >> 33;
    v *= 0xc4ceb9fe1a85ec53ULL;
    return v ^ v >> 33;
  };
  std::uint64_t sum = 0;
  for (const Index node : hex) {
    std::uint64_t of_node = 0;
    for (const double x : mesh.points[static_cast<std::size_t>(node)])
      of_node = mixed(of_node + std::bit_cast<std::uint64_t>(x + 0.0));
    sum += of_node;
  }
  return sum;
}

/// Hexes that are not in the mesh before, or had corners elsewhere there.
std::vector<std::uint32_t> changes(const Mesh& mesh, const Mesh& before) {
  std::vector<std::uint64_t> known(before.hexes.size());
  parallel_each(known.size(), [&](std::size_t h) { known[h] = key_of_corners(before, before.hexes[h]); });
  std::ranges::sort(known);
  std::vector<std::uint32_t> result(mesh.hexes.size());
  parallel_each(result.size(), [&](std::size_t h) {
    result[h] = std::ranges::binary_search(known, key_of_corners(mesh, mesh.hexes[h])) ? 0 : 1;
  });
  return result;
}

/// Levels that came with a file, as 'refine ... graded' writes them.
bool is_level_field(const Field& field) {
  constexpr double highest = 60;
  return field.name == "level" && field.on == Field::On::hex && field.components == 1 &&
         std::ranges::all_of(field.values, [&](double v) { return v >= 0 && v <= highest && v == std::floor(v); });
}

void add_field(std::vector<Channel>& to, const Field& field, Index position) {
  const bool is_taken = std::ranges::any_of(to, [&](const Channel& each) { return each.name == field.name; });
  const std::string name = field.name + (is_taken ? " (field)" : "");
  Channel channel{.what = Channel::What::field,
                  .name = name,
                  .group = "fields",
                  .on_nodes = field.on == Field::On::node,
                  .field = position};
  if (field.components == 1) {
    to.push_back(channel);
    return;
  }
  channel.component = field.components;
  channel.name = name + " magnitude";
  to.push_back(channel);
  for (int c = 0; c < field.components; ++c) {
    channel.component = c;
    channel.name = name + (field.components == 3 ? std::string(" ") + "xyz"[c] : " " + std::to_string(c + 1));
    to.push_back(channel);
  }
}

}  // namespace

std::vector<std::uint32_t> classes_of(const SceneSource& source, const Channel& channel) {
  const MeshedModel& meshed = source.selector.meshed;
  const auto n = static_cast<std::size_t>(meshed.mesh.n_hexes());
  std::vector<std::uint32_t> result(n, 0);
  switch (channel.what) {
    case Channel::What::volume:
      for (std::size_t h = 0; h < std::min(n, meshed.association.hex_volume.size()); ++h)
        result[h] = static_cast<std::uint32_t>(meshed.association.hex_volume[h]);
      break;
    case Channel::What::block:
      // The first block that a hex is in, as files that know one have it; those of none have a number of their own.
      std::ranges::fill(result, static_cast<std::uint32_t>(channel.classes.back().first));
      for (auto block = meshed.mesh.blocks.rbegin(); block != meshed.mesh.blocks.rend(); ++block)
        for (const Index h : block->hexes) result[h] = static_cast<std::uint32_t>(block->id);
      break;
    case Channel::What::level:
      if (channel.pieces) return levels(*channel.pieces);
      for (std::size_t h = 0; h < n; ++h)
        result[h] = static_cast<std::uint32_t>(meshed.mesh.fields[static_cast<std::size_t>(channel.field)].values[h]);
      break;
    case Channel::What::changed:
      return changes(meshed.mesh, source.before());
    default:
      result = cuts(*channel.pieces);
  }
  return result;
}

std::vector<double> values_of(const SceneSource& source, const Channel& channel) {
  const Mesh& mesh = source.selector.meshed.mesh;
  if (channel.what == Channel::What::metric) return quality(channel.metric, mesh);
  if (channel.what == Channel::What::size) {
    std::vector<Index> hexes = indices_where(mesh.n_hexes(), [](Index) { return true; });
    std::vector<double> ratio = actual_sizes(mesh, hexes);
    const std::vector<double> wished = wished_sizes(mesh, hexes, *last_wish(source.state));
    for (std::size_t i = 0; i < ratio.size(); ++i) ratio[i] /= wished[i];
    return ratio;
  }
  const Field& field = mesh.fields[static_cast<std::size_t>(channel.field)];
  const std::size_t n = field.values.size() / static_cast<std::size_t>(field.components);
  std::vector<double> result(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double* at = &field.values[i * static_cast<std::size_t>(field.components)];
    double sum = 0;
    for (int c = 0; c < field.components; ++c) sum += at[c] * at[c];
    result[i] = channel.component < field.components ? at[channel.component] : std::sqrt(sum);
  }
  return result;
}

std::string channel_name(Metric metric) {
  return metric == Metric::volume ? "element volume" : name(metric);
}

std::vector<Channel> channels(const SceneSource& source) {
  const MeshedModel& meshed = source.selector.meshed;
  const Mesh& mesh = meshed.mesh;
  std::vector<Channel> result;
  if (mesh.n_hexes() == 0) return result;
  Channel volume{.what = Channel::What::volume, .name = "volume", .group = "mesh", .is_class = true};
  for (int id = 1; meshed.model && id <= meshed.model->count(3); ++id) {
    const std::string name = meshed.model->name({3, id});
    volume.classes.emplace_back(id, "volume " + std::to_string(id) + (name.empty() ? "" : " " + name));
  }
  result.push_back(volume);
  if (!mesh.blocks.empty()) {
    Channel block{.what = Channel::What::block, .name = "block", .group = "mesh", .is_class = true};
    int last = 0;
    for (const Block& each : mesh.blocks) {
      block.classes.emplace_back(each.id,
                                 "block " + std::to_string(each.id) + (each.name.empty() ? "" : " " + each.name));
      last = std::max(last, each.id);
    }
    block.classes.emplace_back(last + 1, "in no block");
    result.push_back(block);
  }
  if (const auto pieces = pieces_of(source)) {
    result.push_back(
        {.what = Channel::What::level, .name = "level", .group = "mesh", .is_class = true, .pieces = pieces});
    std::map<std::uint32_t, bool> seen;
    for (const std::uint32_t cut : cuts(*pieces)) seen[cut] = true;
    Channel cut{.what = Channel::What::cut, .name = "template", .group = "mesh", .is_class = true, .pieces = pieces};
    for (const auto& [number, there] : seen)
      cut.classes.emplace_back(
          static_cast<int>(number),
          number == 0 ? "not cut" : "one into " + std::to_string(number / 2) + (number % 2 ? ", concave" : ""));
    result.push_back(cut);
  } else if (const auto field = std::ranges::find_if(mesh.fields, is_level_field); field != mesh.fields.end()) {
    result.push_back({.what = Channel::What::level,
                      .name = "level",
                      .group = "mesh",
                      .is_class = true,
                      .field = static_cast<Index>(field - mesh.fields.begin())});
  }
  if (source.before)
    result.push_back({.what = Channel::What::changed,
                      .name = "changed",
                      .group = "mesh",
                      .is_class = true,
                      .classes = {{0, "as before"}, {1, "changed"}}});
  if (last_wish(source.state))
    result.push_back({.what = Channel::What::size, .name = "actual / wished size", .group = "mesh"});
  for (const Metric metric : metrics())
    result.push_back(
        {.what = Channel::What::metric, .name = channel_name(metric), .group = "quality", .metric = metric});
  for (std::size_t i = 0; i < mesh.fields.size(); ++i) add_field(result, mesh.fields[i], static_cast<Index>(i));
  return result;
}

std::vector<std::string> scene_colours(const SceneSource& source) {
  const Mesh& mesh = source.selector.meshed.mesh;
  std::vector<std::string> result = {"none", "surface"};
  if (mesh.n_hexes() > 0) result.insert(result.end(), {"sheet", "owner"});
  if (!mesh.node_sets.empty()) result.emplace_back("nodeset");
  if (!mesh.side_sets.empty()) result.emplace_back("sideset");
  if (!source.selector.groups.empty()) result.emplace_back("group");
  for (const Channel& channel : channels(source)) result.push_back(channel.name);
  return result;
}

std::vector<Index> smallest_sheets(const SceneSource& source) {
  const Sheets& sheets = source.selector.topology.sheets();
  const Edges& edges = source.selector.topology.edges();
  std::vector<Index> result(source.selector.meshed.mesh.hexes.size());
  const auto size = [&](Index sheet) { return sheets.hexes[sheet].size(); };
  parallel_each(result.size(), [&](std::size_t h) {
    Index best = sheet_of(sheets, edges, static_cast<Index>(h), 0);
    for (int axis = 1; axis < 3; ++axis) {
      const Index other = sheet_of(sheets, edges, static_cast<Index>(h), axis);
      if (size(other) < size(best) || (size(other) == size(best) && other < best)) best = other;
    }
    result[h] = best;
  });
  return result;
}

PackedBlock channel_block(const SceneSource& source, const Channel& channel) {
  PackedBlock block{channel.name, {}};
  if (channel.is_class) {
    block.arrays = {packed("value", classes_of(source, channel))};
    return block;
  }
  const std::vector<double> values = values_of(source, channel);
  std::vector<float> result(values.begin(), values.end());
  if (source.selector.meshed.mesh.n_hexes() > most_exact)
    for (float& value : result) {
      constexpr std::uint32_t low_bits = 0x3ff;  // of 23: 13 are left, four digits
      const auto bits = std::bit_cast<std::uint32_t>(value);
      if (std::isfinite(value)) value = std::bit_cast<float>((bits + low_bits / 2) & ~low_bits);
    }
  block.arrays = {packed("value", result)};
  return block;
}

}  // namespace hextwist
