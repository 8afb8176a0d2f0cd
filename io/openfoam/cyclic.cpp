// Cyclic patches: OpenFOAM takes face i of one for the image of face i of the other, first corner for first corner, and
// the others the other way round, since both turn out of the mesh.
#include <Eigen/Geometry>
#include <charconv>
#include <sstream>

#include "hextwist/base/sorted.h"
#include "hextwist/io/openfoam/openfoam_internal.h"
#include "hextwist/mesh/periodic.h"

namespace hextwist::io {
namespace {

/// OpenFOAM's own where a patch doesn't say: of the size of a face.
constexpr double usual_match_tolerance = 1e-4;

/// The value of an entry ("type cyclic;"), where it stands; empty: there is none.
std::string_view entry_of(std::string_view entries, std::string_view key) {
  while (!entries.empty()) {
    const auto end = std::min(entries.find(';'), entries.size());
    const std::string_view entry = trimmed(entries.substr(0, end));
    if (entry.starts_with(key) && entry.size() > key.size() && Cursor::blank(entry[key.size()]))
      return trimmed(entry.substr(key.size()));
    entries.remove_prefix(std::min(end + 1, entries.size()));
  }
  return {};
}
void set_entry(std::string& entries, std::string_view key, const std::string& value) {
  const std::string_view old = entry_of(entries, key);
  if (old.empty()) return;
  entries.replace(static_cast<std::size_t>(old.data() - entries.data()), old.size(), value);
}

bool vector_in(std::string_view text, Vec3& value) {
  std::string plain(text);
  std::ranges::replace_if(
      plain, [](char c) { return c == '(' || c == ')'; }, ' ');
  std::istringstream in(plain);
  in.imbue(std::locale::classic());
  return static_cast<bool>(in >> value[0] >> value[1] >> value[2]);
}
std::string vector_text(const Vec3& value) {
  std::string text = "(";
  for (const double x : value) {
    std::array<char, 32> digits;
    const double not_minus_zero = x + 0.0;
    text += " " +
            std::string(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), not_minus_zero).ptr);
  }
  return text + " )";
}

double shortest_edge(const Mesh& mesh, const FoamPatch& patch) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const FoamFace& face : patch.faces)
    for (std::size_t c = 0; c < 4; ++c)
      shortest = std::min(shortest, (mesh.points[face.cycle[c]] - mesh.points[face.cycle[(c + 1) % 4]]).norm());
  return shortest;
}

/// Puts the faces of `b` in the order of those of `a`, whose images they are. What is in the way, empty: nothing.
std::string order_like(const Mesh& mesh, const FoamPatch& a, FoamPatch& b, PeriodicPair& pair) {
  if (a.faces.size() != b.faces.size())
    return "there are " + counted(std::ssize(a.faces), "face") + " on one and " + std::to_string(b.faces.size()) +
           " on the other";
  if (a.faces.empty()) return {};
  Association both;
  std::vector<std::pair<Side, int>> faces;
  for (const FoamFace& face : a.faces) faces.emplace_back(face.side, 1);
  for (const FoamFace& face : b.faces) faces.emplace_back(face.side, 2);
  std::ranges::sort(faces);
  for (const auto& [side, surface] : faces) both.surface_faces.push_back(side), both.face_surface.push_back(surface);
  double tolerance = usual_match_tolerance;
  const std::string_view own = entry_of(a.entries, "matchTolerance");
  std::from_chars(own.data(), own.data() + own.size(), tolerance);
  std::vector<NodePair> images;
  try {
    pair = find_periodic_pair(mesh, both, 1, 2);
    constexpr double part = 0.2;  // corners that are so far off change an area by no more than the whole
    images = node_pairs(mesh, both, pair, part * tolerance * shortest_edge(mesh, a));
  } catch (const Error& error) {
    const std::string_view what = error.what();
    return std::string(what.substr(std::min(what.find(": ") + 2, what.size())));
  }
  const auto image = [&](Index n) {
    return std::ranges::lower_bound(images, n, {}, [](const NodePair& nodes) { return nodes[0]; })->at(1);
  };
  std::vector<std::pair<Quad, std::size_t>> place;
  for (std::size_t f = 0; f < b.faces.size(); ++f) place.emplace_back(ascending(b.faces[f].cycle), f);
  std::ranges::sort(place);
  std::vector<FoamFace> ordered;
  for (const FoamFace& face : a.faces) {
    const Quad& q = face.cycle;
    const Quad wanted{image(q[0]), image(q[3]), image(q[2]), image(q[1])};
    const auto found = std::ranges::lower_bound(place, std::pair(ascending(wanted), std::size_t{0}));
    FoamFace& other = ordered.emplace_back(b.faces[found->second]);
    const auto at = std::ranges::find(other.cycle, wanted[0]) - other.cycle.begin();
    if (other.cycle[static_cast<std::size_t>(at + 1) % 4] != wanted[1]) return "their faces turn to the same side";
    other.cycle = wanted;
  }
  b.faces = std::move(ordered);
  return {};
}

