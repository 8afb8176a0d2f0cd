// .vtu in slices: of each array what the slice has, as the bytes come by. It becomes a mesh as a file of its own would.
#include <set>

#include "hextwist/base/ranked_bits.h"
#include "hextwist/base/sorted.h"
#include "hextwist/io/group_names.h"
#include "hextwist/io/vtk/vtu_internal.h"

namespace hextwist::io {
namespace {

constexpr int vtk_voxel_cell = 11, vtk_hex_cell = 12;

/// Which items of an array are wanted, ascending.
struct Wanted {
  std::span<const Index> places;  ///< where these are not all from `first` on
  std::size_t first = 0, n = 0;

  std::size_t place(std::size_t i) const { return places.empty() ? first + i : static_cast<std::size_t>(places[i]); }
};

/// Calls use(first number, numbers) for an array, piece after piece, in this machine's order.
template <class Use>
void for_each_number(VtuFile& file, const VtuArray& array, const Use& use) {
  const std::size_t size = vtk_size(array.type);
  std::string rest;  // a number that is in two pieces
  std::size_t first = 0;
  const auto hand_out = [&](std::string_view bytes) {
    Cursor values = file.numbers(bytes);
    VtkArray numbers;
    read_vtk_values(values, array.type, bytes.size() / size, numbers);
    use(first, numbers);
    first += numbers.size();
  };
  constexpr std::size_t most = std::size_t{1} << 16;  // where they have to be turned
  file.for_each_piece(array, [&](std::string_view bytes) {
    while (!bytes.empty()) {
      if (!rest.empty() || bytes.size() < size) {
        const std::size_t more = std::min(size - rest.size(), bytes.size());
        rest += bytes.substr(0, more);
        bytes.remove_prefix(more);
        if (rest.size() < size) return;
        hand_out(rest);
        rest.clear();
        continue;
      }
      const std::size_t whole = std::min(bytes.size(), most) / size * size;
      hand_out(bytes.substr(0, whole));
      bytes.remove_prefix(whole);
    }
  });
}

/// The array without numbers.
VtkArray head_of(const VtuArray& array) {
  VtkArray head;
  head.name = array.head.name;
  head.on = array.head.on;
  head.components = array.head.components;
  return head;
}

/// What is wanted of an array, with so many numbers each.
VtkArray picked(VtuFile& file, const VtuArray& array, const Wanted& wanted, std::size_t width) {
  const std::size_t bytes_each = vtk_size(array.type) * width;
  VtkArray to = head_of(array);
  to.type = array.type;
  to.own.resize((wanted.n * bytes_each + sizeof to.own[0] - 1) / sizeof to.own[0]);
  char* const data = reinterpret_cast<char*>(to.own.data());
  std::size_t i = 0;  // the first item that is not complete yet
  std::size_t begin = 0;
  file.for_each_piece(array, [&](std::string_view bytes) {
    const std::size_t end = begin + bytes.size();
    for (; i < wanted.n; ++i) {
      const std::size_t from = wanted.place(i) * bytes_each, until = from + bytes_each;
      if (from >= end) break;
      const std::size_t low = std::max(from, begin), high = std::min(until, end);
      std::memcpy(data + i * bytes_each + (low - from), bytes.data() + (low - begin), high - low);
      if (until > end) break;
    }
    begin = end;
  });
  Cursor values = file.numbers({data, wanted.n * bytes_each});
  read_vtk_values(values, array.type, wanted.n * width, to);
  return to;
}

bool has_size(VtuFile& file, const VtuArray* array, std::size_t n) {
  return array && !array->is_text && file.n_bytes(*array) == static_cast<std::int64_t>(n * vtk_size(array->type));
}

bool is_integer(const VtuArray& array) {
  return array.type != VtkType::float32 && array.type != VtkType::float64;
}

/// Hexes of eight nodes alone, one after the other.
bool has_only_hexes(VtuFile& file) {
  const std::size_t n = file.n_cells();
  const VtuArray *nodes = file.find("Cells", "connectivity"), *ends = file.find("Cells", "offsets"),
                 *types = file.find("Cells", "types"), *points = file.find("Points");
  if (n == 0 || !has_size(file, nodes, 8 * n) || !has_size(file, ends, n) || !has_size(file, types, n) ||
      !has_size(file, points, 3 * file.n_points()) || !is_integer(*nodes) || !is_integer(*ends) || !is_integer(*types))
    return false;
  bool all = true;
  for_each_number(file, *types, [&](std::size_t, const VtkArray& numbers) {
    numbers.visit([&](auto values) {
      for (std::size_t i = 0; i < values.size(); ++i)
        all = all && (static_cast<std::int64_t>(values[i]) == vtk_hex_cell ||
                      static_cast<std::int64_t>(values[i]) == vtk_voxel_cell);
    });
  });
  for_each_number(file, *ends, [&](std::size_t first, const VtkArray& numbers) {
    numbers.visit([&](auto values) {
      for (std::size_t i = 0; i < values.size(); ++i)
        all = all && static_cast<std::uint64_t>(values[i]) == 8 * (first + i + 1);
    });
  });
  return all;
}

/// "curve_edges" of "hextwist:curve_edges", "block" of "hextwist:block 3 steel".
std::string_view kind_of(const VtuArray& array) {
  std::string_view name = array.head.name;
  if (array.head.on != VtkArray::On::file || !name.starts_with("hextwist:")) return {};
  name.remove_prefix(9);
  return name.substr(0, name.find(' '));
}

std::vector<std::string> made_in(VtuFile& file) {
  std::vector<std::string> names;
  for (const VtuArray& array : file.arrays())
    for (std::string& name : made_names(array.head.on, array.head.name)) names.push_back(std::move(name));
  return names;
}

/// The ids that we have written, null where the file has none.
const VtuArray* id_array(VtuFile& file, const char* section, std::string_view usual) {
  const std::vector<std::string> made = made_in(file);
  const auto name = std::ranges::find_if(made, [&](const std::string& one) { return is_made(one, usual); });
  const VtuArray* const array = name == made.end() ? nullptr : file.find(section, *name);
  return array && is_integer(*array) ? array : nullptr;
}

std::int64_t highest_node_id(VtuFile& file) {
  const VtuArray* const ids = id_array(file, "PointData", "node_id");
  if (!ids) return static_cast<std::int64_t>(file.n_points());
  std::int64_t highest = 0;
  for_each_number(file, *ids, [&](std::size_t, const VtkArray& numbers) {
    std::vector<std::int64_t> values(numbers.size());
    numbers.copy(0, values);
    for (const std::int64_t id : values) highest = std::max(highest, id);
  });
  return highest;
}

/// Rows of an array of ours that name nodes or hexes: how many numbers each has, and how many of them name one.
struct Rows {
  std::size_t width = 0, n_named = 0;
  bool of_nodes = false;
};
std::optional<Rows> rows_of(std::string_view kind) {
  if (kind == "curve_edges") return Rows{3, 2, true};
  if (kind == "surface_faces") return Rows{3, 1, false};
  if (kind == "block") return Rows{1, 1, false};
  if (kind == "nodeset") return Rows{1, 1, true};
  if (kind == "sideset") return Rows{2, 1, false};
  return std::nullopt;
}

class VtuSlice {
 public:
  VtuSlice(VtuFile& file, int number, int n) : file_(file), is_here_(file.n_points()) {
    const auto n_cells = static_cast<std::int64_t>(file.n_cells());
    first_ = static_cast<std::size_t>(n_cells * number / n);
    n_hexes_ = static_cast<std::size_t>(n_cells * (number + 1) / n) - first_;
  }

