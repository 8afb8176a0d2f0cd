// The header of a classic NetCDF file, walked before the library does: that one reserves what the header's counts say.
// (NetCDF User's Guide, "File Format Specifications", 2022.)
#include <cstdint>
#include <string_view>

#include "hextwist/base/text.h"
#include "hextwist/io/exodus/exodus_internal.h"

namespace hextwist::io {
namespace {

using Number = std::uint64_t;

class Header {
 public:
  explicit Header(const Bytes& file) : file_(file) {}

  void check() {
    at_ = 3;
    const int version = file_.data[at_++];
    if (version != 1 && version != 2 && version != 5) fail("version " + std::to_string(version) + " of NetCDF");
    count_bytes_ = version == 5 ? 8 : 4;
    offset_bytes_ = version == 1 ? 4 : 8;
    const Number streaming = count_bytes_ == 4 ? 0xFFFFFFFFU : ~Number{0};
    n_records_ = number(count_bytes_);
    if (n_records_ == streaming) n_records_ = 0;
    list(0x0A, 2 * count_bytes_, [&] { dimension(); });
    attributes();
    list(0x0B, 4 * count_bytes_, [&] { variable(); });
    // All variables of a record stand together, and are padded but for one that is alone.
    if (of_record_.size() == 1) record_bytes_ = of_record_.front().second;
    for (const auto& [begin, size] : of_record_) within(begin, (n_records_ ? n_records_ - 1 : 0), size);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(file_.name + ": damaged NetCDF header at byte " + std::to_string(at_) + ": " + what);
  }
  Number left() const { return file_.size - at_; }

  Number number(std::size_t bytes) {
    if (left() < bytes) fail("it ends too soon");
    Number value = 0;
    for (std::size_t i = 0; i < bytes; ++i) value = value << 8 | static_cast<unsigned char>(file_.data[at_++]);
    return value;
  }
  /// Of things that take so many bytes each, at least.
  Number count(Number bytes) {
    const Number n = number(count_bytes_);
    if (n > left() / bytes)
      fail(std::to_string(n) + " items of " + std::to_string(bytes) + " bytes announced, " + std::to_string(left()) +
           " bytes left");
    return n;
  }
  void skip(Number bytes) {
    const Number padded = (bytes + 3) / 4 * 4;
    if (padded > left()) fail("it ends too soon");
    at_ += padded;
  }
  std::string_view name() {
    const Number n = count(1);
    const char* const text = &file_.data[at_];
    skip(n);
    return {text, n};
  }

  template <class F>
  void list(Number tag, Number least_bytes, F&& item) {
    const Number found = number(4);
    if (found != 0 && found != tag) fail("tag " + std::to_string(found) + " in place of " + std::to_string(tag));
    const Number n = count(least_bytes);
    if (found == 0 && n != 0) fail("a list with entries but without a tag");
    for (Number i = 0; i < n; ++i) item();
  }
  Number type_bytes() {
    constexpr std::array<Number, 12> bytes = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    const Number type = number(4);
    if (type == 0 || type >= bytes.size()) fail("type " + std::to_string(type));
    return bytes[type];
  }

  void dimension() {
    const bool of_the_whole = name().ends_with("_global");  // of a mesh in parts: nothing here is that long
    sizes_.push_back(number(count_bytes_));
    // Of no variable yet; some are of none, and the library reserves by those too.
    if (!of_the_whole && sizes_.back() > file_.size)
      fail("a dimension of " + std::to_string(sizes_.back()) + " in so small a file");
  }
  void attributes() {
    list(0x0C, 2 * count_bytes_ + 4, [&] {
      name();
      const Number bytes = type_bytes();
      skip(count(bytes) * bytes);
    });
  }
  void variable() {
    name();
    const Number n = count(count_bytes_);
    bool record = false;
    // A product beyond the file's size stays there, so it can't overflow.
    Number items = 1;
    for (Number i = 0; i < n; ++i) {
      const Number of = number(count_bytes_);
      if (of >= sizes_.size())
        fail("a variable of dimension " + std::to_string(of) + " of " + std::to_string(sizes_.size()));
      if (sizes_[of] == 0 && i == 0)
        record = true;  // or empty, which announces no more
      else if (sizes_[of] != 0 && items > file_.size / sizes_[of])
        items = file_.size + 1;
      else
        items *= sizes_[of];
    }
    attributes();
    const Number bytes = type_bytes() * items;
    number(count_bytes_);  // the size again, which the library computes too
    const Number begin = number(offset_bytes_);
    if (record)
      of_record_.emplace_back(begin, bytes), record_bytes_ += (bytes + 3) / 4 * 4;
    else
      within(begin, 0, bytes);
  }
  /// A variable's last record of so many before it.
  void within(Number begin, Number before, Number bytes) const {
    const Number size = file_.size;
    if (begin <= size && (before == 0 || record_bytes_ <= size / before) && bytes <= size) {
      const Number end = begin + before * record_bytes_ + bytes;
      if (end <= size || n_records_ == 0) return;
    }
    fail("a variable would end beyond the file's " + counted(static_cast<std::int64_t>(size), "byte"));
  }

  const Bytes& file_;
  Number at_ = 0, n_records_ = 0, record_bytes_ = 0;
  std::size_t count_bytes_ = 4, offset_bytes_ = 4;
  std::vector<Number> sizes_;
  std::vector<std::pair<Number, Number>> of_record_;  // begin and bytes of one record
};

}  // namespace

bool is_classic_netcdf(const Bytes& file) {
  return file.size > 4 && std::string_view(file.data.get(), 3) == "CDF";
}

void check_classic_netcdf(const Bytes& file) {
  Header(file).check();
}

}  // namespace hextwist::io
