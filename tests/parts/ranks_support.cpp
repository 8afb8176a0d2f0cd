#include "ranks_support.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>

#include "io/io_support.h"

namespace hextwist::test {

Outcome run_ranks(int n, const std::string& arguments) {
  return run_program_in_ranks(n, HEXTWIST_MPI_PROGRAM, arguments);
}

Outcome run_program_in_ranks(int n, const std::string& program, const std::string& arguments) {
  const auto folder = std::filesystem::path(HEXTWIST_TEST_OUTPUT) /
                      (std::string("mpi.") + testing::UnitTest::GetInstance()->current_test_info()->name());
  std::filesystem::create_directories(folder);
  const std::string out = (folder / "stdout").string(), err = (folder / "stderr").string();
  // What MPI's libraries keep until the end, and the order in which their sockets lock, is not for sanitizers to tell.
  const std::string command = std::string("ASAN_OPTIONS=detect_leaks=0 TSAN_OPTIONS=detect_deadlocks=0 '") +
                              HEXTWIST_MPIEXEC + "' --oversubscribe --allow-run-as-root -n " + std::to_string(n) +
                              " '" + program + "' " + arguments + " > '" + out + "' 2> '" + err + "'";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(out), text_of(err)};
}

std::string model(const std::string& name) {
  return std::string(HEXTWIST_SOURCE_DIR) + "/models/" + name;
}

}  // namespace hextwist::test
