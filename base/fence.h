// Reading files by the libraries of others without trusting these.
//
// OpenCASCADE and HDF5 crash, loop or take all memory on some damaged files. A fence is a process of its own: a program
// of ours, hextwist_read_cad, hextwist_read_hdf5 or hextwist_read_mesh, reads the file there, within limits of memory
// and time, and hands over what it has read. However it ends, the caller goes on: with the result or with an Error of
// one line.
#pragma once

#include <filesystem>

#include "hextwist/base/types.h"

namespace HEXTWIST_API hextwist {

/// Where files are read that a library of others could stumble over, and within which limits. The default is no fence.
struct Fence {
  /// The folder of these programs. Empty: files are read in this process, which a damaged file can then end, stop or
  /// fill.
  std::filesystem::path readers = {};
  /// Files that need the programs are refused where these are not, instead of being read in this process.
  bool required = false;
  /// CPU time for a file; 0: 20, and a minute for each of its megabytes.
  double seconds = 0;
  /// Address space for a file, in units of 10^6 bytes; 0: 4000, and 200 times its size.
  double megabytes = 0;
  /// Files that a file names itself (*INCLUDE) may lie only below this folder; empty: anywhere.
  std::filesystem::path folder = {};

  /// False: files are read in this process, without limits.
  bool is_there() const { return required || !readers.empty(); }
};

/// Is the file, with all links followed, below the folder? It need not exist.
bool is_below(const std::filesystem::path& folder, const std::filesystem::path& file);

/// The folder with the readers: what the environment's HEXTWIST_READERS says, else their place near the program or
/// library that this code is in, as built or as installed; empty where they are not there.
std::filesystem::path find_readers();

}  // namespace hextwist
