#include "hextwist/io/cgns/zones_internal.h"

#include <limits>

namespace hextwist::io {
namespace {

using Triple = std::array<std::int64_t, 3>;

/// The label of the node that the library stands at, if it is one of ours.
CgnsLabel label_here(const std::string& name) {
  CgnsLabel label{"", -1, name};
  int n = 0;
  if (cg_ndescriptors(&n) != CG_OK) return label;
  for (int d = 1; d <= n; ++d) {
    CgnsName of{};
    char* text = nullptr;
    if (cg_descriptor_read(d, of.data(), &text) != CG_OK || !text) continue;
    const std::string said = text;
    cg_free(text);
    if (std::string_view(of.data()) != cgns_label) continue;
    Cursor words(said, "");
    const std::string kind(words.word());
    if (kind == "part") return {kind, -1, name};
    const std::string_view id = words.word();
    int number = -1;
    const auto [stop, error] = std::from_chars(id.data(), id.data() + id.size(), number);
    if ((kind != "block" && kind != "nodeset" && kind != "sideset") || error != std::errc{} || number < 0) continue;
    if (words.at < words.end) ++words.at;
    return {kind, number, std::string(words.at, words.end)};
  }
  return label;
}

std::string family_here() {
  std::array<char, 1024> family{};
  return cg_famname_read(family.data()) == CG_OK ? family.data() : "";
}

/// A zone's name where that may have its base before it.
std::string_view without_base(std::string_view name) {
  const auto slash = name.rfind('/');
  return slash == std::string_view::npos ? name : name.substr(slash + 1);
}

/// Numbers of a point set in the three directions, or one.
std::vector<cgsize_t> members(const CgnsPlace& in, const CgnsZone& zone, const std::string& what,
                              CGNS_ENUMT(PointSetType_t) type, std::vector<cgsize_t> points, bool& range) {
  range = type == CGNS_ENUMV(PointRange) || type == CGNS_ENUMV(ElementRange);
  const bool list = type == CGNS_ENUMV(PointList) || type == CGNS_ENUMV(ElementList);
  if (!range && !list) in.fail(what + " has points of an unknown kind");
  if (zone.structured || !range) return points;
  range = false;
  if (points.size() != 2 || points[0] > points[1] || points[0] < 1 ||
      points[1] > std::max(zone.n_nodes, std::max(zone.n_cells, zone.sections.empty() ? 0 : zone.sections.back().end)))
    in.fail(what + " has an impossible range");
  std::vector<cgsize_t> all;
  for (cgsize_t i = points[0]; i <= points[1]; ++i) all.push_back(i);
  return all;
}

}  // namespace

void CgnsPlace::check(int status, const std::string& what) const {
  if (status != CG_OK) fail(what + " cannot be read: " + cgns_error());
}

std::int64_t CgnsPlace::count(std::int64_t n, const std::string& what) const {
  if (n < 0 || static_cast<std::uintmax_t>(n) > 300 * size || n > std::numeric_limits<Index>::max())
    fail("impossible number of " + what + ": " + std::to_string(n));
  return n;
}

CgnsZone cgns_zone(const CgnsPlace& in, int number, std::int64_t first_node) {
  CgnsZone zone;
  zone.number = number;
  zone.first_node = first_node;
  CgnsName name{};
  std::array<cgsize_t, 9> size{};
  auto type = CGNS_ENUMV(ZoneTypeNull);
  in.check(cg_zone_type(in.file, in.base, number, &type), "a zone");
  int dimension = 0;
  in.check(cg_index_dim(in.file, in.base, number, &dimension), "a zone");
  zone.structured = type == CGNS_ENUMV(Structured);
  if ((!zone.structured && type != CGNS_ENUMV(Unstructured)) || dimension != (zone.structured ? 3 : 1))
    in.fail("zone " + std::to_string(number) + " is neither unstructured nor structured in three directions");
  in.check(cg_zone_read(in.file, in.base, number, name.data(), size.data()), "a zone");
  zone.name = name.data();
  if (zone.structured) {
    double n = 1;
    for (std::size_t d = 0; d < 3; ++d) {
      zone.nodes[d] = in.count(size[d], "nodes");
      zone.cells[d] = zone.nodes[d] - 1;
      if (zone.cells[d] < 1) in.fail("zone " + shown(zone.name) + " has no cell");
      n *= static_cast<double>(size[d]);
    }
    zone.n_nodes = in.count(n < 1e18 ? static_cast<std::int64_t>(n) : -1, "nodes");
    zone.n_cells = zone.cells[0] * zone.cells[1] * zone.cells[2];
  } else {
    zone.n_nodes = in.count(size[0], "nodes");
    zone.n_cells = in.count(size[1], "cells");
  }
  in.count(first_node + zone.n_nodes, "nodes");
  if (cg_goto(in.file, in.base, "Zone_t", number, "end") == CG_OK) zone.family = without_base(family_here());

  int n_sections = 0;
  if (!zone.structured) in.check(cg_nsections(in.file, in.base, number, &n_sections), "sections");
  for (int s = 1; s <= n_sections; ++s) {
    CgnsSection& section = zone.sections.emplace_back();
    CgnsName of{};
    cgsize_t start = 0, end = 0;
    int boundary = 0, parents = 0;
    in.check(cg_section_read(in.file, in.base, number, s, of.data(), &section.type, &start, &end, &boundary, &parents),
             "a section");
    section.number = s;
    section.name = of.data();
    section.start = start;
    section.end = end;
    if (start < 1 || end < start) in.fail("section " + shown(section.name) + " has an impossible range of elements");
    in.count(end, "elements");
    section.label = {"", -1, section.name};
    if (cg_goto(in.file, in.base, "Zone_t", number, "Elements_t", s, "end") == CG_OK)
      section.label = label_here(section.name);
  }
  std::ranges::stable_sort(zone.sections, {}, &CgnsSection::start);
  return zone;
}

std::vector<Vec3> cgns_points(const CgnsPlace& in, const CgnsZone& zone) {
  std::vector<Vec3> points(static_cast<std::size_t>(zone.n_nodes));
  std::vector<double> values(points.size());
  const std::array<cgsize_t, 3> first = {1, 1, 1};
  std::array<cgsize_t, 3> last = {static_cast<cgsize_t>(zone.n_nodes), 1, 1};
  if (zone.structured)
    for (std::size_t d = 0; d < 3; ++d) last[d] = static_cast<cgsize_t>(zone.nodes[d]);
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name = std::string("Coordinate") + "XYZ"[axis];
    if (cg_coord_read(in.file, in.base, zone.number, name.c_str(), CGNS_ENUMV(RealDouble), first.data(), last.data(),
                      values.data()) != CG_OK)
      in.fail("zone " + shown(zone.name) + ": " + name + " cannot be read: " + cgns_error());
    for (std::size_t i = 0; i < points.size(); ++i) points[i][axis] = values[i];
  }
  return points;
}

