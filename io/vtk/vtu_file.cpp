// Tags and bytes of VTK's XML files: text, base64 and raw arrays, in place or appended, plain or zlib-compressed.
#include <zlib.h>

#include "hextwist/io/vtk/vtu_internal.h"

namespace hextwist::io {
namespace {

constexpr std::string_view vtu_sections[] = {"FieldData", "PointData", "CellData", "Points", "Cells"};
constexpr std::uint64_t most_packed = 1100;  // bytes that zlib packs in one, at best

int base64_value(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

}  // namespace

/// Bytes one after the other, raw or from base64 text.
class VtuFile::Stream {
 public:
  explicit Stream(const VtuArray& array)
      : at_(array.source.data()), end_(at_ + array.source.size()), is_base64_(array.is_base64) {}

  /// The next n bytes; empty where there are less. Valid up to the next call.
  std::optional<std::string_view> take(std::size_t n) {
    if (n > static_cast<std::size_t>(end_ - at_)) return std::nullopt;
    if (!is_base64_) {
      at_ += n;
      return std::string_view(at_ - n, n);
    }
    bytes_.clear();
    bytes_.reserve(n);
    while (bytes_.size() < n) {
      if (!more()) return std::nullopt;
      n_bits_ -= 8;
      bytes_ += static_cast<char>(bits_ >> n_bits_ & 255);
    }
    return bytes_;
  }
  /// What is encoded on its own ends here: its last group of four and the padding.
  void end_part() {
    if (!is_base64_) return;
    for (; n_bits_ > 0 && at_ < end_ && base64_value(*at_) >= 0; ++at_) n_bits_ = (n_bits_ + 6) % 8;
    n_bits_ = 0;
    while (at_ < end_ && *at_ == '=') ++at_;
  }

 private:
  /// Whether there are eight bits.
  bool more() {
    for (; n_bits_ < 8; ++at_) {
      if (at_ == end_) return false;
      if (Cursor::blank(*at_)) continue;
      const int value = base64_value(*at_);
      if (value < 0) return false;
      bits_ = bits_ << 6 | static_cast<unsigned>(value);
      n_bits_ += 6;
    }
    return true;
  }

