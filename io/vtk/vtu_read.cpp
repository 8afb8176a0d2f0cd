// VTK's XML unstructured grids: text, base64 and raw arrays, in place or appended, plain or zlib-compressed.
#include <zlib.h>

#include <map>
#include <optional>

#include "hextwist/io/vtk/tags_internal.h"
#include "hextwist/io/vtk/vtk_internal.h"

namespace hextwist::io {
namespace {

constexpr std::string_view sections[] = {"FieldData", "PointData", "CellData", "Points", "Cells"};

/// Bytes of base64 text from a place on, up to its padding, another character, or the group of four that completes
/// `n` bytes.
std::string decoded(const char*& at, const char* end, std::size_t n = std::string::npos) {
  const auto value = [](char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
  };
  std::string bytes;
  unsigned bits = 0;
  int n_bits = 0;
  for (; at < end && !(bytes.size() >= n && n_bits == 0); ++at) {
    if (Cursor::blank(*at)) continue;
    const int v = value(*at);
    if (v < 0) break;
    bits = bits << 6 | static_cast<unsigned>(v);
    n_bits += 6;
    if (n_bits < 8) continue;
    n_bits -= 8;
    bytes += static_cast<char>(bits >> n_bits & 255);
  }
  while (at < end && *at == '=') ++at;
  return bytes;
}

class VtuReader {
 public:
  explicit VtuReader(const Bytes& bytes) : cursor_(bytes) {}

  MeshFile result() {
    find_appended();
    while (const auto tag = next_tag()) {
      if (tag->name == "VTKFile" && !tag->closing)
        header(*tag), out_.old_lagrange = (*tag)["version"] < "2.1";
      else if (tag->name == "AppendedData")
        break;
      else if (tag->name == "Piece" && !tag->closing)
        piece(*tag);
      else if (tag->name == "DataArray" && !tag->closing)
        array(*tag);
      else if (std::ranges::find(sections, tag->name) != std::end(sections)) {
        section_ = tag->closing ? "" : tag->name;
        global_ids_ = (*tag)["GlobalIds"];
      }
    }
    if (!is_grid_) cursor_.fail_at(cursor_.begin, "not a VTK XML file");
    finish();
    return assemble_vtk(std::move(out_), cursor_);
  }

 private:
  /// Appended data can hold anything, also what looks like a tag: it is found first and cut off.
  void find_appended() {
    std::string_view all(cursor_.at, cursor_.left());
    const auto start = all.find("<AppendedData");
    if (start == std::string_view::npos) return;
    const auto underscore = all.find('_', all.find('>', start));
    if (underscore == std::string_view::npos) cursor_.fail_truncated("appended data");
    appended_ = all.substr(underscore + 1);
    appended_base64_ = all.substr(start, underscore - start).find("base64") != std::string_view::npos;
    tags_end_ = all.data() + start;
  }

  std::optional<Tag> next_tag() { return io::next_tag(cursor_, tags_end_ ? tags_end_ : cursor_.end); }

  void header(const Tag& tag) {
    if (tag["type"] != "UnstructuredGrid")
      cursor_.fail_at(tag.at, "a file of type " + shown(tag["type"]) + "; only UnstructuredGrid is read");
    is_grid_ = true;
    const bool little = tag["byte_order"] != "BigEndian";
    swapped_ = little != (std::endian::native == std::endian::little);
    wide_header_ = tag["header_type"] == "UInt64";
    if (const auto compressor = tag["compressor"]; !compressor.empty()) {
      if (compressor != "vtkZLibDataCompressor")
        cursor_.fail_at(tag.at, "data compressed by " + shown(compressor) + "; only vtkZLibDataCompressor is known");
      compressed_ = true;
    }
  }

  void piece(const Tag& tag) {
    if (++n_pieces_ > 1) cursor_.fail_at(tag.at, "a second piece; only files of one piece are read");
    const auto number = [&](std::string_view key) {
      std::int64_t n = -1;
      const auto text = tag[key];
      std::from_chars(text.data(), text.data() + text.size(), n);
      if (n < 0) cursor_.fail_at(tag.at, "a piece without " + std::string(key));
      return cursor_.check_count(n, 0, key);
    };
    n_points_ = number("NumberOfPoints");
    n_cells_ = number("NumberOfCells");
  }

