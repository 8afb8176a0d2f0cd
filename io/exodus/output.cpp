// Calls of the Exodus library that say when they fail.
#include <netcdf.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "hextwist/io/exodus/write_internal.h"

namespace hextwist::io {

void ExodusOutput::create(bool wide, std::size_t n_hexes, int nodes_per_hex) {
  is_wide_ = wide;
  // One variable of a 64-bit offset file holds at most 4 GiB; beyond that, and for wide ids, HDF5.
  const bool large = n_hexes > (std::size_t{1} << 32) / (4 * static_cast<std::size_t>(nodes_per_hex)) - 1;
  int mode = EX_CLOBBER | (wide || large ? EX_NETCDF4 | EX_NOCLASSIC : EX_LARGE_MODEL);
  if (wide) mode |= EX_ALL_INT64_DB | EX_MAPS_INT64_API | EX_IDS_INT64_API;
  int memory = 8, disk = 8;
  ex_opts(0);
  file_ = ex_create(to_.temporary().c_str(), mode, &memory, &disk);
  if (file_ < 0) fail();
}

void ExodusOutput::put_sizes(ex_init_params sizes, const std::string& title, std::size_t longest_name) {
  check(ex_set_max_name_length(file_, static_cast<int>(std::min<std::size_t>(longest_name, 255))));
  std::strncpy(sizes.title, title.empty() ? "hextwist" : title.c_str(), sizeof sizes.title - 1);
  sizes.num_dim = 3;
  check(ex_put_init_ext(file_, &sizes));
}

void ExodusOutput::put_coordinates(int axis, std::size_t first, std::span<const double> values) {
  std::array<const double*, 3> x{};
  x[axis] = values.data();
  check(ex_put_partial_coord(file_, exodus_position(first), std::ssize(values), x[0], x[1], x[2]));
}

void ExodusOutput::put_coordinate_names(const std::vector<std::string>& names) {
  const std::vector<std::string> plain = {"x", "y", "z"};
  check(ex_put_coord_names(file_, TextsWritten(names.size() == plain.size() ? names : plain).pointers.data()));
}

void ExodusOutput::put_block(const ExodusPart& part, const std::string& type, std::int64_t n, int nodes_each,
                             std::int64_t n_attributes) {
  check(ex_put_block(file_, EX_ELEM_BLOCK, part.in_file, type.c_str(), n, nodes_each, 0, 0, n_attributes));
  put_name(EX_ELEM_BLOCK, part.in_file, part.name);
}

void ExodusOutput::put_name(ex_entity_type type, std::int64_t id, const std::string& name) {
  if (!name.empty()) check(ex_put_name(file_, type, id, exodus_name(name).c_str()));
}

void ExodusOutput::put_set(ex_entity_type type, std::int64_t id, const std::string& name,
                           const std::vector<int>& members, const std::vector<int>& sides,
                           const std::vector<double>& factors) {
  check(ex_put_set_param(file_, type, id, std::ssize(members), std::ssize(factors)));
  if (!members.empty()) check(ex_put_set(file_, type, id, members.data(), sides.empty() ? nullptr : sides.data()));
  if (!factors.empty()) check(ex_put_set_dist_fact(file_, type, id, factors.data()));
  put_name(type, id, name);
}

void say_exodus_names(const Mesh& mesh, std::vector<std::string>& notices) {
  const auto say = [&](const auto& groups, const char* kind) {
    for (const auto& group : groups)
      say_renamed(kind + std::to_string(group.id), group.name, exodus_name(group.name), notices);
  };
  say(mesh.blocks, "block "), say(mesh.node_sets, "nodeset "), say(mesh.side_sets, "sideset ");
}

void say_rest_block(std::int64_t n_hexes, std::int64_t id, std::vector<std::string>& notices) {
  if (n_hexes > 0)
    notices.push_back(std::to_string(n_hexes) + " hexes that are in no block are in element block " +
                      std::to_string(id) + " '" + exodus_rest_block + "'");
}

/// The library writes a name and one zero: behind that the file has what netCDF's buffers held before.
void ExodusOutput::clear_behind_names() {
  const auto check_netcdf = [this](int status) { check(status == NC_NOERR ? 0 : -1); };
  int n_variables = 0;
  check_netcdf(nc_inq_nvars(file_, &n_variables));
  for (int v = 0; v < n_variables; ++v) {
    nc_type type = NC_NAT;
    int n_dimensions = 0;
    std::array<int, NC_MAX_VAR_DIMS> dimensions;
    check_netcdf(nc_inq_var(file_, v, nullptr, &type, &n_dimensions, dimensions.data(), nullptr));
    if (type != NC_CHAR || n_dimensions == 0) continue;
    std::size_t length = 0, n = 1;
    for (int d = 0; d < n_dimensions; ++d) {
      check_netcdf(nc_inq_dimlen(file_, dimensions[d], &length));
      n *= length;
    }
    if (n == 0) continue;
    std::string texts(n, '\0');
    check_netcdf(nc_get_var_text(file_, v, texts.data()));
    for (std::size_t at = 0; at < n; at += length) {
      const auto row = texts.begin() + static_cast<std::ptrdiff_t>(at), end = row + static_cast<std::ptrdiff_t>(length);
      std::fill(std::find(row, end, '\0'), end, '\0');
    }
    check_netcdf(nc_put_var_text(file_, v, texts.data()));
  }
}

void ExodusOutput::close() {
  clear_behind_names();
  const int file = std::exchange(file_, -1);
  if (ex_close(file) < 0) fail();
}

}  // namespace hextwist::io