  const char* at_;
  const char* end_;
  bool is_base64_;
  unsigned bits_ = 0;
  int n_bits_ = 0;
  std::string bytes_;
};

VtuFile::VtuFile(const Bytes& bytes) : cursor_(bytes) {
  find_appended();
  while (const auto tag = next_tag()) {
    if (tag->name == "VTKFile" && !tag->closing)
      header(*tag);
    else if (tag->name == "AppendedData")
      break;
    else if (tag->name == "Piece" && !tag->closing)
      piece(*tag);
    else if (tag->name == "DataArray" && !tag->closing)
      declare(*tag);
    else if (std::ranges::find(vtu_sections, tag->name) != std::end(vtu_sections)) {
      section_ = tag->closing ? "" : tag->name;
      global_ids_ = (*tag)["GlobalIds"];
    }
  }
  if (!is_grid_) cursor_.fail_at(cursor_.begin, "not a VTK XML file");
}

/// Appended data can hold anything, also what looks like a tag: it is found first and cut off.
void VtuFile::find_appended() {
  const std::string_view all(cursor_.at, cursor_.left());
  const auto start = all.find("<AppendedData");
  if (start == std::string_view::npos) return;
  const auto underscore = all.find('_', all.find('>', start));
  if (underscore == std::string_view::npos) cursor_.fail_truncated("appended data");
  appended_ = all.substr(underscore + 1);
  is_appended_base64_ = all.substr(start, underscore - start).find("base64") != std::string_view::npos;
  tags_end_ = all.data() + start;
}

void VtuFile::header(const Tag& tag) {
  if (tag["type"] != "UnstructuredGrid")
    cursor_.fail_at(tag.at, "a file of type " + shown(tag["type"]) + "; only UnstructuredGrid is read");
  is_grid_ = true;
  const bool little = tag["byte_order"] != "BigEndian";
  is_swapped_ = little != (std::endian::native == std::endian::little);
  has_wide_sizes_ = tag["header_type"] == "UInt64";
  old_lagrange_ = tag["version"] < "2.1";
  if (const auto compressor = tag["compressor"]; !compressor.empty()) {
    if (compressor != "vtkZLibDataCompressor")
      cursor_.fail_at(tag.at, "data compressed by " + shown(compressor) + "; only vtkZLibDataCompressor is known");
    is_compressed_ = true;
  }
}

void VtuFile::piece(const Tag& tag) {
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

void VtuFile::declare(const Tag& tag) {
  VtuArray array;
  array.section = section_;
  array.head.name = tag["Name"];
  array.head.on = section_ == "PointData"  ? VtkArray::On::node
                  : section_ == "CellData" ? VtkArray::On::cell
                                           : VtkArray::On::file;
  array.head.global_ids = !global_ids_.empty() && array.head.name == global_ids_;
  if (const auto n = tag["NumberOfComponents"]; !n.empty())
    std::from_chars(n.data(), n.data() + n.size(), array.head.components);
  if (array.head.components < 1 || array.head.components > 1000)
    cursor_.fail_at(tag.at, "array " + shown(array.head.name) + " has no components");
  if (!tag.empty) read_content(array);
  if (tag["type"] == "String") {
    notices_.push_back("left out array '" + array.head.name + "' of texts");
    return;
  }
  array.type = vtk_type(tag["type"], cursor_);
  if (tag["format"] == "ascii") {
    array.is_text = true;
  } else if (tag["format"] == "binary") {
    array.is_base64 = true;
  } else if (tag["format"] == "appended") {
    array.source = appended_at(tag);
    array.is_base64 = is_appended_base64_;
  } else {
    cursor_.fail_at(tag.at, "array " + shown(array.head.name) + " in format " + shown(tag["format"]));
  }
  if ((section_ == "Points" && find("Points")) || (section_ == "Cells" && find("Cells", array.head.name)))
    cursor_.fail_at(tag.at, "a second array " + shown(array.head.name) + " of " + array.section);
  arrays_.push_back(std::move(array));
}

VtuArray* VtuFile::find(std::string_view section, std::string_view name) {
  for (VtuArray& array : arrays_)
    if (array.section == section && (name.empty() || array.head.name == name)) return &array;
  return nullptr;
}

/// Up to </DataArray>, without what other tags hold (InformationKey).
void VtuFile::read_content(VtuArray& array) {
  int depth = 0;
  bool is_first = true;
  for (;;) {
    const char* from = cursor_.at;
    const auto tag = next_tag();
    if (!tag) cursor_.fail_truncated("</DataArray>");
    const std::string_view text(from, static_cast<std::size_t>(tag->at - from));
    if (depth == 0 && is_first) {
      array.source = text;
      is_first = false;
    } else if (depth == 0 && !trimmed(text).empty()) {
      if (!array.own) array.own = std::make_unique<std::string>(array.source);
      array.source = array.own->append(text);
    }
    if (tag->name == "DataArray" && tag->closing) return;
    depth += tag->closing ? -1 : tag->empty ? 0 : 1;
  }
}

std::string_view VtuFile::appended_at(const Tag& tag) const {
  std::size_t offset = 0;
  const auto text = tag["offset"];
  const bool good = std::from_chars(text.data(), text.data() + text.size(), offset).ec == std::errc{};
  if (!good || offset >= appended_.size())
    cursor_.fail_at(tag.at, "the appended data ends before " + shown(tag["Name"]));
  return appended_.substr(offset);
}

void VtuFile::fail_truncated(const VtuArray& array) {
  cursor_.fail_truncated("the data of array " + shown(array.head.name));
}

Cursor VtuFile::numbers(std::string_view bytes) const {
  Cursor cursor(bytes, cursor_.name);
  cursor.binary = true;
  cursor.swapped = is_swapped_;
  return cursor;
}

std::uint64_t VtuFile::number(Stream& stream, const VtuArray& array) {
  const auto bytes = stream.take(has_wide_sizes_ ? 8 : 4);
  if (!bytes) fail_truncated(array);
  Cursor cursor = numbers(*bytes);
  return has_wide_sizes_ ? cursor.raw<std::uint64_t>("a size") : std::uint64_t{cursor.raw<std::uint32_t>("a size")};
}

/// In base64 the sizes are encoded on their own.
VtuFile::Blocks VtuFile::blocks(Stream& stream, const VtuArray& array) {
  Blocks blocks;
  const std::uint64_t n = number(stream, array);
  if (n > array.source.size() / (has_wide_sizes_ ? 8 : 4)) fail_truncated(array);
  blocks.plain = number(stream, array);
  blocks.last = number(stream, array);
  for (std::uint64_t b = 0; b < n; ++b) blocks.packed.push_back(number(stream, array));
  stream.end_part();
  for (std::size_t b = 0; b < blocks.packed.size(); ++b) {
    if (blocks.packed[b] > array.source.size()) fail_truncated(array);
    if (blocks.size_of(b) / most_packed > blocks.packed[b] + 1)
      cursor_.fail("array " + shown(array.head.name) + " has impossible sizes");
  }
  return blocks;
}

std::int64_t VtuFile::n_bytes(const VtuArray& array) {
  if (array.is_text) return -1;
  Stream stream(array);
  if (!is_compressed_) {
    const std::uint64_t n = number(stream, array);
    if (n > array.source.size()) fail_truncated(array);
    return static_cast<std::int64_t>(n);
  }
  std::uint64_t sum = 0;
  const Blocks all = blocks(stream, array);
  for (std::size_t b = 0; b < all.packed.size(); ++b) sum += all.size_of(b);
  return static_cast<std::int64_t>(sum);
}

void VtuFile::for_each_piece(const VtuArray& array, const std::function<void(std::string_view)>& use) {
  Stream stream(array);
  if (!is_compressed_) {
    std::uint64_t n = number(stream, array);
    const std::size_t piece = array.is_base64 ? std::size_t{1} << 16 : n;  // raw bytes are where they are
    while (n > 0) {
      const auto bytes = stream.take(std::min<std::uint64_t>(n, piece));
      if (!bytes) fail_truncated(array);
      use(*bytes);
      n -= bytes->size();
    }
    return;
  }
  const Blocks all = blocks(stream, array);
  std::string data;
  for (std::size_t b = 0; b < all.packed.size(); ++b) {
    const auto packed = stream.take(all.packed[b]);
    if (!packed) fail_truncated(array);
    data.resize(all.size_of(b));
    uLongf size = data.size();
    if (uncompress(reinterpret_cast<Bytef*>(data.data()), &size, reinterpret_cast<const Bytef*>(packed->data()),
                   packed->size()) != Z_OK ||
        size != data.size())
      cursor_.fail("array " + shown(array.head.name) + " cannot be uncompressed");
    use(data);
  }
}

bool VtuFile::fits(std::size_t n_unpacked) const {
  return n_unpacked / most_packed <= static_cast<std::size_t>(cursor_.end - cursor_.begin);
}

bool VtuFile::fits_unpacked() {
  std::size_t sum = 0;
  for (const VtuArray& array : arrays_)
    if (!array.is_text && (array.is_base64 || is_compressed_)) sum += static_cast<std::size_t>(n_bytes(array));
  return fits(sum);
}

VtkArray VtuFile::load(VtuArray& array) {
  VtkArray& to = array.head;
  if (array.is_text) {
    const std::string name = std::string(cursor_.name) + ", array " + shown(to.name);
    Cursor words(array.source, name);
    read_vtk_text(words, array.type, {}, to);
    return std::move(to);
  }
  std::string_view bytes;
  if (!array.is_base64 && !is_compressed_) {
    for_each_piece(array, [&](std::string_view piece) { bytes = piece; });
  } else {
    n_unpacked_ += static_cast<std::size_t>(n_bytes(array));
    if (!fits(n_unpacked_)) cursor_.fail("the arrays hold more than the file can");
    std::size_t n = 0;
    for_each_piece(array, [&](std::string_view piece) {
      to.own.resize((n + piece.size() + sizeof to.own[0] - 1) / sizeof to.own[0]);
      std::memcpy(reinterpret_cast<char*>(to.own.data()) + n, piece.data(), piece.size());
      n += piece.size();
    });
    bytes = {reinterpret_cast<const char*>(to.own.data()), n};
  }
  Cursor values = numbers(bytes);
  read_vtk_values(values, array.type, bytes.size() / vtk_size(array.type), to);
  return std::move(to);
}

}  // namespace hextwist::io