  MeshSlice result() {
    cells();
    contents_.points = vtk_points(picked(file_, *file_.find("Points"), nodes(), 3), file_.cursor());
    contents_.notices = file_.notices();
    contents_.old_lagrange = file_.old_lagrange();
    ours_ = !made_in(file_).empty();
    for (const VtuArray& array : file_.arrays())
      if (array.section != "Points" && array.section != "Cells") add(array);
    has_ids_ = {id_array(file_, "PointData", "node_id") != nullptr, id_array(file_, "CellData", "hex_id") != nullptr};
    if (!ours_) find_blocks();
    MeshSlice slice;
    if (n_hexes_ > 0) slice.file = assemble_vtk(std::move(contents_), file_.cursor());
    Mesh& mesh = slice.file.mesh;
    if (!has_ids_[0])
      for (const Index place : places_) mesh.node_ids.push_back(place + std::int64_t{1});
    if (!has_ids_[1])
      for (std::size_t h = 0; h < n_hexes_; ++h) mesh.hex_ids.push_back(static_cast<std::int64_t>(first_ + h) + 1);
    for (const int id : block_ids_)
      if (position_in(mesh.blocks, id, &Block::id) < 0) group_of_id(mesh.blocks, id);
    return slice;
  }

 private:
  Wanted nodes() const { return {places_, 0, places_.size()}; }
  Wanted hexes() const { return {{}, first_, n_hexes_}; }

