// What reading and writing of CGNS share: the library's errors, the order of nodes, what our own files say beyond it.
#pragma once

#include <cgnslib.h>

#include "hextwist/io/listing.h"

namespace hextwist::io {

/// Middle nodes as the SIDS number them ("CGNS Standard Interface Data Structures", section 3.3: HEXA_20 and HEXA_27).
inline constexpr MiddleOrder cgns_middles = middle_order(
    ring_pillars_ring, {{{1, 2, 3, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 4, 8, 7}, {1, 4, 8, 5}, {5, 6, 7, 8}}});

/// Names of nodes in a file.
inline constexpr std::size_t cgns_name_length = 32;
using CgnsName = std::array<char, cgns_name_length + 1>;

/// The descriptor by which our own files say what a section, region or boundary condition is: "block 3 steel",
/// "part" (of blocks that are written elsewhere as a whole). Others have names alone.
inline constexpr const char* cgns_label = "hextwist";

/// What the library says is wrong.
inline std::string cgns_error() {
  return one_line(std::string(cg_get_error()).substr(0, 300));
}

/// Open until it goes out of scope. The library keeps its last error, and prints nothing.
class CgnsFile {
 public:
  CgnsFile(const std::filesystem::path& file, int mode) {
    cg_configure(CG_CONFIG_ERROR, reinterpret_cast<void*>(+[](int, char*) {}));
    cg_set_file_type(CG_FILE_HDF5);
    if (cg_open(file.c_str(), mode, &id_) != CG_OK) id_ = -1;
  }
  ~CgnsFile() {
    if (id_ >= 0) cg_close(id_);
  }
  CgnsFile(const CgnsFile&) = delete;
  int id() const { return id_; }
  bool close() { return cg_close(std::exchange(id_, -1)) == CG_OK; }

 private:
  int id_ = -1;
};

}  // namespace hextwist::io
