// Exodus II piece after piece: all that is known before is written first, then each piece goes to its places, a call of
// the library for each run of places that follow each other.
#include <algorithm>
#include <numeric>

#include "hextwist/base/sorted.h"
#include "hextwist/io/exodus/write_internal.h"
#include "hextwist/io/field_names.h"
#include "hextwist/io/pieces.h"

namespace hextwist::io {

class ExodusPieces {
 public:
  ExodusPieces(const std::filesystem::path& file, const WholeOfPieces& whole, std::vector<std::string>& notices)
      : replacement_(file, true), out_(replacement_), heads_(whole.heads), values_(heads_, notices) {
    const int rest = free_id(heads_.blocks);
    for (std::size_t b = 0; b < heads_.blocks.size(); ++b) {
      const Block& block = heads_.blocks[b];
      add_block({block.id, in_file(FileResults::Of::block, block.id), block.name, {}}, whole.in_block[b]);
    }
    if (whole.in_no_block > 0) add_block({rest, rest, exodus_rest_block, {}}, whole.in_no_block);
    if (!heads_.blocks.empty()) say_rest_block(whole.in_no_block, rest, notices);
    say_exodus_names(heads_, notices);
    define(whole, notices);
  }

  void put(const Mesh& piece, std::span<const Index> node_places, std::span<const Index> hex_places,
           std::span<const std::uint8_t> is_known) {
    put_points(piece, node_places);
    // Hexes by their places.
    std::vector<Index> order(hex_places.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, {}, [&](Index h) { return hex_places[h]; });
    const std::vector<Index> places = items_at(std::vector<Index>(hex_places.begin(), hex_places.end()), order);
    std::vector<int> nodes;
    for_each_run(places, [&](std::size_t part, std::size_t begin, std::size_t n) {
      nodes.clear();
      for (const Index h : std::span(order).subspan(begin, n))
        for (const Index node : in_file_order(piece.hexes[h])) nodes.push_back(node_places[node] + 1);
      out_.check(ex_put_partial_elem_conn(out_.file(), parts_[part].in_file, in_part(part, places[begin]),
                                          static_cast<std::int64_t>(n), nodes.data()));
    });
    put_values(piece, node_places, is_known, places, order);
  }

  std::vector<Vec3> points(std::span<const Index> places) const {
    std::vector<Vec3> points(places.size());
    std::vector<double> values;
    for (int axis = 0; axis < 3; ++axis)
      for_each_node_run(places, [&](std::size_t begin, std::size_t n) {
        values.resize(n);
        std::array<double*, 3> x{};
        x[axis] = values.data();
        out_.check(ex_get_partial_coord(out_.file(), places[begin] + std::int64_t{1}, static_cast<std::int64_t>(n),
                                        x[0], x[1], x[2]));
        for (std::size_t i = 0; i < n; ++i) points[begin + i][axis] = values[i];
      });
    return points;
  }

  void commit() {
    out_.close();
    replacement_.commit();
  }

 private:
  void add_block(ExodusPart part, std::int64_t n) {
    part.in_whole = n;
    first_.push_back(first_.back() + n);
    parts_.push_back(std::move(part));
  }

  void define(const WholeOfPieces& whole, std::vector<std::string>& notices) {
    out_.create(whole.highest_id > highest_narrow_id || values_.are_wide(), static_cast<std::size_t>(first_.back()),
                n_hex_corners);
    std::size_t longest = std::max<std::size_t>(32, values_.longest_name());
    for (const ExodusPart& part : parts_) longest = std::max(longest, part.name.size());
    for (const NodeSet& set : heads_.node_sets) longest = std::max(longest, set.name.size());
    for (const SideSet& set : heads_.side_sets) longest = std::max(longest, set.name.size());
    ex_init_params sizes{};
    sizes.num_nodes = whole.n_nodes;
    sizes.num_elem = first_.back();
    sizes.num_elem_blk = std::ssize(parts_);
    sizes.num_node_sets = std::ssize(heads_.node_sets);
    sizes.num_side_sets = std::ssize(heads_.side_sets);
    out_.put_sizes(sizes, values_.extras().title, longest);
    out_.put_coordinate_names(values_.extras().coordinate_names);
    out_.put_map(EX_NODE_MAP, static_cast<std::size_t>(whole.n_nodes),
                 [&](std::size_t) { return whole.next_node_id(); });
    for (const ExodusPart& part : parts_) out_.put_block(part, "HEX8", part.in_whole, n_hex_corners, 0);
    out_.put_map(EX_ELEM_MAP, static_cast<std::size_t>(first_.back()),
                 [&](std::size_t) { return whole.next_hex_id(); });
    for (const NodeSet& set : heads_.node_sets) {
      std::vector<int> members(set.nodes.begin(), set.nodes.end());
      for (int& node : members) ++node;
      out_.put_set(EX_NODE_SET, in_file(FileResults::Of::node_set, set.id), set.name, members, {}, {});
    }
    for (const SideSet& set : heads_.side_sets) {
      std::vector<int> members, sides;
      for (const Side& side : set.sides) {
        members.push_back(side.hex + 1);
        sides.push_back(exodus_side_of(side.face));
      }
      out_.put_set(EX_SIDE_SET, in_file(FileResults::Of::side_set, set.id), set.name, members, sides, {});
    }
    is_on_.assign(whole.has_values.begin(), whole.has_values.end());
    const ExodusTarget to{out_.file(), heads_, parts_, [this](int status) { out_.check(status); }, notices};
    values_.write_properties(to);
    values_.write_records(to);
    values_.declare_results(to, is_on_);
    values_.put_globals(to, 0);
  }
  std::int64_t in_file(FileResults::Of of, int id) const { return values_.extras().in_file(of, id); }

