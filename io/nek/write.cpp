// Nek5000's .re2, version 3: words of 8 bytes, one list of conditions; two where elements are solid.
#include <cstdio>

#include "hextwist/base/sorted.h"
#include "hextwist/io/listing.h"
#include "hextwist/io/nek/nek_internal.h"

namespace hextwist::io {
namespace {

class NekWriter {
 public:
  NekWriter(Output& out, const Mesh& mesh, const SecondOrder* second, std::vector<std::string>& notices)
      : out_(out), mesh_(mesh), second_(second), notices_(notices) {}

  void write() {
    say_no_fields(mesh_, ".re2", notices_);
    if (!mesh_.node_ids.empty() || !mesh_.hex_ids.empty())
      notices_.emplace_back(".re2 has no ids: elements are counted from 1 in the file, nodes are not numbered");
    if (!mesh_.node_sets.empty())
      notices_.push_back(counted(std::ssize(mesh_.node_sets), "node set") + " left out: .re2 has none");
    if (mesh_.n_hexes() > 999'999'999) throw Error("more hexes than nine digits can count");
    order();
    tell_joined();
    header();
    elements();
    curves();
    conditions();
  }

 private:
  bool says_matter(const Block& block) const {
    return same_word(block.name, nek_fluid) || same_word(block.name, nek_solid);
  }

  /// Solid elements come last.
  void order() {
    std::vector<char> solid(mesh_.hexes.size(), 0);
    for (const Block& block : mesh_.blocks)
      if (same_word(block.name, nek_solid))
        for (const Index h : block.hexes) solid[h] = 1;
    for (const bool wanted : {false, true}) {
      for (Index h = 0; h < mesh_.n_hexes(); ++h)
        if ((solid[h] != 0) == wanted) hexes_.push_back(h);
      if (!wanted) n_fluid_ = hexes_.size();
    }
    if (n_fluid_ == 0) n_fluid_ = hexes_.size();
    place_.resize(hexes_.size());
    for (std::size_t i = 0; i < hexes_.size(); ++i) place_[hexes_[i]] = static_cast<Index>(i);
  }

  /// Nodes at one place, as those of a crack, are one to whoever reads the file.
  void tell_joined() {
    std::vector<Vec3> corners;
    std::vector<Index> nodes;
    for (const Index h : hexes_)
      for (const int c : file_corner) {
        nodes.push_back(mesh_.hexes[h][c]);
        corners.push_back(mesh_.points[nodes.back()]);
      }
    bool is_crowded = false;
    std::vector<Index> first = one_by_place(corners, [&](Index) { is_crowded = true; });
    if (is_crowded)
      notices_.emplace_back("too many corners lie too near to one to tell which are one when the file is read");
    sort_unique(nodes), sort_unique(first);
    if (const std::int64_t n = std::ssize(nodes) - std::ssize(first); n > 0)
      notices_.push_back(counted(n, "node") + (n == 1 ? " is" : " are") +
                         " joined with others when the file is read: .re2 knows nodes by their places, and these lie "
                         "at one, or nearly");
  }

  void header() {
    std::array<char, nek_header + 1> text{};
    const int n = std::snprintf(text.data(), text.size(), "#v003%9d%3d%9d hextwist mesh",
                                static_cast<int>(hexes_.size()), 3, static_cast<int>(n_fluid_));
    std::fill(text.begin() + n, text.end(), ' ');
    out_.raw(text.data(), nek_header);
    out_.put(nek_mark);
  }

  /// Blocks as numbers of groups, which solvers know up to 10; 0 for those in none.
  std::vector<int> groups() {
    std::vector<const Block*> blocks;
    for (const Block& block : mesh_.blocks)
      if (!says_matter(block)) blocks.push_back(&block);
    std::vector<int> group(mesh_.hexes.size(), 0);
    if (blocks.size() > nek_highest_group) {
      notices_.push_back(counted(std::ssize(blocks), "block") + " left out: .re2 has groups up to " +
                         std::to_string(nek_highest_group));
      return group;
    }
    const bool fit =
        std::ranges::all_of(blocks, [](const Block* block) { return block->id > 0 && block->id <= nek_highest_group; });
    std::vector<std::string> names;
    std::int64_t n_more = 0;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const int number = fit ? blocks[b]->id : static_cast<int>(b) + 1;
      if (!fit || !blocks[b]->name.empty())
        names.push_back(std::to_string(number) + " is block " + std::to_string(blocks[b]->id) +
                        (blocks[b]->name.empty() ? "" : " '" + blocks[b]->name + "'"));
      for (const Index h : blocks[b]->hexes)
        if (group[h] == 0)
          group[h] = number;
        else
          ++n_more;
    }
    if (!names.empty()) notices_.push_back(".re2 has numbers of groups, no names: " + joined(names, ", "));
    if (n_more > 0)
      notices_.push_back("blocks overlap, and a hex is in one group only in .re2: " + counted(n_more, "hex", "hexes") +
                         (n_more == 1 ? " is" : " are") + " in the first of their blocks");
    return group;
  }

