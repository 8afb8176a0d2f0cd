#include "meshes.h"

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>
#include <cmath>
#include <cstring>
#include <numbers>

#include "hextwist/geom/occ/model.h"
#include "hextwist/io/io.h"
#include "hextwist/mesh/primitives.h"

namespace hextwist::bench {

Mesh cube(int n) {
  const double side = n;
  return mesh_brick({side, side, side}, {n, n, n});
}

MeshedModel cube_on_brick(int n) {
  const double side = n;
  MeshedModel result{cube(n), cad_brick({side, side, side}).model, {}};
  result.association = associate(result.mesh, *result.model).association;
  return result;
}

Index middle_hex(int n) {
  return n / 2 + n * (n / 2 + n * (n / 2));
}

std::vector<std::uint8_t> mark_all(const Mesh& mesh) {
  return std::vector<std::uint8_t>(mesh.points.size(), 1);
}

std::vector<std::uint8_t> mark_one(const Mesh& mesh) {
  std::vector<std::uint8_t> marked(mesh.points.size(), 0);
  for (const Index node : mesh.hexes[mesh.hexes.size() / 2]) marked[node] = 1;
  return marked;
}

std::vector<std::uint8_t> mark_ball(const Mesh& mesh, int n) {
  const double radius = n * std::cbrt(0.1 * 3 / (4 * std::numbers::pi));
  std::vector<std::uint8_t> marked(mesh.points.size(), 0);
  for (std::size_t i = 0; i < marked.size(); ++i) marked[i] = mesh.points[i].norm() < radius;
  return marked;
}

MeshedModel shipped(const char* name, int pieces) {
  const std::filesystem::path folder = std::filesystem::path(HEXTWIST_SOURCE_DIR) / "models";
  MeshedModel coarse;
  coarse.model = read_cad(folder / (std::string(name) + ".brep")).model;
  MeshFile file = read_mesh(folder / (std::string(name) + ".msh"));
  coarse.mesh = std::move(file.mesh);
  coarse.association = associate(coarse.mesh, *coarse.model, &file.tags).association;
  Request request;
  request.target.kind = EntityKind::volume;
  for (int id = 1; id <= coarse.model->count(3); ++id) request.target.ids.push_back(id);
  request.how = Cuts{pieces - 1};
  return refine(coarse, request).refined;
}

MeshedModel glued_bricks(int n) {
  const double side = n / 2;
  TopoDS_Compound bricks;
  BRep_Builder builder;
  builder.MakeCompound(bricks);
  for (int i = 0; i < 8; ++i) {
    const gp_Pnt corner((i & 1) - 1.0, (i >> 1 & 1) - 1.0, (i >> 2 & 1) - 1.0);
    const gp_Pnt scaled(corner.X() * side, corner.Y() * side, corner.Z() * side);
    builder.Add(bricks, BRepPrimAPI_MakeBox(scaled, side, side, side).Shape());
  }
  CadOptions options;
  options.glue = true;
  MeshedModel result{cube(n), cad_from_shape(bricks, options).model, {}};
  result.association = associate(result.mesh, *result.model).association;
  return result;
}

MeshedModel layered_bricks(int n) {
  const double side = n;
  const gp_Pnt low(-side / 2, -side / 2, -side / 2), above(1 - side / 2, -side / 2, -side / 2);
  TopoDS_Compound bricks;
  BRep_Builder builder;
  builder.MakeCompound(bricks);
  builder.Add(bricks, BRepPrimAPI_MakeBox(low, 1, side, side).Shape());
  builder.Add(bricks, BRepPrimAPI_MakeBox(above, side - 1, side, side).Shape());
  CadOptions options;
  options.glue = true;
  MeshedModel result{cube(n), cad_from_shape(bricks, options).model, {}};
  result.association = associate(result.mesh, *result.model).association;
  return result;
}

namespace {
template <class T>
std::size_t size_of(const std::vector<T>& list) {
  return list.size() * sizeof(T);
}
}  // namespace

std::size_t bytes(const Mesh& mesh) {
  std::size_t sum = size_of(mesh.points) + size_of(mesh.hexes) + size_of(mesh.node_ids) + size_of(mesh.hex_ids);
  for (const Block& block : mesh.blocks) sum += size_of(block.hexes);
  for (const NodeSet& set : mesh.node_sets) sum += size_of(set.nodes);
  for (const SideSet& set : mesh.side_sets) sum += size_of(set.sides);
  for (const Field& field : mesh.fields) sum += size_of(field.values);
  return sum;
}

std::size_t bytes(const Association& a) {
  return size_of(a.node_owner) + size_of(a.node_parameters) + size_of(a.curve_edges) + size_of(a.edge_curve) +
         size_of(a.surface_faces) + size_of(a.face_surface) + size_of(a.hex_volume);
}

std::uint64_t fingerprint(const Mesh& mesh) {
  std::uint64_t hash = 14695981039346656037u;
  const auto add = [&](const void* data, std::size_t n) {
    for (std::size_t i = 0; i + 8 <= n; i += 8) {
      std::uint64_t word;
      std::memcpy(&word, static_cast<const char*>(data) + i, 8);
      hash = (hash ^ word) * 1099511628211u;
      hash ^= hash >> 29;
    }
  };
  add(mesh.points.data(), size_of(mesh.points));
  add(mesh.hexes.data(), size_of(mesh.hexes));
  return hash;
}

std::filesystem::path data_file(const char* name) {
  const std::filesystem::path file = std::filesystem::path(HEXTWIST_BENCH_DATA) / name;
  return std::filesystem::exists(file) ? file : std::filesystem::path{};
}

std::filesystem::path output_file(const char* name) {
  return std::filesystem::path(HEXTWIST_BENCH_OUTPUT) / name;
}

}  // namespace hextwist::bench