std::vector<std::int64_t> cgns_ids(const CgnsPlace& in, const CgnsZone& zone, const char* name) {
  std::vector<std::int64_t> ids;
  if (cg_goto(in.file, in.base, "Zone_t", zone.number, cgns_label, 0, "end") != CG_OK) return ids;
  int n = 0;
  if (cg_narrays(&n) != CG_OK) return ids;
  for (int a = 1; a <= n; ++a) {
    CgnsName of{};
    auto type = CGNS_ENUMV(DataTypeNull);
    int dimension = 0;
    std::array<cgsize_t, 12> sizes{};
    in.check(cg_array_info(a, of.data(), &type, &dimension, sizes.data()), "ids");
    if (std::string_view(of.data()) != name || type != CGNS_ENUMV(LongInteger) || dimension != 1) continue;
    ids.resize(static_cast<std::size_t>(in.count(sizes[0], "ids")));
    std::vector<long> values(ids.size());
    in.check(cg_array_read(a, values.data()), "ids");
    std::ranges::copy(values, ids.begin());
  }
  return ids;
}

std::vector<std::pair<std::int64_t, std::int64_t>> cgns_joined_nodes(CgnsPlace& in, const CgnsZone& zone,
                                                                     const std::vector<CgnsZone>& zones) {
  std::vector<std::pair<std::int64_t, std::int64_t>> pairs;
  const auto find = [&](const char* name) -> const CgnsZone& {
    const auto found = std::ranges::find(zones, without_base(name), &CgnsZone::name);
    if (found == zones.end())
      in.fail("zone " + shown(zone.name) + " is joined to zone " + shown(name) + ", which is not there");
    return *found;
  };
  const auto apart = [&](const char* name, const std::string& why) {
    in.notes.push_back("zone " + shown(zone.name) + ": connectivity " + shown(name) + " is " + why +
                       ": nodes stay apart there");
  };
  std::array<float, 3> centre{}, angle{}, translation{};
  int n = 0;
  if (cg_n1to1(in.file, in.base, zone.number, &n) != CG_OK) n = 0;
  for (int c = 1; c <= n; ++c) {
    CgnsName name{};
    std::array<char, 1024> donor{};
    std::array<cgsize_t, 6> range{}, donor_range{};
    std::array<int, 3> transform{};
    in.check(cg_1to1_read(in.file, in.base, zone.number, c, name.data(), donor.data(), range.data(), donor_range.data(),
                          transform.data()),
             "connectivity");
    if (cg_1to1_periodic_read(in.file, in.base, zone.number, c, centre.data(), angle.data(), translation.data()) ==
        CG_OK) {
      apart(name.data(), "periodic");
      continue;
    }
    const CgnsZone& other = find(donor.data());
    const auto wrong = [&] {
      in.fail("connectivity " + shown(name.data()) + " of zone " + shown(zone.name) + " does not fit the zones");
    };
    if (!zone.structured || !other.structured) wrong();
    int axes = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      const int to = std::abs(transform[d]);
      if (to < 1 || to > 3) wrong();
      axes |= 1 << (to - 1);
      for (const std::size_t end : {d, d + 3})
        if (range[end] < 1 || range[end] > zone.nodes[d] || donor_range[end] < 1 || donor_range[end] > other.nodes[d])
          wrong();
    }
    if (axes != 7) wrong();
    Triple steps{}, sign{};
    for (std::size_t d = 0; d < 3; ++d) {
      steps[d] = std::abs(range[d + 3] - range[d]);
      sign[d] = range[d + 3] >= range[d] ? 1 : -1;
    }
    for (std::int64_t k = 0; k <= steps[2]; ++k)
      for (std::int64_t j = 0; j <= steps[1]; ++j)
        for (std::int64_t i = 0; i <= steps[0]; ++i) {
          Triple here = {i * sign[0], j * sign[1], k * sign[2]}, there{};
          for (std::size_t d = 0; d < 3; ++d) {
            const auto to = static_cast<std::size_t>(std::abs(transform[d])) - 1;
            there[to] = donor_range[to] - 1 + (transform[d] > 0 ? here[d] : -here[d]);
          }
          for (std::size_t d = 0; d < 3; ++d) {
            here[d] += range[d] - 1;
            if (there[d] < 0 || there[d] >= other.nodes[d]) wrong();
          }
          pairs.emplace_back(zone.first_node + zone.node_at(here), other.first_node + other.node_at(there));
        }
  }
  if (cg_nconns(in.file, in.base, zone.number, &n) != CG_OK) n = 0;
  for (int c = 1; c <= n; ++c) {
    CgnsName name{};
    std::array<char, 1024> donor{};
    auto location = CGNS_ENUMV(Vertex);
    auto type = CGNS_ENUMV(GridConnectivityTypeNull);
    auto points = CGNS_ENUMV(PointSetTypeNull), donor_points = points;
    auto donor_zone = CGNS_ENUMV(ZoneTypeNull);
    auto donor_data = CGNS_ENUMV(DataTypeNull);
    cgsize_t n_points = 0, n_donors = 0;
    in.check(cg_conn_info(in.file, in.base, zone.number, c, name.data(), &location, &type, &points, &n_points,
                          donor.data(), &donor_zone, &donor_points, &donor_data, &n_donors),
             "connectivity");
    if (cg_conn_periodic_read(in.file, in.base, zone.number, c, centre.data(), angle.data(), translation.data()) ==
        CG_OK) {
      apart(name.data(), "periodic");
      continue;
    }
    const CgnsZone& other = find(donor.data());
    if (type != CGNS_ENUMV(Abutting1to1) || location != CGNS_ENUMV(Vertex) || points != CGNS_ENUMV(PointList) ||
        n_points != n_donors || zone.structured || other.structured) {
      apart(name.data(), "not 1-to-1 by nodes of unstructured zones");
      continue;
    }
    std::vector<cgsize_t> here(static_cast<std::size_t>(in.count(n_points, "joined nodes"))), there(here.size());
    in.check(cg_conn_read(in.file, in.base, zone.number, c, here.data(), CGNS_ENUMV(Integer), there.data()),
             "connectivity");
    for (std::size_t i = 0; i < here.size(); ++i) {
      if (here[i] < 1 || here[i] > zone.n_nodes || there[i] < 1 || there[i] > other.n_nodes)
        in.fail("connectivity " + shown(name.data()) + " of zone " + shown(zone.name) +
                " names a node that is not there");
      pairs.emplace_back(zone.first_node + here[i] - 1, other.first_node + there[i] - 1);
    }
  }
  return pairs;
}

