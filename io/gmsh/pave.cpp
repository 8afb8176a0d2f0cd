#include "hextwist/io/gmsh/pave.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>
#include <typeinfo>

#include "hextwist/base/fenced.h"

namespace hextwist {
namespace {

using Flat = Eigen::Vector2d;

/// Settings of Gmsh, the best first. The algorithm made for quads (8) crashes in Debian's 4.8.
struct Way {
  int algorithm;      ///< 6: frontal, 5: Delaunay
  int recombination;  ///< of triangles in pairs: 1 Blossom, 0 simple, -1 none
};
constexpr std::array<Way, 4> ways = {{{6, 1}, {5, 1}, {6, 0}, {6, -1}}};

/// Each side of the polygons is a line of one element, so that its ends are the only nodes on it.
std::string script(const std::vector<std::vector<Flat>>& polygons, double size, const Way& way) {
  std::ostringstream out;
  out.precision(17);
  out << "Mesh.Algorithm = " << way.algorithm << "; Mesh.RecombineAll = " << (way.recombination < 0 ? 0 : 1)
      << "; Mesh.RecombinationAlgorithm = " << std::max(way.recombination, 0)
      << "; Mesh.MshFileVersion = 2.2;\n"
         "Mesh.Binary = 0; Mesh.SaveAll = 1; General.NumThreads = 1; Mesh.CharacteristicLengthExtendFromBoundary = 1;\n"
         "Mesh.CharacteristicLengthMax = "
      << size << ";\n";
  std::size_t n = 0;
  std::string loops;
  for (std::size_t k = 0; k < polygons.size(); ++k) {
    const auto& polygon = polygons[k];
    std::string lines;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      out << "Point(" << n + i + 1 << ") = {" << polygon[i].x() << ", " << polygon[i].y() << ", 0, " << size << "};\n";
      lines += (i ? ", " : "") + std::to_string(n + i + 1);
    }
    for (std::size_t i = 0; i < polygon.size(); ++i)
      out << "Line(" << n + i + 1 << ") = {" << n + i + 1 << ", " << n + (i + 1) % polygon.size() + 1
          << "}; Transfinite Curve{" << n + i + 1 << "} = 2;\n";
    out << "Curve Loop(" << k + 1 << ") = {" << lines << "};\n";
    loops += (k ? ", " : "") + std::to_string(k + 1);
    n += polygon.size();
  }
  out << "Plane Surface(1) = {" << loops << "};\n";
  return out.str();
}

FlatMesh what_gmsh_left(std::istream& in, std::size_t n_given) {
  const auto broken = [] { return Error("gmsh has not left a mesh"); };
  const auto section = [&](const std::string& name) {
    for (std::string line; std::getline(in, line);)
      if (line == name) return;
    throw broken();
  };
  FlatMesh mesh;
  section("$Nodes");
  std::size_t n = 0;
  if (!(in >> n) || n > 100000000) throw broken();
  std::vector<Index> position;  // by Gmsh's number
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t tag = 0;
    double x = 0, y = 0, z = 0;
    if (!(in >> tag >> x >> y >> z) || tag == 0 || tag > 10 * n + 10) throw broken();
    if (position.size() <= tag) position.resize(tag + 1, -1);
    position[tag] = static_cast<Index>(i);
    mesh.points.emplace_back(x, y);
    // The first nodes are those of the points, which were numbered from 1.
    if (i < n_given && tag != i + 1) throw broken();
  }
  section("$Elements");
  if (!(in >> n)) throw broken();
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t tag = 0;
    int type = 0, n_tags = 0;
    if (!(in >> tag >> type >> n_tags)) throw broken();
    for (int k = 0, skipped = 0; k < n_tags; ++k) in >> skipped;
    const int n_nodes = type == 15 ? 1 : type == 1 ? 2 : type == 2 ? 3 : type == 3 ? 4 : 0;
    if (n_nodes == 0) throw broken();
    std::array<Index, 4> element{-1, -1, -1, -1};
    for (int k = 0; k < n_nodes; ++k) {
      std::size_t node = 0;
      if (!(in >> node) || node >= position.size() || position[node] < 0) throw broken();
      element[k] = position[node];
    }
    if (n_nodes >= 3) mesh.elements.push_back(element);
  }
  if (mesh.points.size() < n_given || mesh.elements.empty()) throw broken();
  return mesh;
}

double worst_corner(const FlatMesh& mesh, const std::array<Index, 4>& element) {
  const int n = element[3] < 0 ? 3 : 4;
  double worst = 1;
  for (int k = 0; k < n; ++k)
    worst = std::min(worst, corner_sine(mesh.points[element[(k + n - 1) % n]], mesh.points[element[k]],
                                        mesh.points[element[(k + 1) % n]]));
  return worst;
}

/// All elements turn alike; quads with a corner that is flat or turns back become two triangles. False where that does
/// not help: Blossom now and then leaves a triangle outside of the polygons, and a quad over it.
bool mended(FlatMesh& mesh) {
  constexpr double flat = 0.2;
  double area = 0;
  for (const auto& element : mesh.elements)
    for (int k = 0, n = element[3] < 0 ? 3 : 4; k < n; ++k) {
      const Flat &a = mesh.points[element[k]], &b = mesh.points[element[(k + 1) % n]];
      area += a.x() * b.y() - a.y() * b.x();
    }
  std::vector<std::array<Index, 4>> elements;
  for (std::array<Index, 4> element : mesh.elements) {
    if (area < 0) std::swap(element[1], element[element[3] < 0 ? 2 : 3]);
    if (element[3] < 0 || worst_corner(mesh, element) > flat) {
      elements.push_back(element);
      continue;
    }
    const auto [a, b, c, d] = element;
    const std::array<std::array<std::array<Index, 4>, 2>, 2> halves = {
        {{{{a, b, c, -1}, {a, c, d, -1}}}, {{{a, b, d, -1}, {b, c, d, -1}}}}};
    const auto worst = [&](const auto& pair) {
      return std::min(worst_corner(mesh, pair[0]), worst_corner(mesh, pair[1]));
    };
    const auto& better = halves[worst(halves[0]) >= worst(halves[1]) ? 0 : 1];
    elements.insert(elements.end(), better.begin(), better.end());
  }
  mesh.elements = std::move(elements);
  return std::ranges::all_of(mesh.elements, [&](const auto& element) { return worst_corner(mesh, element) > 0; });
}

}  // namespace

std::filesystem::path find_gmsh() {
  return find_program("gmsh");
}

QuadMesher paver_by_gmsh(std::filesystem::path program) {
  if (program.empty()) return {};
  return [program = std::move(program)](const std::vector<std::vector<Flat>>& polygons, double size) {
    std::size_t n = 0;
    for (const auto& polygon : polygons) n += polygon.size();
    constexpr double seconds = 600, megabytes = 8000;
    std::string wrong;
    for (const Way& way : ways) {
      const Handover in, out;
      std::ofstream(in.path()) << script(polygons, size, way);
      try {
        run_within(seconds, megabytes, program,
                   {"-2", "-v", "0", "-nopopup", "-format", "msh22", "-o", "{out}", "{in}"}, in, out);
        std::ifstream result(out.path());
        FlatMesh mesh = what_gmsh_left(result, n);
        if (mended(mesh)) return mesh;
        wrong = "gmsh has left elements that overlap";
      } catch (const Error& error) {
        if (typeid(error) != typeid(Error)) throw;  // the user stopped it
        wrong = error.what();
      }
    }
    throw Error(wrong);
  };
}

}  // namespace hextwist