  void cells() {
    const VtkArray all = picked(file_, *file_.find("Cells", "connectivity"), hexes(), n_hex_corners);
    std::vector<std::int64_t> nodes(n_hex_corners * n_hexes_);
    all.copy(0, nodes);
    const auto n_points = static_cast<std::int64_t>(file_.n_points());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i] < 0 || nodes[i] >= n_points)
        throw Error(std::string(file_.cursor().name) + ": cell " + std::to_string(first_ + i / n_hex_corners + 1) +
                    " names point " + std::to_string(nodes[i]) + " of " + std::to_string(n_points) +
                    " (counted from 0)");
      is_here_.set(static_cast<Index>(nodes[i]));
    }
    is_here_.finish();
    places_ = is_here_.list();
    std::vector<std::int64_t> ends;
    for (std::int64_t& node : nodes) node = is_here_[static_cast<Index>(node)];
    for (std::size_t h = 1; h <= n_hexes_; ++h) ends.push_back(static_cast<std::int64_t>(n_hex_corners * h));
    set_integers(contents_.connectivity, nodes);
    set_integers(contents_.ends, ends);
    contents_.types = picked(file_, *file_.find("Cells", "types"), hexes(), 1);
  }

  void add(const VtuArray& array) {
    if (array.head.on == VtkArray::On::node || array.head.on == VtkArray::On::cell) {
      const bool on_nodes = array.head.on == VtkArray::On::node;
      contents_.arrays.push_back(
          picked(file_, array, on_nodes ? nodes() : hexes(), static_cast<std::size_t>(array.head.components)));
      return;
    }
    if (const std::optional<Rows> rows = rows_of(kind_of(array)); rows && ours_ && is_integer(array))
      return add_rows(array, *rows);
    contents_.arrays.push_back(head_of(array));  // only its name is looked at
  }
  /// -1 where it is elsewhere.
  std::int64_t hex_here(std::int64_t place) const {
    const std::int64_t here = place - static_cast<std::int64_t>(first_);
    return here < static_cast<std::int64_t>(n_hexes_) ? std::max<std::int64_t>(here, -1) : -1;
  }
  /// Rows whose nodes or hexes are here, by their numbers here.
  void add_rows(const VtuArray& array, const Rows& rows) {
    std::vector<std::int64_t> kept, row, piece;
    const auto n_all = static_cast<std::int64_t>(rows.of_nodes ? file_.n_points() : file_.n_cells());
    for_each_number(file_, array, [&](std::size_t, const VtkArray& numbers) {
      piece.resize(numbers.size());
      numbers.copy(0, piece);
      for (const std::int64_t value : piece) {
        row.push_back(value);
        if (row.size() <= rows.n_named && (value < 0 || value >= n_all))
          throw Error(std::string(file_.cursor().name) + ": '" + array.head.name + "' has an entry " +
                      std::to_string(value));
        if (row.size() < rows.width) continue;
        bool is_here = true;
        for (std::size_t k = 0; k < rows.n_named; ++k) {
          row[k] = rows.of_nodes ? position_in(places_, static_cast<Index>(row[k]))
                   : static_cast<std::size_t>(row[k]) - first_ < n_hexes_ ? row[k] - static_cast<std::int64_t>(first_)
                                                                          : std::int64_t{-1};
          is_here = is_here && row[k] >= 0;
        }
        if (is_here) kept.insert(kept.end(), row.begin(), row.end());
        row.clear();
      }
    });
    VtkArray to = head_of(array);
    set_integers(to, kept);
    contents_.arrays.push_back(std::move(to));
  }

  /// Blocks that other people's files have, also where this slice has nothing of them.
  void find_blocks() {
    for (const std::string_view name : vtk_group_arrays) {
      const VtuArray* const array = file_.find("CellData", name);
      if (!array || array->head.components != 1) continue;
      std::set<int> ids;
      for_each_number(file_, *array, [&](std::size_t, const VtkArray& numbers) {
        int last = 0;
        for (std::size_t i = 0; i < numbers.size(); ++i)
          if (const int id = vtk_group(numbers.real(i)); id != last && id > 0) ids.insert(last = id);
      });
      block_ids_.assign(ids.begin(), ids.end());
      return;
    }
  }

  VtuFile& file_;
  std::size_t first_ = 0, n_hexes_ = 0;
  bool ours_ = false;          // the file is one that we have written
  RankedBits is_here_;         // its nodes in the file
  std::vector<Index> places_;  // of these
  VtkContents contents_;
  std::array<bool, 2> has_ids_ = {false, false};  // nodes, hexes: in the file
  std::vector<int> block_ids_;
};

