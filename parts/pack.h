// A mesh with all that is known of it as bytes: what parts send each other and put aside on disk.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "hextwist/mesh/meshed_model.h"

namespace hextwist {

/// Everything but the model and Mesh::results. For the same build of the program on the same kind of machine.
std::vector<std::byte> packed(const MeshedModel& meshed);
/// The model is left null. Precondition: these bytes come from packed().
MeshedModel unpacked(std::span<const std::byte> bytes);

/// What results_of_parts() keeps; null: no bytes.
std::vector<std::byte> packed_results(const FileResults* results);
/// Precondition: these bytes come from packed_results(), and there are some.
std::shared_ptr<const FileResults> unpacked_results(std::span<const std::byte> bytes);

/// Its groups and fields, without members and values.
Mesh heads_of(const Mesh& mesh);

/// In a file of our own; throw Error naming it.
void write_bytes(const std::filesystem::path& file, std::span<const std::byte> bytes);
std::vector<std::byte> read_all_bytes(const std::filesystem::path& file);

/// Plain items one after the other.
class ByteWriter {
 public:
  template <class T>
  void value(const T& item) {
    static_assert(std::is_trivially_copyable_v<T>);
    append(&item, sizeof item);
  }
  template <class T>
  void list(const std::vector<T>& items) {
    value(items.size());
    append(items.data(), items.size() * sizeof(T));
  }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  void append(const void* from, std::size_t n) {
    const auto* first = static_cast<const std::byte*>(from);
    bytes_.insert(bytes_.end(), first, first + n);
  }
  std::vector<std::byte> bytes_;
};

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  template <class T>
  T value() {
    T item{};
    take(&item, sizeof item);
    return item;
  }
  template <class T>
  void list(std::vector<T>& items) {
    items.resize(value<std::size_t>());
    take(items.data(), items.size() * sizeof(T));
  }

 private:
  void take(void* to, std::size_t n);
  std::span<const std::byte> bytes_;
};

}  // namespace hextwist
