#include "exodus_floor.h"

#include <exodusII.h>

#include "hextwist/mesh/corners.h"

namespace hextwist::bench {
namespace {

void check(int status) {
  if (status < 0) throw Error("a call of Exodus' library failed");
}

}  // namespace

ExodusArrays exodus_arrays(const Mesh& mesh) {
  ExodusArrays arrays;
  for (const Vec3& p : mesh.points) {
    arrays.x.push_back(p.x());
    arrays.y.push_back(p.y());
    arrays.z.push_back(p.z());
    arrays.node_ids.push_back(static_cast<int>(arrays.x.size()));
  }
  for (const Hex& hex : mesh.hexes) {
    for (const int corner : file_corner) arrays.nodes.push_back(hex[corner] + 1);
    arrays.hex_ids.push_back(static_cast<int>(arrays.nodes.size() / 8));
  }
  return arrays;
}

void write_exodus_plainly(const std::filesystem::path& file, const ExodusArrays& arrays) {
  int memory = 8, disk = 8;
  const int id = ex_create(file.c_str(), EX_CLOBBER | EX_LARGE_MODEL, &memory, &disk);
  check(id);
  const auto n_nodes = std::ssize(arrays.node_ids), n_hexes = std::ssize(arrays.hex_ids);
  check(ex_put_init(id, "floor", 3, n_nodes, n_hexes, 1, 0, 0));
  check(ex_put_coord(id, arrays.x.data(), arrays.y.data(), arrays.z.data()));
  check(ex_put_id_map(id, EX_NODE_MAP, arrays.node_ids.data()));
  check(ex_put_block(id, EX_ELEM_BLOCK, 1, "HEX8", n_hexes, 8, 0, 0, 0));
  check(ex_put_conn(id, EX_ELEM_BLOCK, 1, arrays.nodes.data(), nullptr, nullptr));
  check(ex_put_id_map(id, EX_ELEM_MAP, arrays.hex_ids.data()));
  check(ex_close(id));
}

ExodusArrays read_exodus_plainly(const std::filesystem::path& file) {
  int memory = 8, disk = 0;
  float version = 0;
  const int id = ex_open(file.c_str(), EX_READ, &memory, &disk, &version);
  check(id);
  ex_init_params init{};
  check(ex_get_init_ext(id, &init));
  ExodusArrays arrays;
  arrays.x.resize(static_cast<std::size_t>(init.num_nodes));
  arrays.y.resize(arrays.x.size());
  arrays.z.resize(arrays.x.size());
  arrays.node_ids.resize(arrays.x.size());
  arrays.hex_ids.resize(static_cast<std::size_t>(init.num_elem));
  arrays.nodes.resize(8 * arrays.hex_ids.size());
  check(ex_get_coord(id, arrays.x.data(), arrays.y.data(), arrays.z.data()));
  check(ex_get_id_map(id, EX_NODE_MAP, arrays.node_ids.data()));
  int block = 0;
  check(ex_get_ids(id, EX_ELEM_BLOCK, &block));
  check(ex_get_conn(id, EX_ELEM_BLOCK, block, arrays.nodes.data(), nullptr, nullptr));
  check(ex_get_id_map(id, EX_ELEM_MAP, arrays.hex_ids.data()));
  check(ex_close(id));
  return arrays;
}

}  // namespace hextwist::bench
