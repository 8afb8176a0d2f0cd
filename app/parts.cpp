#include "parts.h"

#include <iostream>
#include <new>

#include "exit_status.h"
#include "hextwist/base/fence.h"
#include "hextwist/parts/files.h"

namespace hextwist::app {

int run_parts(const Options& options) {
  Fence fence;
  fence.readers = find_readers();
  std::string error;
  try {
    const auto lines =
        options.join ? join_files(options.mesh, options.output, fence)
                     : split_file(options.mesh, options.output, options.split, partition_by(options.split_by), fence);
    for (const std::string& line : lines) std::cout << line << "\n";
    return done;
  } catch (const std::bad_alloc&) {
    error = "out of memory";
  } catch (const std::exception& problem) {
    error = problem.what();
  }
  std::cerr << "error: " << error << "\n";
  return command_failed;
}

}  // namespace hextwist::app