void cgns_elements(
    const CgnsPlace& in, const CgnsZone& zone, const CgnsSection& section,
    const std::function<void(std::int64_t number, const CgnsType& type, std::span<const cgsize_t> nodes)>& f) {
  const std::string where = "section " + shown(section.name);
  if (section.type == CGNS_ENUMV(NGON_n) || section.type == CGNS_ENUMV(NFACE_n))
    in.fail(where + " has polyhedra or polygons; only hexes of 8, 20 or 27 nodes are accepted");
  cgsize_t size = 0;
  in.check(cg_ElementDataSize(in.file, in.base, zone.number, section.number, &size), where);
  std::vector<cgsize_t> connectivity(static_cast<std::size_t>(in.count(size, "nodes of elements")));
  if (section.type == CGNS_ENUMV(MIXED)) {
    std::vector<cgsize_t> begins(static_cast<std::size_t>(section.end - section.start) + 2);
    in.check(cg_poly_elements_read(in.file, in.base, zone.number, section.number, connectivity.data(), begins.data(),
                                   nullptr),
             where);
  } else {
    in.check(cg_elements_read(in.file, in.base, zone.number, section.number, connectivity.data(), nullptr), where);
  }
  std::size_t at = 0;
  for (std::int64_t number = section.start; number <= section.end; ++number) {
    auto type = section.type;
    const std::string element = "element " + std::to_string(number) + " of " + where;
    if (type == CGNS_ENUMV(MIXED)) {
      if (at >= connectivity.size()) in.fail(where + " ends before element " + std::to_string(number));
      if (connectivity[at] <= 1 || connectivity[at] >= NofValidElementTypes)
        in.fail(element + " is of an unknown type");
      type = static_cast<CGNS_ENUMT(ElementType_t)>(connectivity[at++]);
    }
    int n = 0;
    in.check(cg_npe(type, &n), element);
    if (n < 1) in.fail(element + " is of an unknown type");
    if (static_cast<std::size_t>(n) > connectivity.size() - at)
      in.fail(where + " ends before element " + std::to_string(number));
    CgnsType is{CgnsType::other, cg_ElementTypeName(type)};
    if (type == CGNS_ENUMV(HEXA_8) || type == CGNS_ENUMV(HEXA_20) || type == CGNS_ENUMV(HEXA_27))
      is.what = CgnsType::hex;
    else if (type == CGNS_ENUMV(QUAD_4) || type == CGNS_ENUMV(QUAD_8) || type == CGNS_ENUMV(QUAD_9))
      is.what = CgnsType::quad;
    const std::string_view name = is.name;
    for (const auto& [begins, kind] : {std::pair("TETRA", "tetrahedron"), {"PYRA", "pyramid"}, {"PENTA", "wedge"}})
      if (name.starts_with(begins))
        in.fail(element + " is a " + kind + "; only hexes of 8, 20 or 27 nodes are accepted");
    if (is.what == CgnsType::other && name.starts_with("HEXA"))
      in.fail(element + " is a " + is.name + "; only hexes of 8, 20 or 27 nodes are accepted");
    f(number, is, std::span(connectivity).subspan(at, static_cast<std::size_t>(n)));
    at += static_cast<std::size_t>(n);
  }
}

