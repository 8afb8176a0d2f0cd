// VTK's legacy files, versions 1.0 to 5.1, text and binary, unstructured grids (VTK User's Guide, "VTK file formats").
#include <optional>

#include "hextwist/io/vtk/vtk_internal.h"

namespace hextwist::io {
namespace {

class LegacyReader {
 public:
  explicit LegacyReader(const Bytes& bytes) : cursor_(bytes) {}

  MeshFile result() {
    header();
    while (cursor_.more()) section();
    if (out_.types.size() == 0) cursor_.fail_at(cursor_.end, "the file ends without cells");
    if (out_.ends.size() != out_.types.size())
      cursor_.fail_at(cursor_.end, std::to_string(out_.types.size()) + " cell types for " +
                                       std::to_string(out_.ends.size()) + " cells");
    MeshFile file = assemble_vtk(std::move(out_), cursor_);
    if (!cursor_.binary && !cursor_.last_line_ends())
      file.notices.push_back(cursor_.where(cursor_.end) + ": the last line has no end; the file may be cut short");
    return file;
  }

 private:
  void header() {
    constexpr std::string_view mark = "# vtk DataFile Version ";
    const std::string_view first = cursor_.line();
    if (!first.starts_with(mark))
      cursor_.fail_at(cursor_.begin, "not a VTK file: it does not begin with '# vtk DataFile'");
    const std::string_view version = trimmed(first.substr(mark.size()));
    if (version.empty() || version[0] < '1' || version[0] > '5')
      cursor_.fail_at(cursor_.begin, "version " + shown(version) + " is not known, 1.0 to 5.1 are");
    out_.old_lagrange = version < "5.1";
    cursor_.line();
    const char* at = cursor_.at;
    std::string_view mode = trimmed(cursor_.line());
    while (mode.empty() && cursor_.at < cursor_.end) {
      at = cursor_.at;
      mode = trimmed(cursor_.line());
    }
    if (!same_word(mode, "ASCII") && !same_word(mode, "BINARY"))
      cursor_.fail_at(at, "expected ASCII or BINARY, found " + shown(mode));
    cursor_.binary = same_word(mode, "BINARY");
    cursor_.swapped = cursor_.binary && std::endian::native == std::endian::little;
  }

  /// Values of an array, in the file's mode.
  void values(std::string_view type, std::size_t n, VtkArray& to) {
    if (same_word(type, "bit")) cursor_.fail("arrays of type " + std::string(type) + " are not supported");
    const VtkType number = same_word(type, "vtkIdType") && !cursor_.binary ? VtkType::int64 : vtk_type(type, cursor_);
    cursor_.binary ? read_vtk_values(cursor_, number, n, to) : read_vtk_text(cursor_, number, n, to);
  }
  std::size_t count(std::string_view what, std::size_t bytes = 1) {
    return cursor_.check_count(cursor_.integer("the number of " + std::string(what)), bytes, what);
  }

  void section() {
    const char* at = cursor_.at;
    const std::string word = upper(cursor_.word());
    if (word == "DATASET" || word == "POINTS" || word == "CELLS" || word == "CELL_TYPES") {
      if (std::ranges::find(seen_, word) != seen_.end()) cursor_.fail_at(at, "a second " + word);
      seen_.push_back(word);
    }
    if (word == "DATASET") {
      if (const auto kind = upper(cursor_.word()); kind != "UNSTRUCTURED_GRID")
        cursor_.fail_at(at, "data set " + shown(kind) + "; only UNSTRUCTURED_GRID is read");
    } else if (word == "POINTS") {
      VtkArray array;
      array.name = "POINTS";
      const auto n = count("points", 3);
      const std::string type(cursor_.word());
      cursor_.line();
      values(type, 3 * n, array);
      out_.points = vtk_points(array, cursor_);
    } else if (word == "CELLS") {
      cells(at);
    } else if (word == "CELL_TYPES") {
      const auto n = count("cell types");
      cursor_.line();
      values("int", n, out_.types);
    } else if (word == "CELL_DATA" || word == "POINT_DATA") {
      on_ = word == "CELL_DATA" ? VtkArray::On::cell : VtkArray::On::node;
      n_ = count("values");
      cursor_.line();
    } else if (word == "METADATA") {
      // Up to an empty line.
      cursor_.line();
      while (cursor_.at < cursor_.end && !trimmed(cursor_.line()).empty()) {
      }
    } else {
      attribute(word, at);
    }
  }

  void cells(const char* at) {
    const auto first = count("cells"), second = count("cell numbers");
    cursor_.line();
    const std::string_view rest(cursor_.at, cursor_.left());
    VtkArray array;
    array.name = "CELLS";
    if (rest.starts_with("OFFSETS")) {  // 5.1
      cursor_.word();
      const std::string offset_type(cursor_.word());
      cursor_.line();
      values(offset_type, first, out_.ends);
      cursor_.skip_blanks();
      if (cursor_.word() != "CONNECTIVITY") cursor_.fail_at(at, "expected CONNECTIVITY after OFFSETS");
      const std::string type(cursor_.word());
      cursor_.line();
      values(type, second, array);
      if (!array.is_integer() || !out_.ends.is_integer()) cursor_.fail_at(at, "the numbers of cells are not integers");
      if (out_.ends.size() == 0 || out_.ends.integer(0) != 0 ||
          out_.ends.integer(out_.ends.size() - 1) != static_cast<std::int64_t>(array.size()))
        cursor_.fail_at(at, "the offsets of cells do not fit");
      out_.ends.drop_first();
      out_.connectivity = std::move(array);
      return;
    }
    values("int", second, array);
    std::vector<std::int64_t> nodes, ends;
    array.visit([&](auto numbers) {
      nodes.reserve(numbers.size());
      ends.reserve(first);
      std::size_t i = 0;
      for (std::size_t cell = 0; cell < first; ++cell) {
        const auto n = i < numbers.size() ? static_cast<std::int64_t>(numbers[i]) : -1;
        if (n < 0 || static_cast<std::size_t>(n) > numbers.size() - i - 1)
          cursor_.fail_at(at, "cell " + std::to_string(cell + 1) + " does not fit in the list of cells");
        for (std::size_t k = 1; k <= static_cast<std::size_t>(n); ++k)
          nodes.push_back(static_cast<std::int64_t>(numbers[i + k]));
        i += static_cast<std::size_t>(n) + 1;
        ends.push_back(std::ssize(nodes));
      }
    });
    set_integers(out_.connectivity, nodes);
    set_integers(out_.ends, ends);
  }

