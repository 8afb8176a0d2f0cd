// What Nemesis adds to an Exodus II file (Hennigan and Shadid, "NEMESIS I: a set of functions for describing
// unstructured finite-element data on parallel computers", 1998).
#include <numeric>

#include "hextwist/io/exodus/write_internal.h"
#include "hextwist/io/file_part.h"

namespace hextwist::io {
namespace {

using Int64s = std::vector<std::int64_t>;

/// Inner ones and those at others, as positions in the file.
struct Division {
  Int64s inner, border;
  Division(Index n, const std::vector<char>& at_border, std::span<const int> position) {
    for (Index i = 0; i < n; ++i)
      (at_border[i] ? border : inner).push_back(position.empty() ? i + 1 : std::int64_t{position[i]});
    std::ranges::sort(inner);
    std::ranges::sort(border);
  }
};

}  // namespace

void write_exodus_part(const ExodusTarget& to, const FilePart& part, const ExodusGlobals& globals,
                       std::span<const int> element_of_hex) {
  const int status = ex_int64_status(to.file);
  ex_set_int64_status(to.file, EX_ALL_INT64_API);
  char type[] = "p";
  to.check(ex_put_init_info(to.file, part.n_parts, 1, type));
  const auto n_blocks = std::ssize(globals.block_ids), n_node_sets = std::ssize(globals.node_set_ids),
             n_side_sets = std::ssize(globals.side_set_ids);
  to.check(ex_put_init_global(to.file, part.n_nodes, part.n_hexes, n_blocks, n_node_sets, n_side_sets));
  Int64s ids = globals.block_ids, counts = globals.block_counts;
  if (n_blocks) to.check(ex_put_eb_info_global(to.file, ids.data(), counts.data()));
  const auto put_sets = [&](const auto& put, Int64s set_ids, Int64s members, Int64s factors) {
    if (!set_ids.empty()) to.check(put(to.file, set_ids.data(), members.data(), factors.data()));
  };
  put_sets(ex_put_ns_param_global, globals.node_set_ids, part.node_sets, globals.node_factors);
  put_sets(ex_put_ss_param_global, globals.side_set_ids, part.side_sets, globals.side_factors);

  std::vector<char> node_at_border(to.mesh.points.size(), 0), hex_at_border(to.mesh.hexes.size(), 0);
  for (const FilePart::SharedNodes& shared : part.nodes)
    for (const Index n : shared.nodes) node_at_border[n] = 1;
  for (std::size_t h = 0; h < hex_at_border.size(); ++h)
    hex_at_border[h] = std::ranges::any_of(to.mesh.hexes[h], [&](Index n) { return node_at_border[n]; });
  Division nodes(to.mesh.n_nodes(), node_at_border, {}), hexes(to.mesh.n_hexes(), hex_at_border, element_of_hex);
  to.check(ex_put_loadbal_param(to.file, std::ssize(nodes.inner), std::ssize(nodes.border), 0, std::ssize(hexes.inner),
                                std::ssize(hexes.border), std::ssize(part.nodes), std::ssize(part.sides), part.number));
  Int64s node_maps, node_counts, side_maps, side_counts;
  for (const FilePart::SharedNodes& shared : part.nodes)
    node_maps.push_back(shared.part + 1), node_counts.push_back(std::ssize(shared.nodes));
  for (const FilePart::SharedSides& shared : part.sides)
    side_maps.push_back(shared.part + 1), side_counts.push_back(std::ssize(shared.sides));
  if (!node_maps.empty())
    to.check(ex_put_cmap_params(to.file, node_maps.data(), node_counts.data(), side_maps.data(), side_counts.data(),
                                part.number));
  to.check(ex_put_processor_node_maps(to.file, nodes.inner.data(), nodes.border.data(), nullptr, part.number));
  to.check(ex_put_processor_elem_maps(to.file, hexes.inner.data(), hexes.border.data(), part.number));
  for (const FilePart::SharedNodes& shared : part.nodes) {
    Int64s members(shared.nodes.begin(), shared.nodes.end()), parts(members.size(), shared.part);
    for (std::int64_t& n : members) ++n;
    to.check(ex_put_node_cmap(to.file, shared.part + 1, members.data(), parts.data(), part.number));
  }
  for (const FilePart::SharedSides& shared : part.sides) {
    Int64s members, sides, parts(shared.sides.size(), shared.part);
    for (const Side& side : shared.sides) {
      members.push_back(element_of_hex[side.hex]);
      sides.push_back(exodus_side_of(side.face));
    }
    to.check(ex_put_elem_cmap(to.file, shared.part + 1, members.data(), sides.data(), parts.data(), part.number));
  }
  ex_set_int64_status(to.file, status & EX_ALL_INT64_API);
}

PartHead read_exodus_head(const std::filesystem::path& file) {
  const Bytes bytes = read_bytes(file);
  if (is_classic_netcdf(bytes)) check_classic_netcdf(bytes);
  ex_opts(0);
  int memory = 8, disk = 0;
  float version = 0;
  const int id = ex_open(file.c_str(), EX_READ, &memory, &disk, &version);
  if (id < 0) throw Error(file.string() + ": cannot be opened as Exodus II (damaged or another format)");
  ex_set_int64_status(id, EX_ALL_INT64_API);
  PartHead head;
  int n_in_file = 0;
  char type[MAX_STR_LENGTH + 1] = "";
  std::int64_t n_blocks = 0, n_node_sets = 0, n_side_sets = 0;
  // The call succeeds without the numbers as well: then there is one part.
  const bool is_part =
      ex_get_init_global(id, &head.n_nodes, &head.n_hexes, &n_blocks, &n_node_sets, &n_side_sets) >= 0 &&
      ex_get_init_info(id, &head.n_parts, &n_in_file, type) >= 0;
  ex_close(id);
  if (!is_part) return {};
  if (n_in_file != 1)
    throw Error(file.string() + ": has " + std::to_string(n_in_file) + " parts; one part a file is read");
  return head;
}

}  // namespace hextwist::io