std::vector<CgnsRegion> cgns_regions(CgnsPlace& in, const CgnsZone& zone) {
  std::vector<CgnsRegion> result;
  int n = 0;
  if (cg_nsubregs(in.file, in.base, zone.number, &n) != CG_OK) return result;
  for (int s = 1; s <= n; ++s) {
    CgnsRegion region;
    CgnsName name{};
    int dimension = 0, of_condition = 0, of_connectivity = 0;
    auto type = CGNS_ENUMV(PointSetTypeNull);
    cgsize_t n_points = 0;
    in.check(cg_subreg_info(in.file, in.base, zone.number, s, name.data(), &dimension, &region.location, &type,
                            &n_points, &of_condition, &of_connectivity),
             "a region");
    region.name = name.data();
    if (type == CGNS_ENUMV(PointSetTypeNull) || zone.structured) {
      in.notes.push_back("region " + shown(region.name) + " is left out: " +
                         (zone.structured ? "its zone is structured" : "it has no points of its own"));
      continue;
    }
    region.points.resize(static_cast<std::size_t>(in.count(n_points, "points of a region")));
    if (!region.points.empty())
      in.check(cg_subreg_ptset_read(in.file, in.base, zone.number, s, region.points.data()), "a region");
    region.points = members(in, zone, "region " + shown(region.name), type, std::move(region.points), region.range);
    region.label = {"", -1, region.name};
    if (cg_goto(in.file, in.base, "Zone_t", zone.number, "ZoneSubRegion_t", s, "end") == CG_OK) {
      region.label = label_here(region.name);
      if (const std::string family(without_base(family_here())); !family.empty() && region.label.kind.empty())
        region.label.name = family;
    }
    result.push_back(std::move(region));
  }
  return result;
}