Unsliced against_slices(VtuFile& file) {
  constexpr std::size_t most = std::numeric_limits<Index>::max();
  if (file.n_points() > most || file.n_cells() > most) return {"more than 2147483647 points or cells"};
  if (!file.fits_unpacked()) return {"arrays that are larger than the file can hold"};
  const std::string text = "arrays as text";
  for (const VtuArray& array : file.arrays()) {
    const std::string called = " (array '" + array.head.name + "')";
    const bool is_of_file =
        array.head.on == VtkArray::On::file && array.section != "Points" && array.section != "Cells";
    if (array.head.global_ids) return {"what VTK calls global ids" + called, true};
    if (kind_of(array).starts_with("other_")) return {"other elements than hexes" + called};
    if (is_of_file && rows_of(kind_of(array)) && (array.is_text || !is_integer(array)))
      return {(array.is_text ? text : "members that are not integers") + called, array.is_text};
    const std::size_t n = array.section == "PointData" ? file.n_points() : file.n_cells();
    if ((array.section == "PointData" || array.section == "CellData") &&
        !has_size(file, &array, n * static_cast<std::size_t>(array.head.components)))
      return {(array.is_text ? text : "another number of values than points or cells") + called, array.is_text};
    if ((array.section == "Points" || array.section == "Cells") && array.is_text) return {text + called, true};
  }
  return has_only_hexes(file) ? Unsliced() : Unsliced{"other elements than hexes of 8 nodes"};
}

}  // namespace

std::optional<SlicedFile> vtu_in_slices(const std::filesystem::path& path, Unsliced& why) {
  const Bytes bytes = read_bytes(path);
  VtuFile file(bytes);
  why = against_slices(file);
  if (!why.what.empty()) return std::nullopt;
  return SlicedFile{path, static_cast<std::int64_t>(file.n_points()), static_cast<std::int64_t>(file.n_cells()),
                    highest_node_id(file)};
}

MeshSlice read_vtu_slice(const SlicedFile& sliced, int number, int n) {
  const Bytes bytes = read_bytes(sliced.file);
  VtuFile file(bytes);
  if (static_cast<std::int64_t>(file.n_points()) != sliced.n_nodes ||
      static_cast<std::int64_t>(file.n_cells()) != sliced.n_hexes || !has_only_hexes(file))
    throw Error(sliced.file.string() + ": was changed while it was read");
  return VtuSlice(file, number, n).result();
}

}  // namespace hextwist::io
