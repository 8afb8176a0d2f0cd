#include "hextwist/mesh/primitives.h"

#include <cmath>
#include <numbers>
#include <numeric>

#include "hextwist/mesh/corners.h"

namespace hextwist {
namespace {

// The core: its radius at the corners as a part of the whole, and how far its sides bulge from straight (0) to the
// circle or sphere (1). The bulge opens the corners of the core, where hexes of three blocks meet: without it the
// smallest scaled Jacobian is 0.707 and 0.577; more than this closes the cells beside the corners of fine meshes.
constexpr double disc_core = 0.5, disc_bulge = 0.37;
constexpr double ball_core = 0.6, ball_bulge = 0.42;

void check_interval(const char* shape, const char* what, int interval) {
  if (interval < 1)
    throw Error(std::string("interval ") + what + " of a " + shape + " must be positive, not " +
                std::to_string(interval));
}

/// n_hexes as a double, since the product of intervals may exceed any integer.
void check_count(const char* shape, double n_hexes) {
  constexpr double most = 1e8;
  if (n_hexes <= most) return;
  const std::string made = n_hexes < 1e15 ? std::to_string(std::llround(n_hexes)) : "more than 10^15";
  throw Error(std::string("these intervals would make a ") + shape + " of " + made +
              " hexes; at most 100000000 are made");
}

void add_block(Mesh& mesh, const char* name) {
  Block block{1, name, std::vector<Index>(mesh.hexes.size())};
  std::iota(block.hexes.begin(), block.hexes.end(), 0);
  mesh.blocks.push_back(std::move(block));
}

/// -1 .. 1 in n steps, exactly symmetric.
double level(int i, int n) {
  return (2.0 * i - n) / n;
}

/// Moves the lines of a square or cube so that they meet its circle or ball at equal angles.
double even_angle(double t) {
  return std::numbers::sqrt2 * std::sin(std::numbers::pi / 4 * t);
}

/// The square [-1,1]^2 onto the unit disc, its rim onto the circle.
Eigen::Vector2d disc(double x, double y) {
  x = even_angle(x);
  y = even_angle(y);
  return {x * std::sqrt(1 - y * y / 2), y * std::sqrt(1 - x * x / 2)};
}

/// The cube [-1,1]^3 onto the unit ball, its skin onto the sphere.
Vec3 ball(const Vec3& p) {
  const double x = even_angle(p.x()), y = even_angle(p.y()), z = even_angle(p.z());
  const auto shrink = [](double a, double b) { return std::sqrt(1 - a * a / 2 - b * b / 2 + a * a * b * b / 3); };
  return {x * shrink(y, z), y * shrink(z, x), z * shrink(x, y)};
}

}  // namespace

BrickIntervals brick_intervals(int n) {
  return {n, n, n};
}
CylinderIntervals cylinder_intervals(int n) {
  return {n, n / 2 + n % 2, n};
}
SphereIntervals sphere_intervals(int n) {
  return {n, n};
}

Mesh mesh_brick(const BrickShape& shape, const BrickIntervals& intervals) {
  check_shape(shape);
  const auto [a, b, c] = intervals;
  check_interval("brick", "width", a);
  check_interval("brick", "depth", b);
  check_interval("brick", "height", c);
  check_count("brick", double{1} * a * b * c);
  Mesh mesh;
  mesh.points.reserve(static_cast<std::size_t>(a + 1) * (b + 1) * (c + 1));
  mesh.hexes.reserve(static_cast<std::size_t>(a) * b * c);
  for (int k = 0; k <= c; ++k)
    for (int j = 0; j <= b; ++j)
      for (int i = 0; i <= a; ++i)
        mesh.points.emplace_back(shape.width / 2 * level(i, a), shape.depth / 2 * level(j, b),
                                 shape.height / 2 * level(k, c));
  const auto node = [&](int i, int j, int k) { return i + (a + 1) * (j + (b + 1) * k); };
  for (int k = 0; k < c; ++k)
    for (int j = 0; j < b; ++j)
      for (int i = 0; i < a; ++i) {
        Hex& hex = mesh.hexes.emplace_back();
        for (int corner = 0; corner < 8; ++corner)
          hex[corner] = node(i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2));
      }
  add_block(mesh, "brick");
  return mesh;
}