std::vector<CgnsRegion> cgns_conditions(CgnsPlace& in, const CgnsZone& zone) {
  std::vector<CgnsRegion> result;
  int n = 0;
  if (cg_nbocos(in.file, in.base, zone.number, &n) != CG_OK) return result;
  for (int c = 1; c <= n; ++c) {
    CgnsRegion condition;
    CgnsName name{};
    auto kind = CGNS_ENUMV(BCTypeNull);
    auto type = CGNS_ENUMV(PointSetTypeNull);
    auto normals = CGNS_ENUMV(DataTypeNull);
    cgsize_t n_points = 0, n_normals = 0;
    std::array<int, 3> normal{};
    int n_sets = 0;
    in.check(cg_boco_info(in.file, in.base, zone.number, c, name.data(), &kind, &type, &n_points, normal.data(),
                          &n_normals, &normals, &n_sets),
             "a boundary condition");
    condition.name = name.data();
    const std::string what = "boundary condition " + shown(condition.name);
    in.check(cg_boco_gridlocation_read(in.file, in.base, zone.number, c, &condition.location), what);
    if (type == CGNS_ENUMV(ElementRange) || type == CGNS_ENUMV(ElementList))
      condition.location = CGNS_ENUMV(FaceCenter);
    const std::size_t width = zone.structured ? 3 : 1;
    condition.points.resize(width * static_cast<std::size_t>(in.count(n_points, "points of a boundary condition")));
    std::vector<double> normal_list(static_cast<std::size_t>(in.count(n_normals, "normals")));
    if (!condition.points.empty())
      in.check(cg_boco_read(in.file, in.base, zone.number, c, condition.points.data(),
                            normal_list.empty() ? nullptr : normal_list.data()),
               what);
    condition.points = members(in, zone, what, type, std::move(condition.points), condition.range);
    if (n_sets > 0) in.notes.push_back(what + ": its data are left out");
    condition.label = {"", -1, condition.name};
    if (kind != CGNS_ENUMV(BCTypeNull) && kind != CGNS_ENUMV(BCTypeUserDefined)) condition.type = cg_BCTypeName(kind);
    if (cg_goto(in.file, in.base, "Zone_t", zone.number, "ZoneBC_t", 1, "BC_t", c, "end") == CG_OK) {
      condition.label = label_here(condition.name);
      const std::string family(without_base(family_here()));
      if (!family.empty() && condition.label.kind.empty()) condition.label.name = family;
      if (kind == CGNS_ENUMV(FamilySpecified)) {
        condition.type.clear();
        int n_families = 0;
        if (cg_nfamilies(in.file, in.base, &n_families) != CG_OK) n_families = 0;
        for (int f = 1; f <= n_families; ++f) {
          CgnsName of{}, of_condition{};
          int n_conditions = 0, n_geometries = 0;
          in.check(cg_family_read(in.file, in.base, f, of.data(), &n_conditions, &n_geometries), "a family");
          if (family != of.data() || n_conditions < 1) continue;
          in.check(cg_fambc_read(in.file, in.base, f, 1, of_condition.data(), &kind), "a family");
          if (kind != CGNS_ENUMV(BCTypeNull) && kind != CGNS_ENUMV(BCTypeUserDefined))
            condition.type = cg_BCTypeName(kind);
        }
      }
    }
    result.push_back(std::move(condition));
  }
  return result;
}

