#include "io/io_support.h"

#include <algorithm>
#include <optional>

#include "hextwist/io/slice.h"
#include "hextwist/mesh/topology.h"

namespace hextwist::test {

Association brick_association(const Mesh& mesh, const Vec3& size) {
  // Two bricks that meet at x = 2: planes x = 0, 2, size, y = 0, size, z = 0, size. Rounded points decide.
  const auto planes = [&](const Vec3& p) {
    std::vector<int> result;
    const Vec3 r = p.array().round();
    if (r.x() == 0) result.push_back(1);
    if (r.x() == 2) result.push_back(2);
    if (r.x() == size.x()) result.push_back(3);
    if (r.y() == 0) result.push_back(4);
    if (r.y() == size.y()) result.push_back(5);
    if (r.z() == 0) result.push_back(6);
    if (r.z() == size.z()) result.push_back(7);
    return result;
  };
  const auto rounded = [&](Index n) -> Vec3 { return mesh.points[n].array().round(); };
  const auto right = [](const Vec3& p) { return p.x() > 2; };
  const auto common = [&](std::initializer_list<Index> nodes) {
    std::vector<int> result = planes(mesh.points[*nodes.begin()]);
    for (const Index n : nodes) {
      std::vector<int> both;
      std::ranges::set_intersection(result, planes(mesh.points[n]), std::back_inserter(both));
      result = both;
    }
    return result;
  };
  Association a;
  a.node_parameters.resize(mesh.points.size());
  for (const Vec3& p : mesh.points) {
    const auto at = planes(p);
    const int half = right(p.array().round()) ? 20 : 0;  // the planes along x are two surfaces each
    int id = half;
    for (const int plane : at) id = 8 * id + plane;
    a.node_owner.push_back({3 - static_cast<int>(at.size()), at.empty() ? 1 + (half > 0) : 1 + id});
  }
  for (Index h = 0; h < mesh.n_hexes(); ++h) {
    Vec3 centre = Vec3::Zero();
    for (const Index n : mesh.hexes[h]) centre += mesh.points[n] / 8;
    a.hex_volume.push_back(1 + right(centre));
  }
  const Edges mesh_edges = edges(mesh);
  for (const Edge& edge : mesh_edges.nodes) {
    const auto at = common({edge[0], edge[1]});
    if (at.size() < 2) continue;
    a.curve_edges.push_back(edge);
    const int half = right((rounded(edge[0]) + rounded(edge[1])) / 2) ? 20 : 0;
    a.edge_curve.push_back(1 + 64 * half + 8 * at[0] + at[1]);
  }
  const Faces mesh_faces = faces(mesh);
  std::vector<std::pair<Side, int>> sides;
  for (std::size_t f = 0; f < mesh_faces.nodes.size(); ++f) {
    const Quad& q = mesh_faces.nodes[f];
    const auto at = common({q[0], q[1], q[2], q[3]});
    if (at.empty()) continue;
    const int half = right((rounded(q[0]) + rounded(q[3])) / 2) ? 20 : 0;
    sides.emplace_back(mesh_faces.sides[f][0], 1 + 8 * half + at[0]);
  }
  std::ranges::sort(sides);
  for (const auto& [side, id] : sides) {
    a.surface_faces.push_back(side);
    a.face_surface.push_back(id);
  }
  // Inner nodes of curves and surfaces have the ids of those.
  for (std::size_t i = 0; i < a.curve_edges.size(); ++i)
    for (const Index n : a.curve_edges[i])
      if (a.node_owner[n].dim == 1) a.node_owner[n].id = a.edge_curve[i];
  for (std::size_t i = 0; i < a.surface_faces.size(); ++i)
    for (const Index n : face_nodes(mesh.hexes[a.surface_faces[i].hex], a.surface_faces[i].face))
      if (a.node_owner[n].dim == 2) a.node_owner[n].id = a.face_surface[i];
  return a;
}

void read_or_refuse(const std::filesystem::path& file) {
  const auto check = [&](const auto& read) {
    try {
      const Mesh mesh = read();
      EXPECT_TRUE(sets_valid(mesh));
      for (const Hex& hex : mesh.hexes)
        for (const Index n : hex) EXPECT_TRUE(n >= 0 && n < mesh.n_nodes());
      for (const Vec3& p : mesh.points) EXPECT_TRUE(p.allFinite());
      return mesh.n_hexes();
    } catch (const Error& error) {
      const std::string what = error.what();
      EXPECT_TRUE(what.starts_with(file.string())) << what;
      EXPECT_EQ(what.find('\n'), std::string::npos) << what;
      return Index{-1};
    }
  };
  const Index n_whole = check([&] { return read_mesh(file).mesh; });
  std::optional<SlicedFile> sliced;
  check([&] {
    sliced = in_slices(file);
    return Mesh();
  });
  if (!sliced) return;
  Index n_hexes = 0;
  for (int s = 0; s < 2; ++s)
    if (const Index n = check([&] { return read_slice(*sliced, s, 2).file.mesh; }); n >= 0 && n_hexes >= 0)
      n_hexes += n;
    else
      n_hexes = -1;
  if (n_whole >= 0) {
    EXPECT_EQ(n_hexes, n_whole);
  }
}

bool vtk_python(const std::filesystem::path& folder, const std::string& script) {
  constexpr const char* head = R"(
import vtk
def write_all_ways(grid, name):
    for mode in ('Ascii', 'Binary', 'Appended'):
        for compressor in (None, vtk.vtkZLibDataCompressor()):
            for header in (32, 64):
                for encode in (0, 1):
                    for order in (0, 1):
                        writer = vtk.vtkXMLUnstructuredGridWriter()
                        writer.SetInputData(grid)
                        getattr(writer, 'SetDataModeTo' + mode)()
                        writer.SetCompressor(compressor)
                        if compressor: writer.SetBlockSize(1024)
                        writer.SetHeaderType(header)
                        writer.SetEncodeAppendedData(encode)
                        writer.SetByteOrder(order)
                        writer.SetFileName('%s%s_%d_%d_%d_%d.vtu' % (name, mode, bool(compressor), header, encode, order))
                        assert writer.Write()
)";
  const auto file = write_text(folder / "script.py", head + script);
  if (std::system("/usr/bin/python3 -c 'import vtk' > /dev/null 2>&1") != 0) return false;
  EXPECT_EQ(std::system(("/usr/bin/python3 " + file.string()).c_str()), 0) << script;
  return true;
}

}  // namespace hextwist::test