  void array(const Tag& tag) {
    VtkArray array;
    array.name = tag["Name"];
    array.on = section_ == "PointData"  ? VtkArray::On::node
               : section_ == "CellData" ? VtkArray::On::cell
                                        : VtkArray::On::file;
    array.global_ids = !global_ids_.empty() && array.name == global_ids_;
    if (const auto n = tag["NumberOfComponents"]; !n.empty())
      std::from_chars(n.data(), n.data() + n.size(), array.components);
    if (array.components < 1 || array.components > 1000)
      cursor_.fail_at(tag.at, "array " + shown(array.name) + " has no components");
    const std::string section(section_);
    std::string text;  // in place
    if (!tag.empty) text = content();
    if (tag["type"] == "String") {
      out_.notices.push_back("left out array '" + array.name + "' of texts");
    } else {
      const VtkType type = vtk_type(tag["type"], cursor_);
      if (tag["format"] == "ascii")
        from_text(text, type, array);
      else if (tag["format"] == "binary")
        from_bytes(text, true, type, array);
      else if (tag["format"] == "appended")
        from_bytes(appended_at(tag), appended_base64_, type, array);
      else
        cursor_.fail_at(tag.at, "array " + shown(array.name) + " in format " + shown(tag["format"]));
      const auto once = [&](bool there) {
        if (there) cursor_.fail_at(tag.at, "a second array " + shown(array.name) + " of " + section);
      };
      if (section == "Points") {
        once(points_.size() > 0);
        points_ = std::move(array);
      } else if (section == "Cells") {
        once(cells_.contains(array.name));
        cells_[array.name] = std::move(array);
      } else
        out_.arrays.push_back(std::move(array));
    }
  }

  /// Text up to </DataArray>, without what other tags hold (InformationKey).
  std::string content() {
    std::string text;
    int depth = 0;
    for (;;) {
      const char* from = cursor_.at;
      const auto tag = next_tag();
      if (!tag) cursor_.fail_truncated("</DataArray>");
      if (depth == 0) text.append(from, tag->at);
      if (tag->name == "DataArray" && tag->closing) return text;
      depth += tag->closing ? -1 : tag->empty ? 0 : 1;
    }
  }

  std::string_view appended_at(const Tag& tag) const {
    std::size_t offset = 0;
    const auto text = tag["offset"];
    const bool good = std::from_chars(text.data(), text.data() + text.size(), offset).ec == std::errc{};
    if (!good || offset >= appended_.size())
      cursor_.fail_at(tag.at, "the appended data ends before " + shown(tag["Name"]));
    return appended_.substr(offset);
  }

  void from_text(const std::string& text, VtkType type, VtkArray& to) const {
    const std::string name = std::string(cursor_.name) + ", array " + shown(to.name);
    Cursor words(text, name);
    read_vtk_text(words, type, {}, to);
  }