bool cgns_sides(const CgnsPlace& in, const CgnsZone& zone, CgnsRegion& condition, const std::string& what,
                std::vector<std::pair<std::int64_t, int>>& sides) {
  const auto& points = condition.points;
  const bool vertex = condition.location == CGNS_ENUMV(Vertex);
  int axis = condition.location == CGNS_ENUMV(IFaceCenter)   ? 0
             : condition.location == CGNS_ENUMV(JFaceCenter) ? 1
             : condition.location == CGNS_ENUMV(KFaceCenter) ? 2
                                                             : -1;
  const auto inside = [&](std::size_t at) {
    for (std::size_t d = 0; d < 3; ++d)
      if (points[at + d] < 1 || points[at + d] > zone.nodes[d]) in.fail(what + " names a point that is not there");
  };
  for (std::size_t at = 0; at + 3 <= points.size(); at += 3) inside(at);
  Triple low{}, high{};
  if (condition.range) {
    if (points.size() != 6) in.fail(what + " has an impossible range");
    for (std::size_t d = 0; d < 3; ++d) {
      low[d] = std::min(points[d], points[d + 3]) - 1;
      high[d] = std::max(points[d], points[d + 3]) - 1;
      if (axis < 0 && low[d] == high[d] &&
          std::ranges::count_if(std::array{0, 1, 2}, [&](int o) { return points[o] == points[o + 3]; }) == 1)
        axis = static_cast<int>(d);
    }
  }
  if (axis < 0 && !vertex) in.fail(what + " has faces of no direction");
  if (axis < 0 || (vertex && !condition.range)) {
    std::vector<cgsize_t> nodes;
    if (condition.range) {
      for (std::int64_t k = low[2]; k <= high[2]; ++k)
        for (std::int64_t j = low[1]; j <= high[1]; ++j)
          for (std::int64_t i = low[0]; i <= high[0]; ++i)
            nodes.push_back(static_cast<cgsize_t>(zone.node_at({i, j, k}) + 1));
    } else {
      for (std::size_t at = 0; at + 3 <= points.size(); at += 3)
        nodes.push_back(
            static_cast<cgsize_t>(zone.node_at({points[at] - 1, points[at + 1] - 1, points[at + 2] - 1}) + 1));
    }
    condition.points = std::move(nodes);
    return false;
  }
  const auto side = [&](Triple at) {
    const auto a = static_cast<std::size_t>(axis);
    int face = 2 * axis;
    if (at[a] == zone.cells[a]) --at[a], ++face;
    for (std::size_t d = 0; d < 3; ++d)
      if (at[d] >= zone.cells[d]) in.fail(what + " names a face that is not there");
    const auto cell = at[0] + zone.cells[0] * (at[1] + zone.cells[1] * at[2]);
    sides.emplace_back(zone.hex_ids[static_cast<std::size_t>(cell)], face);
  };
  if (!condition.range) {
    for (std::size_t at = 0; at + 3 <= points.size(); at += 3)
      side({points[at] - 1, points[at + 1] - 1, points[at + 2] - 1});
    return true;
  }
  // Nodes go one farther than faces.
  if (vertex)
    for (std::size_t d = 0; d < 3; ++d)
      if (static_cast<int>(d) != axis) --high[d];
  for (std::int64_t k = low[2]; k <= high[2]; ++k)
    for (std::int64_t j = low[1]; j <= high[1]; ++j)
      for (std::int64_t i = low[0]; i <= high[0]; ++i) side({i, j, k});
  return true;
}