  /// Names have blanks and the like as %20.
  static std::string decoded(std::string_view name) {
    std::string result;
    for (std::size_t i = 0; i < name.size(); ++i) {
      int code = 0;
      if (name[i] == '%' && i + 2 < name.size() &&
          std::from_chars(name.data() + i + 1, name.data() + i + 3, code, 16).ptr == name.data() + i + 3) {
        result += static_cast<char>(code);
        i += 2;
      } else {
        result += name[i];
      }
    }
    return result;
  }
  static std::string upper(std::string_view text) {
    std::string result(text);
    for (char& c : result)
      if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 32);
    return result;
  }

  void add(VtkArray&& array, std::string_view type, std::size_t n) {
    if (array.components < 1 || array.components > 1000)
      cursor_.fail("array " + shown(array.name) + " has " + std::to_string(array.components) + " components");
    array.on = on_;
    if (same_word(type, "string")) return skip_strings(array.name, n * static_cast<std::size_t>(array.components));
    values(type, n * static_cast<std::size_t>(array.components), array);
    out_.arrays.push_back(std::move(array));
  }

  /// A line each; binary: a length each, of one to eight bytes, which its first two bits say, and the characters.
  void skip_strings(const std::string& name, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
      if (cursor_.left() == 0) cursor_.fail_truncated("the texts of " + shown(name));
      if (!cursor_.binary) {
        cursor_.line();
        continue;
      }
      const auto byte = [&] { return std::uint64_t{cursor_.raw<std::uint8_t>("the length of a text")}; };
      const std::uint64_t first = byte();
      std::uint64_t length = first & 0x3f;
      for (std::uint64_t k = (std::uint64_t{8} >> (first >> 6)); k > 1; --k) length = length << 8 | byte();
      if (length > cursor_.left()) cursor_.fail_truncated("the texts of " + shown(name));
      cursor_.at += length;
    }
    out_.notices.push_back("left out array '" + name + "' of texts");
  }

  void attribute(const std::string& word, const char* at) {
    VtkArray array;
    if (word == "FIELD") {
      cursor_.word();
      const auto n_arrays = count("arrays");
      for (std::size_t i = 0; i < n_arrays; ++i) {
        VtkArray one;
        one.name = decoded(cursor_.word());
        if (one.name == "METADATA") {
          cursor_.line();
          while (cursor_.at < cursor_.end && !trimmed(cursor_.line()).empty()) {
          }
          one.name = decoded(cursor_.word());
        }
        one.components = cursor_.small("the number of components");
        const auto n = count("tuples", 0);
        const std::string type(cursor_.word());
        cursor_.line();
        const auto kept = on_;
        if (!n_) on_ = VtkArray::On::file;  // before POINT_DATA: of the whole file
        add(std::move(one), type, n);
        on_ = kept;
      }
      return;
    }
    array.name = decoded(cursor_.word());
    if (word == "LOOKUP_TABLE") {
      const auto n = count("colours");
      cursor_.line();
      values(cursor_.binary ? "unsigned_char" : "float", 4 * n, array);
      return;
    }
    if (!n_) cursor_.fail_at(at, "expected a section, found " + shown(word));
    std::string type;
    if (word == "SCALARS") {
      type = cursor_.word();
      const std::string_view rest = trimmed(cursor_.line());
      if (!rest.empty()) std::from_chars(rest.data(), rest.data() + rest.size(), array.components);
      if (std::string_view(cursor_.at, cursor_.left()).starts_with("LOOKUP_TABLE")) cursor_.line();
    } else if (word == "COLOR_SCALARS") {
      array.components = cursor_.small("the number of components");
      type = cursor_.binary ? "unsigned_char" : "float";
      cursor_.line();
    } else if (word == "TEXTURE_COORDINATES") {
      array.components = cursor_.small("the number of components");
      type = cursor_.word();
      cursor_.line();
    } else {
      const std::pair<std::string_view, int> known[] = {{"VECTORS", 3},  {"NORMALS", 3},    {"TENSORS", 9},
                                                        {"TENSORS6", 6}, {"GLOBAL_IDS", 1}, {"PEDIGREE_IDS", 1}};
      const auto found = std::ranges::find(known, word, &std::pair<std::string_view, int>::first);
      if (found == std::end(known)) cursor_.fail_at(at, "expected a section, found " + shown(word));
      array.components = found->second;
      array.global_ids = word == "GLOBAL_IDS";
      type = cursor_.word();
      cursor_.line();
    }
    add(std::move(array), type, *n_);
  }

  Cursor cursor_;
  VtkContents out_;
  VtkArray::On on_ = VtkArray::On::node;
  std::vector<std::string> seen_;  // sections that a file has once
  std::optional<std::size_t> n_;   // of the POINT_DATA or CELL_DATA at hand
};

}  // namespace

MeshFile read_vtk(const Bytes& bytes) {
  return LegacyReader(bytes).result();
}

}  // namespace hextwist::io
