#include "split_judge.h"

#include <netcdf.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>

namespace hextwist::test {
namespace {

using Ints = std::vector<long long>;
using Face = std::array<long long, 4>;

class NetCdf {
 public:
  explicit NetCdf(const std::string& file) { ok_ = nc_open(file.c_str(), NC_NOWRITE, &id_) == NC_NOERR; }
  ~NetCdf() {
    if (ok_) nc_close(id_);
  }
  NetCdf(const NetCdf&) = delete;
  NetCdf& operator=(const NetCdf&) = delete;
  bool ok() const { return ok_; }
  long long dimension(const std::string& name) const {
    int dim = 0;
    std::size_t length = 0;
    return nc_inq_dimid(id_, name.c_str(), &dim) == NC_NOERR && nc_inq_dimlen(id_, dim, &length) == NC_NOERR
               ? static_cast<long long>(length)
               : 0;
  }
  Ints ints(const std::string& name) const {
    int variable = 0;
    Ints values(size(name, variable));
    if (!values.empty() && nc_get_var_longlong(id_, variable, values.data()) != NC_NOERR) values.clear();
    return values;
  }
  std::vector<double> doubles(const std::string& name) const {
    int variable = 0;
    std::vector<double> values(size(name, variable));
    if (!values.empty() && nc_get_var_double(id_, variable, values.data()) != NC_NOERR) values.clear();
    return values;
  }

