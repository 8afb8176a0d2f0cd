#include "hextwist/io/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

#include "hextwist/base/text.h"
#include "hextwist/io/mapped.h"

namespace hextwist::io {
namespace {

/// An ordinary file, open for reading. A pipe that nobody writes to must not be waited for.
struct Input {
  int descriptor;
  std::size_t size = 0;

  explicit Input(const std::filesystem::path& file)
      : descriptor(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
    const std::string name = file.string();
    if (descriptor < 0) throw Error(name + ": cannot be opened: " + error_text(errno));
    struct stat status {};
    if (::fstat(descriptor, &status) != 0) status.st_mode = 0;
    const char* wrong = S_ISDIR(status.st_mode) ? "is a folder" : "is not an ordinary file";
    if (S_ISREG(status.st_mode)) wrong = status.st_size == 0 ? "is empty" : nullptr;
    if (wrong) {
      ::close(descriptor);
      throw Error(name + ": " + wrong);
    }
    size = static_cast<std::size_t>(status.st_size);
  }
  ~Input() { ::close(descriptor); }
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;
};

}  // namespace

void ReleaseBytes::operator()(const char* data) const {
  if (mapped > 0)
    unmap(data, mapped);
  else
    delete[] data;
}

Bytes read_bytes(const std::filesystem::path& file) {
  const Input input(file);
  Bytes bytes{file.string(), nullptr, 0};
  if (const char* mapped = map(input.descriptor, input.size)) {
    bytes.data = {mapped, ReleaseBytes{input.size}};
    bytes.size = input.size;
    return bytes;
  }
  auto memory = std::make_unique_for_overwrite<char[]>(input.size);
  while (bytes.size < input.size) {
    const auto n = ::read(input.descriptor, memory.get() + bytes.size, input.size - bytes.size);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw Error(bytes.name + ": cannot be read: " + error_text(errno));
    if (n == 0) break;
    bytes.size += static_cast<std::size_t>(n);
  }
  bytes.data = {memory.release(), ReleaseBytes{}};
  return bytes;
}

void check_unchanged(const Bytes& bytes) {
  if (bytes.data.get_deleter().mapped > 0 && has_changed(bytes.data.get()))
    throw Error(bytes.name + ": was changed by somebody while it was read");
}

NumberText::NumberText(double value, std::size_t width) {
  const auto take = [&](const char* begin, const char* end) {
    size = static_cast<std::size_t>(end - begin);
    std::copy(begin, end, characters.data());
  };
  if (std::abs(value) < 1e-99) value = 0;
  std::array<char, 128> text;
  char* const begin = text.data();
  const auto fits = [&](const char* stop) { return stop <= begin + width; };
  char* end = std::to_chars(begin, begin + text.size(), value).ptr;
  if (fits(end)) {
    take(begin, end);
    return;
  }
  // With an exponent or without, whichever has room for more digits.
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto format : {std::chars_format::scientific, std::chars_format::fixed})
    for (int digits = 18; digits > 0; --digits) {
      const auto [stop, error] = std::to_chars(begin, begin + text.size(), value, format, digits);
      if (error != std::errc{} || !fits(stop)) continue;
      double rounded = 0;
      std::from_chars(begin, stop, rounded);
      if (std::abs(rounded - value) < std::abs(nearest - value)) nearest = rounded;
      break;
    }
  end = std::to_chars(begin, begin + text.size(), nearest).ptr;
  take(begin, end);
}

Output::Output(const std::filesystem::path& file, bool overwrite)
    : file_(file, overwrite), buffer_(std::make_unique_for_overwrite<char[]>(capacity)) {
  descriptor_ = ::open(file_.temporary().c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor_ < 0) file_.fail("cannot be written: " + error_text(errno));
}

Output::~Output() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Output& Output::operator<<(std::int64_t value) {
  char* at = room(24);
  used_ = static_cast<std::size_t>(std::to_chars(at, at + 24, value).ptr - buffer_.get());
  return *this;
}

Output& Output::operator<<(const Right& field) {
  std::array<char, 24> text{};
  const char* const end = std::to_chars(text.begin(), text.end(), field.number).ptr;
  for (auto n = static_cast<std::size_t>(end - text.begin()); n < field.width; ++n) *this << ' ';
  return *this << std::string_view(text.begin(), end);
}

Output& Output::operator<<(double value) {
  char* at = room(32);
  used_ = static_cast<std::size_t>(std::to_chars(at, at + 32, value).ptr - buffer_.get());
  return *this;
}

void Output::raw_large(const void* bytes, std::size_t n) {
  flush();
  if (n >= capacity / 4) return write_out(static_cast<const char*>(bytes), n);
  std::memcpy(buffer_.get(), bytes, n);
  used_ = n;
}

void Output::write_out(const char* bytes, std::size_t n) {
  while (n > 0) {
    const auto written = ::write(descriptor_, bytes, n);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) file_.fail("cannot be written: " + error_text(errno));
    bytes += written;
    n -= static_cast<std::size_t>(written);
  }
}

void Output::flush() {
  const std::size_t n = used_;
  used_ = 0;
  write_out(buffer_.get(), n);
}

void Output::commit() {
  flush();
  const int closed = ::close(descriptor_);
  descriptor_ = -1;
  if (closed != 0) file_.fail("cannot be written: " + error_text(errno));
  file_.commit();
}

}  // namespace hextwist::io
