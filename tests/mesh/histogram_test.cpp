#include "hextwist/mesh/quality/histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <sstream>
#include <vector>

namespace hextwist {
namespace {

struct Line {
  double low, high;
  long count;
  std::string bar;
};
std::vector<Line> lines_of(const std::string& text) {
  std::vector<Line> lines;
  std::istringstream stream(text);
  for (std::string row; std::getline(stream, row);) {
    std::istringstream words(row);
    Line line{};
    std::string dots;
    words >> line.low >> dots >> line.high >> line.count;
    EXPECT_EQ(dots, "..") << row;
    words >> line.bar;
    lines.push_back(line);
  }
  return lines;
}

TEST(histogram, is_bounds_counts_and_bars) {
  std::vector<double> values = {0, 0.5, 1};
  for (int i = 0; i < 99; ++i) values.push_back(0.75);
  EXPECT_EQ(histogram(values, 4),
            "   0 .. 0.25        1  #\n"
            "0.25 ..  0.5        0\n"
            " 0.5 .. 0.75        1  #\n"
            "0.75 ..    1      100  ##################################################\n");
}

TEST(histogram, of_nothing_is_nothing_and_of_equal_values_one_line) {
  EXPECT_EQ(histogram({}, 5), "");
  EXPECT_EQ(histogram(std::vector<double>(3, 0.5), 5),
            "0.5 .. 0.5        3  ##################################################\n");
  EXPECT_EQ(histogram(std::vector<double>{0.5, 0.5 + 1e-12, 0.5 - 1e-12}, 5),
            histogram(std::vector<double>(3, 0.5), 5));
}

TEST(histogram, counts_every_value_once_where_it_belongs) {
  std::mt19937 random(5);
  for (const int bins : {1, 2, 7, 10, 33}) {
    std::vector<double> values(1000);
    std::uniform_real_distribution<double> some(-3, 8);
    for (double& value : values) value = some(random);
    values[10] = -3;
    values[20] = 8;
    const auto lines = lines_of(histogram(values, bins));
    ASSERT_EQ(lines.size(), static_cast<std::size_t>(bins));
    long total = 0, fullest = 0;
    for (const Line& line : lines) fullest = std::max(fullest, line.count);
    for (int i = 0; i < bins; ++i) {
      const Line& line = lines[static_cast<std::size_t>(i)];
      const double low = -3 + 11.0 * i / bins, high = -3 + 11.0 * (i + 1) / bins;
      EXPECT_NEAR(line.low, low, 1e-3 * (1 + std::abs(low)));
      EXPECT_NEAR(line.high, high, 1e-3 * (1 + std::abs(high)));
      EXPECT_EQ(line.count,
                std::ranges::count_if(values, [&](double v) { return v >= low && (v < high || i == bins - 1); }));
      EXPECT_NEAR(static_cast<double>(line.bar.size()),
                  50.0 * static_cast<double>(line.count) / static_cast<double>(fullest), 1);
      total += line.count;
    }
    EXPECT_EQ(total, 1000);
  }
}

TEST(histogram, of_values_too_far_apart_to_subtract) {
  const auto lines = lines_of(histogram(std::vector<double>{-1.5e308, 1e308, 1.5e308}, 3));
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0].count, 1);
  EXPECT_EQ(lines[1].count, 0);
  EXPECT_EQ(lines[2].count, 2);
}

}  // namespace
}  // namespace hextwist