Mesh mesh_cylinder(const CylinderShape& shape, const CylinderIntervals& intervals) {
  check_shape(shape);
  const auto [n, m, layers] = intervals;
  check_interval("cylinder", "quarter", n);
  check_interval("cylinder", "ring", m);
  check_interval("cylinder", "height", layers);
  check_count("cylinder", (double{1} * n * n + 4.0 * n * m) * layers);

  // One level: the core row by row, then the rings from inside out. Rim position k = 0 .. 4n - 1 runs
  // counter-clockwise from the corner (n, 0) of the core.
  const int n_core = (n + 1) * (n + 1), n_level = n_core + 4 * n * m;
  const auto rim = [&](int k) -> std::array<int, 2> {
    const int along = k % n;
    switch (k / n % 4) {
      case 0:
        return {n, along};
      case 1:
        return {n - along, n};
      case 2:
        return {0, n - along};
      default:
        return {along, 0};
    }
  };
  // Points of the unit disc, turned by 45 degrees: the corner (n, 0) comes to angle 270, (n, n) to 0.
  const auto turned = [](const Eigen::Vector2d& p) {
    return Eigen::Vector2d((p.x() + p.y()) / std::numbers::sqrt2, (p.y() - p.x()) / std::numbers::sqrt2);
  };
  const auto core_point = [&](int i, int j) {
    const double x = level(i, n), y = level(j, n);
    const Eigen::Vector2d straight(x / std::numbers::sqrt2, y / std::numbers::sqrt2);
    return turned(disc_core * ((1 - disc_bulge) * straight + disc_bulge * disc(x, y)));
  };
  std::vector<Eigen::Vector2d> flat;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) flat.push_back(core_point(i, j));
  for (int r = 1; r <= m; ++r)
    for (int k = 0; k < 4 * n; ++k) {
      const auto [i, j] = rim(k);
      const Eigen::Vector2d outside = turned(disc(level(i, n), level(j, n))).normalized();
      const double out = r / static_cast<double>(m);
      flat.push_back(out < 1 ? Eigen::Vector2d((1 - out) * core_point(i, j) + out * outside) : outside);
    }

  Mesh mesh;
  mesh.points.reserve(static_cast<std::size_t>(n_level) * (layers + 1));
  mesh.hexes.reserve(static_cast<std::size_t>(n * n + 4 * n * m) * layers);
  for (int z = 0; z <= layers; ++z)
    for (const auto& p : flat)
      mesh.points.emplace_back(shape.radius * p.x(), shape.radius * p.y(), shape.height / 2 * level(z, layers));
  const auto ring_node = [&](int r, int k) {
    if (r > 0) return n_core + (r - 1) * 4 * n + k % (4 * n);
    const auto [i, j] = rim(k);
    return i + (n + 1) * j;
  };
  for (int z = 0; z < layers; ++z) {
    const auto add = [&](const std::array<Index, 4>& below) {
      Hex& hex = mesh.hexes.emplace_back();
      for (int corner = 0; corner < 8; ++corner) hex[corner] = below[corner & 3] + (z + (corner >> 2)) * n_level;
    };
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const int corner = i + (n + 1) * j;
        add({corner, corner + 1, corner + n + 1, corner + n + 2});
      }
    for (int r = 0; r < m; ++r)
      for (int k = 0; k < 4 * n; ++k)
        add({ring_node(r, k), ring_node(r + 1, k), ring_node(r, k + 1), ring_node(r + 1, k + 1)});
  }
  add_block(mesh, "cylinder");
  return mesh;
}

Mesh mesh_sphere(const SphereShape& shape, const SphereIntervals& intervals) {
  check_shape(shape);
  const int m = intervals.shell;
  check_interval("sphere", "eighth", intervals.eighth);
  check_interval("sphere", "shell", m);
  const double side = 2.0 * intervals.eighth;
  check_count("sphere", side * side * side + 6 * side * side * m);
  const int n = 2 * intervals.eighth;

  // The core as a grid, then the shells from inside out, each a copy of the skin of that grid.
  const int n_core = (n + 1) * (n + 1) * (n + 1);
  const auto core_node = [&](const std::array<int, 3>& at) { return at[0] + (n + 1) * (at[1] + (n + 1) * at[2]); };
  Mesh mesh;
  std::vector<Index> skin_of(n_core, -1);
  std::vector<Vec3> inside, outside;
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        const Vec3 cube(level(i, n), level(j, n), level(k, n)), round = ball(cube);
        mesh.points.push_back(shape.radius * ball_core *
                              ((1 - ball_bulge) / std::numbers::sqrt3 * cube + ball_bulge * round));
        if (cube.cwiseAbs().maxCoeff() < 1) continue;
        skin_of[core_node({i, j, k})] = static_cast<Index>(inside.size());
        inside.push_back(mesh.points.back());
        outside.push_back(shape.radius * round.normalized());
      }
  const auto n_skin = static_cast<Index>(inside.size());
  for (int r = 1; r <= m; ++r)
    for (Index s = 0; s < n_skin; ++s) {
      const double out = r / static_cast<double>(m);
      mesh.points.push_back(out < 1 ? Vec3((1 - out) * inside[s] + out * outside[s]) : outside[s]);
    }

  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        Hex& hex = mesh.hexes.emplace_back();
        for (int c = 0; c < 8; ++c) hex[c] = core_node({i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)});
      }
  const auto shell_node = [&](int r, Index node) { return r == 0 ? node : n_core + (r - 1) * n_skin + skin_of[node]; };
  for (int r = 0; r < m; ++r)
    for (int face = 0; face < n_hex_faces; ++face) {
      // First two axes of the hex in the face, the third outwards: right-handed in one order or the other.
      const int axis = face / 2;
      int first = axis == 0 ? 1 : 0, second = axis == 2 ? 1 : 2;
      if ((face % 2 == 1) == (axis == 1)) std::swap(first, second);
      for (int b = 0; b < n; ++b)
        for (int a = 0; a < n; ++a) {
          Hex& hex = mesh.hexes.emplace_back();
          for (int c = 0; c < 8; ++c) {
            std::array<int, 3> at;
            at[axis] = face % 2 ? n : 0;
            at[first] = a + (c & 1);
            at[second] = b + (c >> 1 & 1);
            hex[c] = shell_node(r + (c >> 2), core_node(at));
          }
        }
    }
  add_block(mesh, "sphere");
  return mesh;
}

}  // namespace hextwist