std::vector<CgnsValues> cgns_solutions(CgnsPlace& in, const CgnsZone& zone) {
  std::vector<CgnsValues> result;
  int n = 0;
  if (cg_nsols(in.file, in.base, zone.number, &n) != CG_OK) return result;
  std::array<int, 2> n_of{};
  for (int s = 1; s <= n; ++s) {
    CgnsName name{};
    auto location = CGNS_ENUMV(Vertex);
    in.check(cg_sol_info(in.file, in.base, zone.number, s, name.data(), &location), "a solution");
    const bool node = location == CGNS_ENUMV(Vertex);
    if (!node && location != CGNS_ENUMV(CellCenter)) {
      in.notes.push_back("solution " + shown(name.data()) + " is neither of nodes nor of cells: left out");
      continue;
    }
    auto points = CGNS_ENUMV(PointSetTypeNull);
    cgsize_t n_points = 0;
    if (cg_sol_ptset_info(in.file, in.base, zone.number, s, &points, &n_points) == CG_OK &&
        points != CGNS_ENUMV(PointSetTypeNull)) {
      in.notes.push_back("solution " + shown(name.data()) + " is of a part of its zone: left out");
      continue;
    }
    if (++n_of[node] == 2)
      in.notes.push_back("zone " + shown(zone.name) + " has several solutions of " + (node ? "nodes" : "cells") +
                         ": of fields of one name the last is read");
    std::array<cgsize_t, 3> last = {static_cast<cgsize_t>(node ? zone.n_nodes : zone.n_cells), 1, 1};
    if (zone.structured)
      for (std::size_t d = 0; d < 3; ++d) last[d] = static_cast<cgsize_t>(node ? zone.nodes[d] : zone.cells[d]);
    int n_fields = 0;
    in.check(cg_nfields(in.file, in.base, zone.number, s, &n_fields), "a solution");
    for (int f = 1; f <= n_fields; ++f) {
      CgnsValues values;
      values.on = node ? Field::On::node : Field::On::hex;
      CgnsName of{};
      auto type = CGNS_ENUMV(DataTypeNull);
      in.check(cg_field_info(in.file, in.base, zone.number, s, f, &type, of.data()), "a field");
      values.name = of.data();
      values.integer = type == CGNS_ENUMV(Integer) || type == CGNS_ENUMV(LongInteger);
      values.values.resize(static_cast<std::size_t>(node ? zone.n_nodes : zone.n_cells));
      const std::array<cgsize_t, 3> first = {1, 1, 1};
      in.check(cg_field_read(in.file, in.base, zone.number, s, of.data(), CGNS_ENUMV(RealDouble), first.data(),
                             last.data(), values.values.data()),
               "field " + shown(values.name));
      if (type == CGNS_ENUMV(LongInteger)) {
        std::vector<long> numbers(values.values.size());
        in.check(
            cg_field_read(in.file, in.base, zone.number, s, of.data(), type, first.data(), last.data(), numbers.data()),
            "field " + shown(values.name));
        say_rounded(values.name, std::ranges::count_if(numbers, [](long x) { return !is_exact_double(x); }), in.notes);
      }
      const auto same = std::ranges::find_if(
          result, [&](const CgnsValues& other) { return other.name == values.name && other.on == values.on; });
      if (same != result.end())
        *same = std::move(values);
      else
        result.push_back(std::move(values));
    }
  }
  return result;
}

}  // namespace hextwist::io
