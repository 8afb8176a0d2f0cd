#include "hextwist/base/replacement.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <system_error>

#include "hextwist/base/text.h"

namespace hextwist {
namespace {

/// Where links that end nowhere lead to. Throws std::filesystem::filesystem_error where they go in circles.
std::filesystem::path end_of_links(std::filesystem::path file) {
  for (int i = 0; std::filesystem::is_symlink(std::filesystem::symlink_status(file)); ++i) {
    constexpr int most = 40;  // as the kernel has it
    if (i == most)
      throw std::filesystem::filesystem_error("", std::make_error_code(std::errc::too_many_symbolic_link_levels));
    file = file.parent_path() / std::filesystem::read_symlink(file);
  }
  return file;
}

}  // namespace

Replacement::Replacement(const std::filesystem::path& file, bool overwrite)
    : name_(file.string()), overwrite_(overwrite) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  const bool exists = std::filesystem::exists(status);
  if (exists && !overwrite) fail("exists already and may not be overwritten");
  if (std::filesystem::is_directory(status)) fail("is a folder");
  try {
    target_ = exists ? std::filesystem::canonical(file) : end_of_links(file);
  } catch (const std::filesystem::filesystem_error& problem) {
    fail("cannot be written: " + problem.code().message());
  }
  if (exists && !std::filesystem::is_regular_file(status)) {
    direct_ = true;
    temporary_ = target_;
    return;
  }
  const auto folder = target_.has_parent_path() ? target_.parent_path() : std::filesystem::path(".");
  if (!std::filesystem::is_directory(folder, error)) fail("cannot be written: there is no folder " + folder.string());
  // A process that was killed leaves its file, and its number comes again: in a container soon.
  static std::atomic<unsigned> counter = 0;
  const std::string beginning = ".hextwist-" + std::to_string(::getpid()) + "-";
  int made = -1;
  do {
    temporary_ = folder / (beginning + std::to_string(++counter) + ".part");
    made = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (made < 0 && errno == EEXIST);
  if (made < 0) fail("cannot be written: " + error_text(errno));
  ::close(made);
}

Replacement::~Replacement() {
  if (committed_ || direct_) return;
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void Replacement::commit() {
  if (!direct_) {
    std::error_code error;
    const auto old = std::filesystem::status(target_, error);
    const bool exists = std::filesystem::exists(old);
    if (exists && !overwrite_) fail("exists already and may not be overwritten");
    if (exists) std::filesystem::permissions(temporary_, old.permissions(), error);  // as the old file had them
    std::filesystem::rename(temporary_, target_, error);
    if (error) fail("cannot be written: " + error.message());
  }
  committed_ = true;
}

void Replacement::fail(const std::string& what) const {
  throw Error(name_ + ": " + what);
}

}  // namespace hextwist
