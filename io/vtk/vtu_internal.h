// A .vtu file before its arrays are read: what is declared, and where the numbers lie.
#pragma once

#include <functional>
#include <memory>

#include "hextwist/io/slice.h"
#include "hextwist/io/vtk/tags_internal.h"
#include "hextwist/io/vtk/vtk_internal.h"

namespace hextwist::io {

/// An array as its tag declares it.
struct VtuArray {
  VtkArray head;  ///< without numbers
  VtkType type = VtkType::float64;
  std::string section;
  std::string_view source;           ///< where its numbers are: text, or bytes with their sizes before them
  std::unique_ptr<std::string> own;  ///< what `source` is in, where that is not the file
  bool is_text = false, is_base64 = false;
};

class VtuFile {
 public:
  /// Throws Error where the file is no grid of one piece.
  explicit VtuFile(const Bytes& bytes);

  Cursor& cursor() { return cursor_; }
  std::size_t n_points() const { return n_points_; }
  std::size_t n_cells() const { return n_cells_; }
  std::vector<VtuArray>& arrays() { return arrays_; }
  /// The first array of a section, or the one of this name there; null where there is none.
  VtuArray* find(std::string_view section, std::string_view name = {});
  /// Arrays that are left out, and such.
  const std::vector<std::string>& notices() const { return notices_; }
  bool old_lagrange() const { return old_lagrange_; }

  /// All numbers of an array: where the file has them, or of its own. Moves the head.
  VtkArray load(VtuArray& array);
  /// How many bytes its numbers take, by what is said before them; of text -1.
  std::int64_t n_bytes(const VtuArray& array);
  /// Whether all arrays together are no larger than the file can hold: they may share what they are unpacked from.
  bool fits_unpacked();
  /// Calls use(bytes) for the bytes of the numbers as the file has them, piece after piece. Not of text.
  void for_each_piece(const VtuArray& array, const std::function<void(std::string_view)>& use);
  /// For numbers as the file has them.
  Cursor numbers(std::string_view bytes) const;

 private:
  class Stream;
  void find_appended();
  std::optional<Tag> next_tag() { return io::next_tag(cursor_, tags_end_ ? tags_end_ : cursor_.end); }
  void header(const Tag& tag);
  void piece(const Tag& tag);
  void declare(const Tag& tag);
  void read_content(VtuArray& array);
  std::string_view appended_at(const Tag& tag) const;
  [[noreturn]] void fail_truncated(const VtuArray& array);
  /// Sizes of the blocks of compressed data, behind those that are said of all.
  struct Blocks {
    std::uint64_t plain = 0, last = 0;
    std::vector<std::uint64_t> packed;
    std::uint64_t size_of(std::size_t i) const { return i + 1 == packed.size() && last > 0 ? last : plain; }
  };
  Blocks blocks(Stream& stream, const VtuArray& array);
  bool fits(std::size_t n_unpacked) const;
  std::uint64_t number(Stream& stream, const VtuArray& array);

  Cursor cursor_;
  std::vector<VtuArray> arrays_;
  std::vector<std::string> notices_;
  std::string_view section_, appended_;
  std::string global_ids_;  // name of the array in this section that is ids
  const char* tags_end_ = nullptr;
  bool is_appended_base64_ = false, is_grid_ = false, is_swapped_ = false, has_wide_sizes_ = false;
  bool is_compressed_ = false, old_lagrange_ = false;
  int n_pieces_ = 0;
  std::size_t n_points_ = 0, n_cells_ = 0, n_unpacked_ = 0;
};

std::optional<SlicedFile> vtu_in_slices(const std::filesystem::path& file, Unsliced& why);
MeshSlice read_vtu_slice(const SlicedFile& file, int number, int n);

}  // namespace hextwist::io
