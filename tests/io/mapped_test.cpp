// Files that change while they are read.
#include "hextwist/io/mapped.h"

#include <gtest/gtest.h>

#include <fstream>
#include <thread>

#include "hextwist/io/file.h"
#include "support/grids.h"

namespace hextwist::io {
namespace {

std::filesystem::path file_of(std::size_t n) {
  const auto file = test::output_folder() / "a";
  std::ofstream(file) << std::string(n, 'x');
  return file;
}

std::string said(const Bytes& bytes) {
  try {
    check_unchanged(bytes);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(mapped, what_is_cut_off_reads_as_zeros_and_is_told) {
  const auto file = file_of(1 << 20);
  const Bytes bytes = read_bytes(file);
  EXPECT_EQ(said(bytes), "");
  std::filesystem::resize_file(file, 5000);
  std::size_t n = 0;
  for (std::size_t i = 0; i < bytes.size; ++i) n += bytes.data[i] == 'x';
  EXPECT_LE(n, 2U * 4096);
  EXPECT_EQ(said(bytes), file.string() + ": was changed by somebody while it was read");
}

TEST(mapped, threads_may_meet_the_end_at_the_same_time) {
  const auto file = file_of(1 << 22);
  const Bytes bytes = read_bytes(file);
  std::filesystem::resize_file(file, 0);
  std::vector<std::jthread> threads;
  std::atomic<int> n = 0;
  for (int t = 0; t < 8; ++t)
    threads.emplace_back([&] {
      for (std::size_t i = 0; i < bytes.size; i += 512) n += bytes.data[i];
    });
  threads.clear();
  EXPECT_EQ(n, 0);
  EXPECT_NE(said(bytes), "");
}

TEST(mapped, an_error_in_a_changed_file_is_about_the_change) {
  const auto file = file_of(100);
  const Bytes bytes = read_bytes(file);
  std::filesystem::resize_file(file, 10);
  try {
    unchanged_by(bytes, []() -> int { throw Error("no number"); });
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), file.string() + ": was changed by somebody while it was read");
  }
}

TEST(mapped, more_files_than_there_are_places_are_read_too) {
  const auto file = file_of(10);
  std::vector<Bytes> all;
  for (int i = 0; i < 100; ++i) all.push_back(read_bytes(file));
  for (const Bytes& bytes : all) EXPECT_EQ(std::string(bytes.data.get(), bytes.size), std::string(10, 'x'));
}

}  // namespace
}  // namespace hextwist::io
