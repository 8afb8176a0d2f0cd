#include "support/grids.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace hextwist::test {

Mesh grid(int a, int b, int c) {
  return grid(a, b, c, Vec3::Ones());
}

Mesh grid(int a, int b, int c, const Vec3& size) {
  Mesh mesh;
  for (int k = 0; k <= c; ++k)
    for (int j = 0; j <= b; ++j)
      for (int i = 0; i <= a; ++i) mesh.points.push_back(Vec3(i, j, k).cwiseProduct(size));
  const auto node = [&](int i, int j, int k) { return i + (a + 1) * (j + (b + 1) * k); };
  for (int k = 0; k < c; ++k)
    for (int j = 0; j < b; ++j)
      for (int i = 0; i < a; ++i) {
        Hex hex;
        for (int corner = 0; corner < 8; ++corner)
          hex[corner] = node(i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2 & 1));
        mesh.hexes.push_back(hex);
      }
  return mesh;
}

Mesh shuffled(const Mesh& mesh, std::mt19937& random) {
  std::vector<Index> node(mesh.points.size()), hex(mesh.hexes.size());
  std::iota(node.begin(), node.end(), 0);
  std::iota(hex.begin(), hex.end(), 0);
  std::ranges::shuffle(node, random);
  std::ranges::shuffle(hex, random);
  Mesh result;
  result.points.resize(mesh.points.size());
  for (std::size_t i = 0; i < node.size(); ++i) result.points[node[i]] = mesh.points[i];
  for (const Index h : hex) {
    // A rotation of the cube: images of the three axes, right-handed, by permutation and signs.
    std::array<int, 3> axis = {0, 1, 2};
    std::ranges::shuffle(axis, random);
    int flip = static_cast<int>(random() % 8);
    const bool odd = (axis[0] > axis[1]) != ((axis[1] > axis[2]) != (axis[0] > axis[2]));
    const bool flips_odd = (flip & 1) != ((flip >> 1 & 1) != (flip >> 2 & 1));
    if (odd != flips_odd) flip ^= 1;
    Hex turned;
    for (int c = 0; c < 8; ++c) {
      int image = 0;
      for (int b = 0; b < 3; ++b) image |= (c >> b & 1) << axis[b];
      turned[c] = node[mesh.hexes[h][image ^ flip]];
    }
    result.hexes.push_back(turned);
  }
  return result;
}

Mesh pinwheel(int valence, int n, int layers) {
  // Sector s spans spokes s and s + 1; its point (i, j) is i steps along one spoke plus j along the next.
  Mesh mesh;
  const auto spoke = [&](int s) {
    const double angle = 2 * std::numbers::pi * s / valence;
    return Vec3(std::cos(angle), std::sin(angle), 0);
  };
  const int per_sector = n * n + n;  // nodes with i >= 1 of each sector, j = 0..n
  const int per_layer = 1 + valence * per_sector;
  const auto node = [&](int s, int i, int j, int k) {
    if (i == 0 && j == 0) return k * per_layer;
    if (i == 0) {  // on the next sector's first spoke
      s = (s + 1) % valence;
      i = j;
      j = 0;
    }
    return k * per_layer + 1 + s * per_sector + (i - 1) * (n + 1) + j;
  };
  mesh.points.resize(static_cast<std::size_t>(per_layer) * (layers + 1));
  for (int k = 0; k <= layers; ++k) {
    mesh.points[node(0, 0, 0, k)] = Vec3(0, 0, k);
    for (int s = 0; s < valence; ++s)
      for (int i = 1; i <= n; ++i)
        for (int j = 0; j <= n; ++j) mesh.points[node(s, i, j, k)] = i * spoke(s) + j * spoke(s + 1) + Vec3(0, 0, k);
  }
  for (int k = 0; k < layers; ++k)
    for (int s = 0; s < valence; ++s)
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          Hex hex;
          for (int c = 0; c < 8; ++c) hex[c] = node(s, i + (c & 1), j + (c >> 1 & 1), k + (c >> 2 & 1));
          mesh.hexes.push_back(hex);
        }
  return mesh;
}

Mesh ring(int m, int n, int quarter_turns) {
  Mesh mesh;
  const double radius = 2 * m;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j <= m; ++j)
      for (int i = 0; i <= m; ++i) {
        const double around = 2 * std::numbers::pi * k / n, twist = -around * quarter_turns / 4;
        const double x = i - m / 2.0, y = j - m / 2.0;
        const double out = x * std::cos(twist) - y * std::sin(twist), up = x * std::sin(twist) + y * std::cos(twist);
        mesh.points.emplace_back((radius + out) * std::cos(around), up, (radius + out) * std::sin(around));
      }
  const auto node = [&](int i, int j, int k) {
    if (k == n) {
      k = 0;
      for (int turn = 0; turn < quarter_turns % 4; ++turn) i = std::exchange(j, m - i);
    }
    return i + (m + 1) * (j + (m + 1) * k);
  };
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < m; ++j)
      for (int i = 0; i < m; ++i) {
        Hex hex;
        for (int c = 0; c < 8; ++c) hex[c] = node(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2 & 1));
        mesh.hexes.push_back(hex);
      }
  return mesh;
}

std::filesystem::path data_folder() {
  const std::filesystem::path folder = HEXTWIST_TEST_DATA;
  return std::filesystem::exists(folder) ? folder : std::filesystem::path{};
}

std::filesystem::path output_folder() {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  std::string leaf = test ? std::string(test->test_suite_name()) + "." + test->name() : "shared";
  std::ranges::replace(leaf, '/', '_');
  const auto folder = std::filesystem::path(HEXTWIST_TEST_OUTPUT) / leaf;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

}  // namespace hextwist::test