/// What the entries say of how one lies to the other.
std::string fit_transform(const Mesh& mesh, const PeriodicPair& pair, FoamPatch& patch, double sign,
                          std::vector<std::string>& notices) {
  const bool turned = !pair.turn.isIdentity();
  const std::string_view transform = entry_of(patch.entries, "transform");
  if (turned && transform != "rotational") return "one is the other turned, and their transform is not rotational";
  if (!turned && transform == "rotational") return "one is the other moved, and their transform is rotational";
  constexpr double relative = 1e-6;
  Vec3 said;
  if (turned) {
    const Vec3 axis = Eigen::AngleAxisd(pair.turn).axis();
    if (vector_in(entry_of(patch.entries, "rotationAxis"), said) && said.cross(axis).norm() > relative * said.norm())
      return "one is the other turned about another axis than their rotationAxis";
    if (vector_in(entry_of(patch.entries, "rotationCentre"), said) &&
        (pair.image(said) - said).norm() > periodic_tolerance(mesh))
      return "one is the other turned about another place than their rotationCentre";
    return {};
  }
  const Vec3 shift = sign * pair.shift;
  if (!vector_in(entry_of(patch.entries, "separationVector"), said)) return {};
  if ((said - shift).norm() <= relative * shift.norm()) return {};
  set_entry(patch.entries, "separationVector", vector_text(shift));
  notices.push_back("separationVector of patch '" + patch.name + "' is " + vector_text(shift) +
                    " in the file, as it lies to its neighbour");
  return {};
}

}  // namespace

void order_cyclic_patches(const Mesh& mesh, std::vector<FoamPatch>& patches, std::vector<std::string>& notices) {
  const auto named = [&](std::string_view name) -> FoamPatch* {
    const auto found = std::ranges::find(patches, name, &FoamPatch::own_name);
    return name.empty() || found == patches.end() ? nullptr : &*found;
  };
  const auto neighbour = [&](const FoamPatch& patch) { return named(entry_of(patch.entries, "neighbourPatch")); };
  const auto is_cyclic = [](const FoamPatch& patch) { return entry_of(patch.entries, "type") == "cyclic"; };
  std::vector<const FoamPatch*> done;
  for (FoamPatch& patch : patches) {
    if (!is_cyclic(patch) || std::ranges::find(done, &patch) != done.end()) continue;
    FoamPatch* const other = neighbour(patch);
    std::string why;
    PeriodicPair pair;
    if (!other || other == &patch || !is_cyclic(*other) || neighbour(*other) != &patch) {
      why = "no other patch is cyclic with it";
      notices.push_back("patch '" + patch.name + "' is an ordinary one (type patch) in the file, not cyclic: " + why);
      patch.entries = plain_patch;
      continue;
    }
    done.push_back(other);
    why = order_like(mesh, patch, *other, pair);
    if (why.empty() && !patch.faces.empty()) why = fit_transform(mesh, pair, patch, 1, notices);
    if (why.empty() && !patch.faces.empty()) why = fit_transform(mesh, pair, *other, -1, notices);
    if (why.empty()) continue;
    notices.push_back("patches '" + patch.name + "' and '" + other->name +
                      "' are ordinary ones (type patch) in the file, not cyclic: " + why);
    patch.entries = other->entries = plain_patch;
  }
  // As they are called here.
  for (FoamPatch& patch : patches)
    if (const FoamPatch* const other = neighbour(patch)) set_entry(patch.entries, "neighbourPatch", other->name);
}

}  // namespace hextwist::io