  void elements() {
    const std::vector<int> group = groups();
    for (const Index h : hexes_) {
      out_.put(static_cast<double>(group[h]));
      for (int axis = 0; axis < 3; ++axis)
        for (const int c : file_corner) out_.put(mesh_.points[mesh_.hexes[h][c]][axis]);
    }
  }

  void entry(Index place, std::size_t item, const std::array<double, 5>& numbers, std::string_view code) {
    out_.put(static_cast<double>(place + 1));
    out_.put(static_cast<double>(item + 1));
    out_.put_all(std::span<const double>(numbers));
    std::array<char, 8> text;
    text.fill(' ');
    std::ranges::copy(code, text.begin());
    out_.raw(text.data(), text.size());
  }

  /// Edges that are not straight.
  void curves() {
    std::vector<std::tuple<Index, std::size_t, Vec3>> bent;
    for (std::size_t i = 0; second_ && i < hexes_.size(); ++i) {
      const auto middles = second_->middles(hexes_[i]);
      for (std::size_t e = 0; e < 12; ++e) {
        const int edge = nek_edges[e];
        const Hex& hex = mesh_.hexes[hexes_[i]];
        const Vec3 straight = (mesh_.points[hex[edge_corner(edge, 0)]] + mesh_.points[hex[edge_corner(edge, 1)]]) / 2;
        const Vec3& point = mesh_.points[middles[static_cast<std::size_t>(edge)]];
        if (point != straight) bent.emplace_back(static_cast<Index>(i), e, point);
      }
    }
    out_.put(static_cast<double>(bent.size()));
    for (const auto& [place, e, point] : bent) entry(place, e, {point.x(), point.y(), point.z(), 0, 0}, "m");
  }

  struct Condition {
    Index place;
    std::size_t side;
    int id;
    std::string_view code;
  };

  void conditions() {
    const Faces all = faces(mesh_);
    std::vector<char> taken(all.nodes.size(), 0);
    std::vector<Condition> list;
    std::int64_t n_twice = 0, n_inside = 0;
    std::vector<std::string> names;
    int next = 0;
    for (const SideSet& set : mesh_.side_sets) next = std::max(next, set.id);
    for (const SideSet& set : mesh_.side_sets) {
      const auto known = std::ranges::find(nek_codes, std::string_view(set.name));
      const std::string_view code = known == std::end(nek_codes) ? "MSH" : *known;
      int id = set.id;
      if (id == 0) {
        if (next == std::numeric_limits<int>::max()) throw Error("no number is left for side set 0");
        id = ++next;
      }
      if (id != set.id || (!set.name.empty() && set.name != code))
        names.push_back(std::to_string(id) + " is side set " + std::to_string(set.id) +
                        (set.name.empty() ? "" : " '" + set.name + "'"));
      for (const Side& side : set.sides) {
        const Index f = all.of_hex[side.hex][side.face];
        if (all.sides[f][1].hex >= 0) {
          ++n_inside;
        } else if (taken[f]) {
          ++n_twice;
        } else {
          taken[f] = 1;
          const auto at = std::ranges::find(nek_sides, side.face) - nek_sides.begin();
          list.push_back({place_[side.hex], static_cast<std::size_t>(at), id, code});
        }
      }
    }
    if (!names.empty())
      notices_.push_back(".re2 has numbers of side sets (the fifth of a condition), no names: " + joined(names, ", "));
    if (n_inside > 0)
      notices_.push_back(counted(n_inside, "side") + " of side sets left out, which " + (n_inside == 1 ? "is" : "are") +
                         " not at the boundary");
    if (n_twice > 0)
      notices_.push_back("side sets overlap, and a side has one condition in .re2: " + counted(n_twice, "side") +
                         (n_twice == 1 ? " is" : " are") + " in the first of its sets");
    std::ranges::sort(list, {}, [](const Condition& c) { return std::pair(c.place, c.side); });
    const auto put = [&](Index end) {
      out_.put(static_cast<double>(std::ranges::count_if(list, [&](const Condition& c) { return c.place < end; })));
      for (const Condition& c : list)
        if (c.place < end) entry(c.place, c.side, {0, 0, 0, 0, static_cast<double>(c.id)}, c.code);
    };
    put(static_cast<Index>(n_fluid_));
    if (n_fluid_ < hexes_.size()) put(mesh_.n_hexes());  // of the temperature
  }

  Output& out_;
  const Mesh& mesh_;
  const SecondOrder* const second_;
  std::vector<std::string>& notices_;
  std::vector<Index> hexes_, place_;  // as the file has them; per hex its place there
  std::size_t n_fluid_ = 0;
};

}  // namespace

void write_nek(Output& out, const Mesh& mesh, const Association&, const WriteOptions& options,
               std::vector<std::string>& notices) {
  NekWriter(out, mesh, options.second, notices).write();
}

}  // namespace hextwist::io
