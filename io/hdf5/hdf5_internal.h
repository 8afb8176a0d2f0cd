// HDF5 files through the library: arrays of numbers, attributes, groups. Needs hdf5.h.
#pragma once

#include <hdf5.h>

#include <set>

#include "hextwist/base/replacement.h"
#include "hextwist/io/vtk/output_internal.h"
#include "hextwist/io/vtk/vtk_internal.h"

namespace hextwist::io {

/// Something of the library that is closed when it goes out of scope.
class Hdf5Id {
 public:
  Hdf5Id(hid_t id, herr_t (*closing)(hid_t)) : id_(id), close_(closing) {}
  ~Hdf5Id() {
    if (id_ >= 0) close_(id_);
  }
  Hdf5Id(const Hdf5Id&) = delete;
  operator hid_t() const { return id_; }  // NOLINT: it is one
  herr_t close() { return close_(std::exchange(id_, -1)); }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// From now on the library prints nothing.
void quiet_hdf5();

class Hdf5Reader {
 public:
  /// name: for messages. Throws Error.
  Hdf5Reader(const std::filesystem::path& file, std::string name);

  bool has(const std::string& path) const;
  /// Names of what is in a group, as they were made where the file knows that, else in the order of the alphabet; none
  /// where there is no group.
  std::vector<std::string> members(const std::string& group) const;
  bool is_group(const std::string& path) const;
  /// An array of integers or floating-point numbers in memory of its own, named as the path ends. sizes: of its
  /// dimensions; one number where it has none. Throws Error.
  VtkArray array(const std::string& path, std::vector<std::size_t>& sizes) const;
  VtkArray array(const std::string& path) const {
    std::vector<std::size_t> sizes;
    return array(path, sizes);
  }
  /// False: it is of texts or of something else that is no number.
  bool is_numbers(const std::string& path) const;
  /// An attribute of a group or dataset as text; "" where there is none.
  std::string text(const std::string& path, const char* attribute) const;
  /// Its first number; `none` where there is none.
  std::int64_t integer(const std::string& path, const char* attribute, std::int64_t none) const;
  [[noreturn]] void fail(const std::string& what) const { throw Error(name_ + ": " + what); }

 private:
  std::string name_;
  std::uintmax_t size_;
  Hdf5Id file_;
};

/// The attribute of a dataset that has the name of its array, where the link has another one.
inline constexpr const char* hdf5_name = "name";

class Hdf5Writer {
 public:
  explicit Hdf5Writer(const Replacement& file);

  void group(const std::string& path) const;
  /// values: n rows of `width` numbers; width 0: one dimension.
  template <class T>
  void array(const std::string& path, std::span<const T> values, std::size_t width = 0) const {
    write(path, type_of<T>(), values.data(), width == 0 ? values.size() : values.size() / width, width);
  }
  void text(const std::string& path, const char* attribute, const std::string& value) const;
  void integers(const std::string& path, const char* attribute, const std::vector<std::int64_t>& values) const;
  void close();

  /// Arrays of a group, as VtkOutput writes them. Names that no link can have are in an attribute.
  class Arrays {
   public:
    /// but: characters that no link shall have beside '/'; where there are such, no other control characters and no
    /// blanks at its end either, so that it may stand at the end of a text.
    Arrays(const Hdf5Writer& file, std::string group, std::string but = "")
        : file_(file), group_(std::move(group)), but_(std::move(but)) {}
    template <class T>
    void add(const std::string& name, std::span<const T> values, int components, const std::string& = "") {
      put(name, values, components);
    }
    template <class F>
    void add_each(const std::string& name, std::size_t n, int components, F value, const std::string& = "") {
      using Value = decltype(value(n));
      using T = typename VtkNumbers<Value>::Type;
      std::vector<T> values;
      values.reserve(n * sizeof(Value) / sizeof(T));
      for (std::size_t i = 0; i < n; ++i) {
        const Value one = value(i);
        const auto numbers = VtkNumbers<Value>::of(one);
        values.insert(values.end(), numbers.begin(), numbers.end());
      }
      put(name, std::span<const T>(values), components);
    }
    /// Of the last array.
    const std::string& path() const { return path_; }

   private:
    template <class T>
    void put(const std::string& name, std::span<const T> values, int components) {
      path_ = group_ + "/" + link(name);
      file_.array(path_, values, components > 1 ? static_cast<std::size_t>(components) : 0);
      if (path_ != group_ + "/" + name) file_.text(path_, hdf5_name, name);
    }
    /// A name for a link beside those that there are.
    std::string link(const std::string& wanted) {
      std::string name = wanted.empty() || wanted == "." || wanted == ".." ? "_" + wanted : wanted;
      const auto unwanted = [&](char c) {
        return but_.find(c) != std::string::npos || (!but_.empty() && static_cast<unsigned char>(c) < ' ');
      };
      for (char& c : name)
        if (c == '/' || c == '\0' || unwanted(c)) c = '_';
      for (std::size_t i = name.size(); i > 0 && name[i - 1] == ' ' && !but_.empty(); --i) name[i - 1] = '_';
      const std::string stem = name;
      for (int k = 2; !taken_.insert(name).second; ++k) name = stem + "_" + std::to_string(k);
      return name;
    }
    const Hdf5Writer& file_;
    std::string group_, but_, path_;
    std::set<std::string> taken_;
  };

 private:
  template <class T>
  static hid_t type_of() {
    if constexpr (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
    if constexpr (std::is_same_v<T, std::int64_t>) return H5T_NATIVE_INT64;
    if constexpr (std::is_same_v<T, std::int32_t>) return H5T_NATIVE_INT32;
    if constexpr (std::is_same_v<T, std::uint8_t>) return H5T_NATIVE_UINT8;
  }
  void write(const std::string& path, hid_t type, const void* data, std::size_t n, std::size_t width) const;
  void check(bool good) const {
    if (!good) replacement_.fail("cannot be written (disk full?)");
  }

  const Replacement& replacement_;
  Hdf5Id file_;
};

}  // namespace hextwist::io