  /// The bytes of an array: a size, then data; or, compressed, the number and sizes of blocks, then those.
  void from_bytes(std::string_view source, bool base64, VtkType type, VtkArray& to) {
    const auto truncated = [&] { cursor_.fail_truncated("the data of array " + shown(to.name)); };
    const std::size_t word = wide_header_ ? 8 : 4;
    const char* at = source.data();
    const char* end = source.data() + source.size();
    std::string stream;  // what base64 holds from here on
    const auto take = [&](std::size_t n) {
      std::string_view part;
      if (base64) {
        if (n > stream.size()) truncated();
        part = std::string_view(stream).substr(0, n);
      } else {
        if (n > static_cast<std::size_t>(end - at)) truncated();
        part = {at, n};
        at += n;
      }
      return part;
    };
    const auto number = [&](std::string_view bytes, std::size_t i) {
      Cursor numbers = binary(bytes);
      numbers.at += i * word;
      return wide_header_ ? numbers.raw<std::uint64_t>("a size") : std::uint64_t{numbers.raw<std::uint32_t>("a size")};
    };
    std::string data;
    std::string_view bytes;
    if (!compressed_) {
      if (base64) stream = decoded(at, end);
      const std::uint64_t n = number(take(word), 0);
      if (base64) {
        if (n > stream.size() - word) truncated();
        bytes = std::string_view(stream).substr(word, n);
      } else {
        bytes = take(n);
      }
    } else {
      // In base64 the sizes are encoded on their own.
      const char* start = at;
      if (base64) stream = decoded(at, end, word);
      const std::uint64_t n_blocks = number(take(word), 0);
      if (n_blocks > source.size() / word) truncated();
      at = start;
      if (base64) stream = decoded(at, end, (3 + n_blocks) * word);
      const std::string sizes(take((3 + n_blocks) * word));
      const std::uint64_t block = number(sizes, 1), last = number(sizes, 2);
      if (base64) stream = decoded(at, end);
      std::size_t used = 0;
      for (std::uint64_t b = 0; b < n_blocks; ++b) {
        const std::uint64_t n = number(sizes, 3 + b), plain = b + 1 == n_blocks && last > 0 ? last : block;
        std::string_view packed;
        if (base64) {
          if (used > stream.size() || n > stream.size() - used) truncated();
          packed = std::string_view(stream).substr(used, n);
          used += n;
        } else {
          packed = take(n);
        }
        if (plain / 1100 > packed.size() + 1) cursor_.fail("array " + shown(to.name) + " has impossible sizes");
        const std::size_t before = data.size();
        data.resize(before + plain);
        uLongf size = plain;
        if (uncompress(reinterpret_cast<Bytef*>(data.data() + before), &size,
                       reinterpret_cast<const Bytef*>(packed.data()), packed.size()) != Z_OK ||
            size != plain)
          cursor_.fail("array " + shown(to.name) + " cannot be uncompressed");
      }
      bytes = data;
    }
    Cursor values = binary(bytes);
    read_vtk_values(values, type, bytes.size() / vtk_size(type), to);
    if (base64 || compressed_) to.keep();
    // Arrays may share what they are unpacked from; zlib packs 1 to 1100 at best.
    if (base64 || compressed_) n_unpacked_ += bytes.size();
    if (n_unpacked_ / 1100 > static_cast<std::size_t>(cursor_.end - cursor_.begin))
      cursor_.fail("the arrays hold more than the file can");
  }
  Cursor binary(std::string_view bytes) const {
    Cursor cursor(bytes, cursor_.name);
    cursor.binary = true;
    cursor.swapped = swapped_;
    return cursor;
  }

  void finish() {
    if (points_.size() != 3 * n_points_)
      cursor_.fail_at(cursor_.end,
                      std::to_string(points_.size()) + " coordinates for " + std::to_string(n_points_) + " points");
    out_.points = vtk_points(points_, cursor_);
    const auto cells = [&](const char* name) -> VtkArray&& {
      VtkArray& array = cells_[name];
      if (!array.is_integer()) cursor_.fail_at(cursor_.end, std::string(name) + " are not integers");
      return std::move(array);
    };
    out_.connectivity = cells("connectivity");
    out_.ends = cells("offsets");
    out_.types = cells("types");
    if (out_.types.size() != n_cells_ || out_.ends.size() != n_cells_)
      cursor_.fail_at(cursor_.end, "offsets or types do not fit " + std::to_string(n_cells_) + " cells");
  }

  Cursor cursor_;
  VtkContents out_;
  VtkArray points_;
  std::map<std::string, VtkArray> cells_;
  std::string_view section_;
  std::string global_ids_;  // name of the array in this section that is ids
  std::string_view appended_;
  const char* tags_end_ = nullptr;
  bool appended_base64_ = false, is_grid_ = false, swapped_ = false, wide_header_ = false, compressed_ = false;
  int n_pieces_ = 0;
  std::size_t n_points_ = 0, n_cells_ = 0, n_unpacked_ = 0;
};

}  // namespace

MeshFile read_vtu(const Bytes& bytes) {
  return VtuReader(bytes).result();
}

}  // namespace hextwist::io