 private:
  std::size_t size(const std::string& name, int& variable) const {
    if (nc_inq_varid(id_, name.c_str(), &variable) != NC_NOERR) return 0;
    int n = 0;
    std::array<int, NC_MAX_VAR_DIMS> dims{};
    nc_inq_varndims(id_, variable, &n);
    nc_inq_vardimid(id_, variable, dims.data());
    std::size_t total = 1;
    for (int i = 0; i < n; ++i) {
      std::size_t length = 0;
      nc_inq_dimlen(id_, dims[i], &length);
      total *= length;
    }
    return total;
  }
  int id_ = -1;
  bool ok_ = false;
};

struct Part {
  Ints node_id, hex_id;
  std::vector<std::array<double, 3>> place;
  std::vector<std::array<long long, 8>> hex;  // node ids, as the file orders them
  Ints inner, border;                         // ids
  std::map<long long, Ints> node_map;         // other part: ids in order
  std::map<long long, std::vector<Face>> side_map;
};

// Corners of the sides of a hex in Exodus files, 0-based.
constexpr int side_corner[6][4] = {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {0, 4, 7, 3}, {0, 3, 2, 1}, {4, 5, 6, 7}};
Face face_of(const std::array<long long, 8>& hex, int side) {
  Face face{};
  for (int k = 0; k < 4; ++k) face[k] = hex[side_corner[side][k]];
  std::ranges::sort(face);
  return face;
}

Part read(const NetCdf& file) {
  Part part;
  part.node_id = file.ints("node_num_map");
  part.hex_id = file.ints("elem_num_map");
  const auto x = file.doubles("coordx"), y = file.doubles("coordy"), z = file.doubles("coordz");
  for (std::size_t i = 0; i < x.size(); ++i) part.place.push_back({x[i], y[i], z[i]});
  for (long long b = 1; b <= file.dimension("num_el_blk"); ++b) {
    const Ints nodes = file.ints("connect" + std::to_string(b));
    for (std::size_t i = 0; i + 8 <= nodes.size(); i += 8) {
      std::array<long long, 8> hex{};
      for (std::size_t k = 0; k < 8; ++k) hex[k] = part.node_id.at(static_cast<std::size_t>(nodes[i + k] - 1));
      part.hex.push_back(hex);
    }
  }
  const auto ids = [&](Ints positions) {
    for (long long& n : positions) n = part.node_id.at(static_cast<std::size_t>(n - 1));
    return positions;
  };
  part.inner = ids(file.ints("node_mapi"));
  part.border = ids(file.ints("node_mapb"));
  const Ints members = ids(file.ints("n_comm_nids")), with = file.ints("n_comm_proc");
  for (std::size_t i = 0; i < members.size(); ++i) part.node_map[with[i]].push_back(members[i]);
  const Ints hexes = file.ints("e_comm_eids"), sides = file.ints("e_comm_sids"), across = file.ints("e_comm_proc");
  for (std::size_t i = 0; i < hexes.size(); ++i)
    part.side_map[across[i]].push_back(
        face_of(part.hex.at(static_cast<std::size_t>(hexes[i] - 1)), static_cast<int>(sides[i]) - 1));
  return part;
}

}  // namespace

std::vector<std::string> split_faults(const std::filesystem::path& name, int n_parts, std::size_t most) {
  std::vector<std::string> faults;
  const auto fault = [&](int p, const std::string& what) {
    if (faults.size() < most) faults.push_back("part " + std::to_string(p) + ": " + what);
  };
  std::vector<Part> parts;
  std::map<long long, std::set<int>> parts_of_node;
  std::map<long long, std::array<double, 3>> place;
  std::map<Face, std::set<int>> parts_of_face;
  std::set<long long> hexes;
  std::vector<std::array<long long, 2>> said;
  const std::string count = std::to_string(n_parts);
  for (int p = 0; p < n_parts; ++p) {
    std::string number = std::to_string(p);
    number.insert(0, count.size() - number.size(), '0');
    const NetCdf file(name.string() + "." + count + "." + number);
    if (!file.ok()) {
      fault(p, "cannot be opened");
      return faults;
    }
    if (file.dimension("num_processors") != n_parts) fault(p, "says another number of parts");
    said.push_back({file.dimension("num_nodes_global"), file.dimension("num_elems_global")});
    parts.push_back(read(file));
    const Part& part = parts.back();
    if (part.hex.size() != part.hex_id.size()) fault(p, "has another number of ids than hexes");
    for (const long long h : part.hex_id)
      if (!hexes.insert(h).second) fault(p, "has hex " + std::to_string(h) + " again");
    for (std::size_t i = 0; i < part.node_id.size(); ++i) {
      parts_of_node[part.node_id[i]].insert(p);
      if (!place.emplace(part.node_id[i], part.place[i]).second && place[part.node_id[i]] != part.place[i])
        fault(p, "has node " + std::to_string(part.node_id[i]) + " elsewhere");
    }
    for (const auto& hex : part.hex)
      for (int side = 0; side < 6; ++side) parts_of_face[face_of(hex, side)].insert(p);
  }
  for (int p = 0; p < n_parts; ++p) {
    const Part& part = parts[p];
    if (said[p] != std::array{static_cast<long long>(place.size()), static_cast<long long>(hexes.size())})
      fault(p, "says other global counts");
    Ints all = part.inner;
    all.insert(all.end(), part.border.begin(), part.border.end());
    std::ranges::sort(all);
    Ints nodes = part.node_id;
    std::ranges::sort(nodes);
    if (all != nodes) fault(p, "inner and border nodes are not all nodes");
    std::map<int, std::set<long long>> shared;
    std::map<int, std::set<Face>> across;
    for (const long long n : part.node_id)
      for (const int other : parts_of_node[n])
        if (other != p) shared[other].insert(n);
    for (const auto& hex : part.hex)
      for (int side = 0; side < 6; ++side)
        for (const int other : parts_of_face[face_of(hex, side)])
          if (other != p) across[other].insert(face_of(hex, side));
    std::set<long long> border;
    for (const auto& [other, ids] : shared) border.insert(ids.begin(), ids.end());
    if (std::set<long long>(part.border.begin(), part.border.end()) != border) fault(p, "border nodes are wrong");
    for (int other = 0; other < n_parts; ++other) {
      if (other == p) continue;
      const auto at = [&](const auto& maps, int of) {
        const auto found = maps.find(of);
        return found == maps.end() ? typename std::decay_t<decltype(maps)>::mapped_type{} : found->second;
      };
      const Ints mine = at(part.node_map, other);
      if (std::set<long long>(mine.begin(), mine.end()) != shared[other] || mine.size() != shared[other].size())
        fault(p, "the map of nodes for part " + std::to_string(other) + " is wrong");
      if (mine != at(parts[other].node_map, p))
        fault(p, "the maps of nodes for part " + std::to_string(other) + " are in another order there");
      const std::vector<Face> sides = at(part.side_map, other);
      if (std::set<Face>(sides.begin(), sides.end()) != across[other] || sides.size() != across[other].size())
        fault(p, "the map of sides for part " + std::to_string(other) + " is wrong");
      if (sides != at(parts[other].side_map, p))
        fault(p, "the maps of sides for part " + std::to_string(other) + " are in another order there");
    }
  }
  return faults;
}

}  // namespace hextwist::test
