// Writing that leaves either the complete file or the old one.
#pragma once

#include <filesystem>
#include <string>

#include "hextwist/base/types.h"

namespace hextwist {

/// The file that is written in place of another one: a new, empty one in the same folder that commit() renames, and
/// the destructor removes when commit() was not reached. Links are followed, also where they lead to no file yet;
/// anything but an ordinary file (a device, a pipe) is written directly.
class Replacement {
 public:
  /// Throws Error when the folder is missing or `overwrite` is false and the file exists.
  Replacement(const std::filesystem::path& file, bool overwrite);
  ~Replacement();
  Replacement(const Replacement&) = delete;
  Replacement& operator=(const Replacement&) = delete;

  /// Where to write: what is there may be overwritten.
  const std::filesystem::path& temporary() const { return temporary_; }
  bool direct() const { return direct_; }
  /// As the caller named it.
  const std::string& name() const { return name_; }
  /// Throws Error when the rename fails.
  void commit();
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::string name_;
  std::filesystem::path target_, temporary_;
  bool overwrite_, direct_ = false, committed_ = false;
};

}  // namespace hextwist