  /// use(begin, n): of the list.
  template <class Use>
  static void for_each_node_run(std::span<const Index> places, const Use& use) {
    for (std::size_t begin = 0, end = 0; begin < places.size(); begin = end) {
      for (end = begin + 1; end < places.size() && places[end] == places[end - 1] + 1 && end - begin < exodus_piece;)
        ++end;
      use(begin, end - begin);
    }
  }
  /// The same within element blocks; use(block, begin, n).
  template <class Use>
  void for_each_run(std::span<const Index> places, const Use& use) const {
    std::size_t part = 0;
    for (std::size_t begin = 0; begin < places.size();) {
      while (places[begin] >= first_[part + 1]) ++part;
      const auto in_block = places.subspan(begin);
      const auto end = std::ranges::lower_bound(in_block, first_[part + 1]) - in_block.begin();
      for_each_node_run(in_block.first(static_cast<std::size_t>(end)),
                        [&](std::size_t first, std::size_t n) { use(part, begin + first, n); });
      begin += static_cast<std::size_t>(end);
    }
  }
  /// As the library counts.
  std::int64_t in_part(std::size_t part, Index place) const { return place - first_[part] + 1; }

  void put_points(const Mesh& piece, std::span<const Index> places) {
    // All of x, then y, then z, as they lie in the file.
    std::vector<double> values;
    for (int axis = 0; axis < 3; ++axis)
      for_each_node_run(places, [&](std::size_t begin, std::size_t n) {
        values.clear();
        for (std::size_t i = 0; i < n; ++i) values.push_back(piece.points[begin + i][axis]);
        out_.put_coordinates(axis, static_cast<std::size_t>(places[begin]), values);
      });
  }

  void put_values(const Mesh& piece, std::span<const Index> node_places, std::span<const std::uint8_t> is_known,
                  std::span<const Index> places, std::span<const Index> order) {
    std::array<int, 2> variable{};  // on nodes, on hexes
    std::vector<double> values;
    for (const Field& head : heads_.fields) {
      const auto field = std::ranges::find_if(
          piece.fields, [&](const Field& other) { return other.on == head.on && other.name == head.name; });
      const bool is_here = field != piece.fields.end() && field->components == head.components;
      const auto value = [&](Index i, int c) {
        return is_here ? field->values[static_cast<std::size_t>(i) * static_cast<std::size_t>(head.components) +
                                       static_cast<std::size_t>(c)]
                       : std::numeric_limits<double>::quiet_NaN();
      };
      const auto put = [&](ex_entity_type type, int number, std::int64_t id, std::int64_t place) {
        out_.check(ex_put_partial_var(out_.file(), 1, type, number, id, place, std::ssize(values), values.data()));
      };
      for (int c = 0; c < head.components; ++c) {
        const int v = variable[head.on == Field::On::hex]++;
        if (head.on == Field::On::node) {
          for_each_node_run(node_places, [&](std::size_t begin, std::size_t n) {
            const auto put_some = [&](std::size_t from, std::size_t to) {
              values.clear();
              for (std::size_t i = from; i < to; ++i) values.push_back(value(static_cast<Index>(i), c));
              if (!values.empty()) put(EX_NODAL, v + 1, 1, node_places[from] + std::int64_t{1});
            };
            if (is_here) return put_some(begin, begin + n);
            for (std::size_t i = begin; i < begin + n; ++i)
              if (!is_known[i]) put_some(i, i + 1);
          });
          continue;
        }
        const std::size_t n_variables = values_.n_variables(Field::On::hex);
        for_each_run(places, [&](std::size_t part, std::size_t begin, std::size_t n) {
          if (!is_on_[part * n_variables + static_cast<std::size_t>(v)]) return;
          values.clear();
          for (const Index h : order.subspan(begin, n)) values.push_back(value(h, c));
          put(EX_ELEM_BLOCK, v + 1, parts_[part].in_file, in_part(part, places[begin]));
        });
      }
    }
  }

  Replacement replacement_;
  ExodusOutput out_;
  const Mesh& heads_;
  ExodusValues values_;
  std::vector<ExodusPart> parts_;
  std::vector<std::int64_t> first_ = {0};  // places of the hexes of each part
  std::vector<int> is_on_;
};

}  // namespace hextwist::io

namespace hextwist {

class PiecewiseFile::Writer : public io::ExodusPieces {
  using ExodusPieces::ExodusPieces;
};

PiecewiseFile::PiecewiseFile(const std::filesystem::path& file, const WholeOfPieces& whole,
                             std::vector<std::string>& notices)
    : writer_(std::make_unique<Writer>(file, whole, notices)) {}
PiecewiseFile::~PiecewiseFile() = default;
void PiecewiseFile::put(const Mesh& piece, std::span<const Index> node_places, std::span<const Index> hex_places,
                        std::span<const std::uint8_t> is_known) {
  writer_->put(piece, node_places, hex_places, is_known);
}
std::vector<Vec3> PiecewiseFile::points(std::span<const Index> places) const {
  return writer_->points(places);
}
void PiecewiseFile::commit() {
  writer_->commit();
}

}  // namespace hextwist
