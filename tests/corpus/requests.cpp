#include "corpus/requests.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace hextwist::corpus {
namespace {

/// ?h, ?n, ?e, ?f: some hexes, nodes, edges, faces; ?H: a node whose hexes are meant; ?v ?c ?s ?V: an entity of the
/// CAD; ?d: a length of half an element, ?r: of two; ?x: a place.
constexpr const char* patterns[] = {
    "refine hex ?h",
    "refine hex in node ?H numsplit 2",
    "refine hex in node ?H method parallel",
    "refine hex in node ?n concave fill",
    "refine hex ?h numsplit 2 transition nested",
    "refine hex in node ?H graded",
    "refine hex in surface ?s method single smooth",
    "refine node ?n",
    "refine node ?n radius ?r smooth",
    "refine edge ?e",
    "refine edge ?e method parallel",
    "refine face ?f",
    "refine face ?f depth 1",
    "refine vertex ?v depth 1 numsplit 2",
    "refine vertex ?v size ?d bias 1.5",
    "refine curve ?c",
    "refine curve ?c numsplit 2",
    "refine curve ?c size ?d",
    "refine curve ?c depth 1",
    "refine surface ?s",
    "refine surface ?s depth 1 method parallel",
    "refine surface ?s direction layers 3 growth 1.4",
    "refine surface ?s direction thickness",
    "refine volume ?V",
    "refine volume all numsplit 1",
    "refine sheet edge ?E",
    "refine sheet intersect edge ?E",
    "refine location ?x radius ?r numsplit 2",
    "refine hex in node ?H sizing_function \"?d * (1 + 0*x)\"",
};

double element_size(const Mesh& mesh) {
  return std::cbrt(std::abs(volume(mesh)) / std::max<Index>(1, mesh.n_hexes()));
}

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

}  // namespace

int n_requests() {
  return static_cast<int>(std::size(patterns));
}

std::string request(int kind, const MeshedModel& input, std::mt19937& random) {
  const Mesh& mesh = input.mesh;
  const auto below = [&](std::int64_t n) {
    return static_cast<Index>(random() % static_cast<unsigned>(std::max<std::int64_t>(1, n)));
  };
  const auto some = [&](const auto& one, int most) {
    std::string text = one();
    for (Index n = below(most); n > 0; --n) text += " " + one();
    return text;
  };
  const auto node = [&] { return std::to_string(node_id(mesh, below(mesh.n_nodes()))); };
  const auto hex = [&] { return std::to_string(hex_id(mesh, below(mesh.n_hexes()))); };
  // A mesh has more edges than nodes, and at least three faces for each hex.
  const auto edge = [&] { return std::to_string(1 + below(mesh.n_nodes())); };
  const auto face = [&] { return std::to_string(1 + below(3 * std::int64_t{mesh.n_hexes()})); };
  const auto of_model = [&](int dim) { return std::to_string(1 + below(input.model->count(dim))); };
  const double h = element_size(mesh);
  std::string result;
  for (const char* c = patterns[kind % n_requests()]; *c; ++c) {
    if (*c != '?') {
      result += *c;
      continue;
    }
    switch (*++c) {
      case 'h':
        result += some(hex, 5);
        break;
      case 'H':
        result += node();
        break;
      case 'n':
        result += some(node, 4);
        break;
      case 'e':
        result += some(edge, 4);
        break;
      case 'E':
        result += edge();
        break;
      case 'f':
        result += some(face, 4);
        break;
      case 'v':
        result += of_model(0);
        break;
      case 'c':
        result += of_model(1);
        break;
      case 's':
        result += of_model(2);
        break;
      case 'V':
        result += of_model(3);
        break;
      case 'd':
        result += number(h / 2);
        break;
      case 'r':
        result += number(1.5 * h);
        break;
      default: {
        const Vec3 p = mesh.points[below(mesh.n_nodes())];
        result += number(p.x()) + " " + number(p.y()) + " " + number(p.z());
      }
    }
  }
  return result;
}

}  // namespace hextwist::corpus
