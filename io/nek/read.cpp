// Nek5000's .re2: corners are merged to nodes by their places.
#include <map>
#include <numeric>
#include <tuple>

#include "hextwist/base/sorted.h"
#include "hextwist/io/listing.h"
#include "hextwist/io/nek/nek_internal.h"
#include "hextwist/mesh/topology.h"

namespace hextwist::io {
namespace {

/// Corners are one node where they are nearer than this part of the shortest edge at each of them.
constexpr double near_part = 0.01;
/// More places than this are not near to each other.
constexpr std::size_t most_around = 256;

/// In the coordinate where it is largest: squares of large numbers would not be numbers any more.
double largest_offset(const Vec3& a, const Vec3& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

/// Puts corners that are one into groups: sorted by one coordinate after the other, until no gap divides any more.
class MergedCorners {
 public:
  MergedCorners(std::span<const Vec3> points, std::span<const double> reach) : points_(points), reach_(reach) {
    order_.resize(points.size());
    std::iota(order_.begin(), order_.end(), 0);
    starts_ = {0, points.size()};
    for (int axis = 0, unchanged = 0; unchanged < 3; axis = (axis + 1) % 3) {
      const std::size_t before = starts_.size();
      divide(axis);
      unchanged = starts_.size() == before ? unchanged + 1 : 0;
    }
  }

  /// Per corner the first that it is one with. crowded: called with a corner where too many are near.
  template <class F>
  std::vector<Index> first_of_same(F&& crowded) const {
    std::vector<Index> first(points_.size());
    std::vector<Place> places;
    for (std::size_t s = 0; s + 1 < starts_.size(); ++s) {
      gather({order_.data() + starts_[s], starts_[s + 1] - starts_[s]}, places);
      if (places.size() > most_around)
        crowded(places[0].corners[0]);
      else if (places.size() > 1)
        unite(places);
      for (const Place& place : places)
        for (const Index corner : place.corners) first[corner] = place.corners[0];
    }
    return first;
  }

 private:
  /// Corners that are one, ascending.
  struct Place {
    Vec3 point;
    double reach;
    std::vector<Index> corners;
  };

  /// Corners at exactly one place.
  void gather(std::span<const Index> group, std::vector<Place>& places) const {
    places.clear();
    const auto key = [&](Index i) { return std::tuple(points_[i].x(), points_[i].y(), points_[i].z(), i); };
    std::vector<Index> sorted(group.begin(), group.end());
    std::ranges::sort(sorted, {}, key);
    for (const Index i : sorted) {
      if (places.empty() || places.back().point != points_[i]) places.push_back({points_[i], reach_[i], {}});
      places.back().reach = std::min(places.back().reach, reach_[i]);
      places.back().corners.push_back(i);
    }
  }

  /// The nearest first, and never two corners of one element: a thin element between thick ones stays.
  static void unite(std::vector<Place>& places) {
    std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
    for (std::size_t i = 1; i < places.size(); ++i)
      for (std::size_t k = 0; k < i; ++k)
        if (const double d = largest_offset(places[i].point, places[k].point);
            d <= std::min(places[i].reach, places[k].reach))
          pairs.emplace_back(d, k, i);
    std::ranges::sort(pairs);
    std::vector<std::size_t> of(places.size());
    std::iota(of.begin(), of.end(), std::size_t{0});
    for (const auto& [d, k, i] : pairs) {
      const std::size_t a = std::min(of[k], of[i]), b = std::max(of[k], of[i]);
      if (a == b || shares_element(places[a].corners, places[b].corners)) continue;
      auto& to = places[a].corners;
      const auto middle = static_cast<std::ptrdiff_t>(to.size());
      to.insert(to.end(), places[b].corners.begin(), places[b].corners.end());
      std::inplace_merge(to.begin(), to.begin() + middle, to.end());
      places[b].corners.clear();
      std::ranges::replace(of, b, a);
    }
    std::erase_if(places, [](const Place& place) { return place.corners.empty(); });
  }
  static bool shares_element(std::span<const Index> a, std::span<const Index> b) {
    for (std::size_t i = 0, k = 0; i < a.size() && k < b.size();) {
      if (a[i] / 8 == b[k] / 8) return true;
      a[i] < b[k] ? ++i : ++k;
    }
    return false;
  }
  void divide(int axis) {
    std::vector<std::size_t> starts;
    for (std::size_t s = 0; s + 1 < starts_.size(); ++s) {
      const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(starts_[s]),
                 end = order_.begin() + static_cast<std::ptrdiff_t>(starts_[s + 1]);
      std::sort(begin, end,
                [&](Index a, Index b) { return std::pair(points_[a][axis], a) < std::pair(points_[b][axis], b); });
      starts.push_back(starts_[s]);
      for (auto at = begin; at != end && at + 1 != end; ++at)
        if (points_[at[1]][axis] - points_[at[0]][axis] > std::max(reach_[at[0]], reach_[at[1]]))
          starts.push_back(static_cast<std::size_t>(at + 1 - order_.begin()));
    }
    starts.push_back(order_.size());
    starts_ = std::move(starts);
  }

  std::span<const Vec3> points_;
  std::span<const double> reach_;
  std::vector<Index> order_;
  std::vector<std::size_t> starts_;
};

class NekReader {
 public:
  explicit NekReader(const Bytes& bytes) : cursor_(bytes) { cursor_.binary = true; }

  MeshFile result() {
    header();
    elements();
    merge();
    blocks();
    curves();
    for (int field = 1; cursor_.left() > 0; ++field) conditions(field);
    side_sets();
    return std::move(out_);
  }

 private:
  /// Integers are doubles where words have 8 bytes.
  std::int64_t integer(const char* what) {
    const char* const at = cursor_.at;
    if (!wide_) return cursor_.raw<std::int32_t>(what);
    const double value = cursor_.raw<double>(what);
    if (!(std::abs(value) < 1e15) || value != std::floor(value))
      cursor_.fail_at(at, "expected " + std::string(what) + ", found " + short_number(value));
    return static_cast<std::int64_t>(value);
  }
  double real(const char* what) {
    return wide_ ? cursor_.raw<double>(what) : static_cast<double>(cursor_.raw<float>(what));
  }
  std::int64_t between(std::int64_t low, std::int64_t high, const char* what) {
    const char* const at = cursor_.at;
    const std::int64_t value = integer(what);
    if (value < low || value > high)
      cursor_.fail_at(at, std::string(what) + " " + std::to_string(value) + " is not between " + std::to_string(low) +
                              " and " + std::to_string(high));
    return value;
  }

  void header() {
    if (cursor_.left() < nek_header + 4) cursor_.fail("the file is too short for a header");
    const std::string_view text(cursor_.at, nek_header);
    if (!text.starts_with("#v00")) cursor_.fail("not an .re2 file: it does not begin with #v001, #v002 or #v003");
    if (text[4] < '1' || text[4] > '3')
      cursor_.fail("version " + shown(text.substr(0, 5)) + " is none of #v001, #v002 and #v003");
    wide_ = text[4] != '1';
    const auto number = [&](std::size_t from, std::size_t width, const char* what) {
      std::int64_t value = 0;
      if (!integer_in_field(text.substr(from, width), value))
        cursor_.fail_at(cursor_.at + from,
                        "expected " + std::string(what) + ", found " + shown(text.substr(from, width)));
      return value;
    };
    const std::int64_t n = number(5, 9, "the number of elements"), dimension = number(14, 3, "the dimension"),
                       n_fluid = number(17, 9, "the number of fluid elements");
    if (dimension != 3) cursor_.fail("a mesh of dimension " + std::to_string(dimension) + " instead of 3");
    cursor_.at += nek_header;
    const float mark = cursor_.raw<float>("the mark of the byte order");
    cursor_.swapped = std::abs(with_bytes_reversed(mark) - nek_mark) < 1e-4F;
    if (!cursor_.swapped && !(std::abs(mark - nek_mark) < 1e-4F))
      cursor_.fail_at(cursor_.at - 4, "the mark of the byte order is not 6.54321");
    if (n == 0) cursor_.fail("there is no hex in the file");
    n_ = cursor_.check_count(n, 25 * (wide_ ? 8U : 4U), "elements");
    if (n_ > static_cast<std::size_t>(std::numeric_limits<Index>::max()) / 8)
      cursor_.fail("too many elements: " + std::to_string(n));
    n_fluid_ = n_fluid >= 0 && n_fluid <= n ? static_cast<std::size_t>(n_fluid) : n_;
  }

  void elements() {
    corners_.resize(8 * n_);
    groups_.resize(n_);
    for (std::size_t e = 0; e < n_; ++e) {
      const char* const at = cursor_.at;
      const std::int64_t group = integer("the group of an element");
      groups_[e] = group > 0 && group <= std::numeric_limits<int>::max() ? static_cast<int>(group) : 0;
      for (int axis = 0; axis < 3; ++axis)
        for (std::size_t c = 0; c < 8; ++c) corners_[8 * e + c][axis] = real("a coordinate");
      for (std::size_t c = 0; c < 8; ++c)
        if (!corners_[8 * e + c].allFinite())
          cursor_.fail_at(at, "a coordinate of element " + std::to_string(e + 1) + " is not finite");
    }
  }

  void merge() {
    const auto first = one_by_place(corners_, [&](Index corner) {
      cursor_.fail_at(cursor_.at, "too many corners lie too near to one of element " + std::to_string(corner / 8 + 1) +
                                      " to tell which are one");
    });
    Mesh& mesh = out_.mesh;
    std::vector<Index> node(corners_.size(), -1);
    mesh.hexes.resize(n_);
    for (std::size_t e = 0; e < n_; ++e) {
      std::array<std::int64_t, 8> own{};
      for (std::size_t c = 0; c < 8; ++c) {
        Index& known = node[first[8 * e + c]];
        if (known < 0) {
          known = mesh.n_nodes();
          mesh.points.push_back(corners_[8 * e + c]);
        }
        own[c] = known;
        mesh.hexes[e][file_corner[c]] = known;
      }
      if (const char* type = degenerate_hex(own))
        throw Error(std::string(cursor_.name) + ": element " + std::to_string(e + 1) + " is a " + type +
                    "; only hexes of 8, 20 or 27 nodes are accepted");
    }
    out_.notices.push_back("corners of elements were merged by their places: " + std::to_string(corners_.size()) +
                           " to " + counted(mesh.n_nodes(), "node"));
    corners_ = {};
  }

  void blocks() {
    std::map<int, std::vector<Index>> of_group;
    for (std::size_t e = 0; e < n_; ++e)
      if (groups_[e] > 0) of_group[groups_[e]].push_back(static_cast<Index>(e));
    for (auto& [group, hexes] : of_group) out_.mesh.blocks.push_back({group, "", std::move(hexes)});
    if (n_fluid_ == n_) return;
    std::vector<Index> fluid, solid;
    for (std::size_t e = 0; e < n_; ++e) (e < n_fluid_ ? fluid : solid).push_back(static_cast<Index>(e));
    for (const auto& [name, hexes] : {std::pair(nek_fluid, fluid), std::pair(nek_solid, solid)})
      if (!hexes.empty()) {
        Block& block = group_of_id(out_.mesh.blocks, free_id(out_.mesh.blocks));
        block.name = name;
        block.hexes = hexes;
      }
  }

  std::size_t list(const char* what) { return cursor_.check_count(integer(what), 8 * (wide_ ? 8U : 4U), what); }
  /// The code at the end of an entry.
  std::string code() {
    const std::size_t width = wide_ ? 8 : 4;
    if (cursor_.left() < width) cursor_.fail_truncated("a code");
    std::string text(trimmed(std::string_view(cursor_.at, 3)));
    cursor_.at += width;
    for (char& c : text)
      if (static_cast<unsigned char>(c) <= ' ' || static_cast<unsigned char>(c) > '~') c = '?';
    return text;
  }

  void curves() {
    const std::size_t n = list("the number of curved sides");
    std::vector<std::pair<Index, Vec3>> middles;
    std::map<std::string, std::int64_t> others;
    Edges all;
    if (n > 0) all = edges(out_.mesh);
    for (std::size_t i = 0; i < n; ++i) {
      const char* const at = cursor_.at;
      const auto element = static_cast<std::size_t>(between(1, static_cast<std::int64_t>(n_), "element")) - 1;
      const auto edge = static_cast<std::size_t>(between(1, 12, "edge")) - 1;
      std::array<double, 5> numbers{};
      for (double& x : numbers) x = real("a number of a curved side");
      const std::string kind = code();
      if (kind != "m") {
        ++others[kind];
        continue;
      }
      const Vec3 point(numbers[0], numbers[1], numbers[2]);
      if (!point.allFinite())
        cursor_.fail_at(at, "the middle of an edge of element " + std::to_string(element + 1) + " is not finite");
      middles.emplace_back(all.of_hex[element][static_cast<std::size_t>(nek_edges[edge])], point);
    }
    for (const auto& [kind, count] : others)
      out_.notices.push_back(counted(count, "curved side") + " of kind '" + kind +
                             "' left out: " + (count == 1 ? "it is" : "they are") + " straight here");
    if (middles.empty()) return;
    std::ranges::stable_sort(middles, {}, &std::pair<Index, Vec3>::first);
    MiddleNodes& to = out_.middles;
    to.nodes_per_hex = out_.extras.nodes_per_hex[0] = 20;
    Index last = -1;
    std::int64_t n_different = 0;
    for (const auto& [edge, point] : middles) {
      if (edge == last) {
        const auto [a, b] = all.nodes[edge];
        n_different += largest_offset(point, to.edge_points.back()) >
                       near_part * largest_offset(out_.mesh.points[a], out_.mesh.points[b]);
        continue;
      }
      last = edge;
      to.edges.push_back(all.nodes[edge]);
      to.edge_points.push_back(point);
    }
    if (n_different > 0)
      out_.notices.push_back("elements do not agree where the middle of " + counted(n_different, "edge") +
                             " lies: the first to say so is right");
  }

  void conditions(int field) {
    const std::size_t n = list("the number of conditions");
    for (std::size_t i = 0; i < n; ++i) {
      const auto element = static_cast<Index>(between(1, static_cast<std::int64_t>(n_), "element") - 1);
      const auto side = static_cast<std::size_t>(between(1, 6, "side")) - 1;
      std::array<double, 5> numbers{};
      for (double& x : numbers) x = real("a number of a condition");
      const std::string kind = code();
      if (kind.empty() || kind == "E") continue;  // none, or between elements
      const bool is_pair = kind == "P" || kind == "p";
      periodic_ = periodic_ || is_pair;
      const double number = numbers[4];
      const bool numbered =
          number >= 1 && number <= std::numeric_limits<int>::max() && number == std::floor(number) && !is_pair;
      const auto n_values = numbers.begin() + (numbered ? 4 : 5);
      constexpr std::string_view no_values = " W A SYM I O MSH EXO CGN ";  // some programs leave numbers there
      if (!is_pair && no_values.find(" " + kind + " ") == std::string_view::npos &&
          std::any_of(numbers.begin(), n_values, [](double x) { return x != 0; }))
        ++valued_[kind];
      const int id = numbered ? static_cast<int>(number) : 0;
      sides_[{id, kind, numbered ? 1 : field}].push_back({element, nek_sides[side]});
    }
  }

  /// Sides with a number are the set of that number, in all lists; others are a set for each code and list.
  void side_sets() {
    auto& sets = out_.mesh.side_sets;
    for (const bool numbered : {true, false})
      for (auto& [key, sides] : sides_) {
        const auto& [id, kind, field] = key;
        if ((id > 0) != numbered) continue;
        sort_unique(sides);
        const bool taken = id == 0 || position_in(sets, id, &SideSet::id) >= 0;
        SideSet& set = group_of_id(sets, taken ? free_id(sets) : id);
        if (kind != "MSH" && kind != "EXO" && kind != "CGN") set.name = kind;
        if (field > 1) set.name += " field " + std::to_string(field);
        set.sides = std::move(sides);
      }
    for (const auto& [kind, count] : valued_)
      out_.notices.push_back("values of " + counted(count, "condition") + " '" + kind + "' are left out: sides here " +
                             "have a code and a number");
    if (periodic_) out_.notices.emplace_back("which sides are periodic pairs is left out; they are the side sets 'P'");
  }

  Cursor cursor_;
  MeshFile out_;
  bool wide_ = true, periodic_ = false;
  std::size_t n_ = 0, n_fluid_ = 0;
  std::vector<Vec3> corners_;  // of all elements
  std::vector<int> groups_;
  std::map<std::tuple<int, std::string, int>, std::vector<Side>> sides_;  // by number, code, list
  std::map<std::string, std::int64_t> valued_;                            // conditions with values, by code
};

}  // namespace

std::vector<Index> one_by_place(std::span<const Vec3> corners, const std::function<void(Index)>& crowded) {
  std::vector<double> reach(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::size_t first = i / 8 * 8, c = i % 8;
    double shortest = std::numeric_limits<double>::max();
    for (const std::size_t other : {c / 4 * 4 + (c + 1) % 4, c / 4 * 4 + (c + 3) % 4, (c + 4) % 8})
      shortest = std::min(shortest, largest_offset(corners[i], corners[first + other]));
    reach[i] = near_part * shortest;
  }
  return MergedCorners(corners, reach).first_of_same(crowded);
}

MeshFile read_nek(const Bytes& bytes) {
  return NekReader(bytes).result();
}

}  // namespace hextwist::io
