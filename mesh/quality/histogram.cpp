#include "hextwist/mesh/quality/histogram.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <vector>

#include "hextwist/base/text.h"

namespace hextwist {
namespace {

constexpr std::int64_t longest_bar = 50;

std::string right(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, text.size()), ' ') + text;
}

}  // namespace

std::string histogram(std::span<const double> values, int bins) {
  assert(bins >= 1);
  if (values.empty()) return "";
  const auto [least, most] = std::ranges::minmax(values);
  const auto bound = [&, min = least, max = most](int bin) {
    // Weights instead of min + width: the difference of two values may overflow, and the last bound is the largest
    // value.
    const double t = static_cast<double>(bin) / bins;
    return bin == bins ? max : (1 - t) * min + t * max;
  };
  if (short_number(least) == short_number(most)) bins = 1;  // what differs is rounding

  std::vector<double> bounds;
  for (int bin = 0; bin <= bins; ++bin) bounds.push_back(bound(bin));
  std::vector<std::int64_t> counts(static_cast<std::size_t>(bins), 0);
  for (const double value : values) {
    const auto above = std::upper_bound(bounds.begin() + 1, bounds.end() - 1, value);
    ++counts[static_cast<std::size_t>(above - bounds.begin()) - 1];
  }

  const std::int64_t fullest = *std::ranges::max_element(counts);
  std::size_t bound_width = 0;
  for (const double b : bounds) bound_width = std::max(bound_width, short_number(b).size());
  const std::size_t count_width = std::max<std::size_t>(8, std::to_string(fullest).size());
  std::string text;
  for (std::size_t bin = 0; bin < counts.size(); ++bin) {
    const auto share = static_cast<double>(counts[bin]) / static_cast<double>(fullest);
    const std::int64_t marks = std::llround(share * static_cast<double>(longest_bar));
    text += right(short_number(bounds[bin]), bound_width) + " .. " + right(short_number(bounds[bin + 1]), bound_width) +
            " " + right(std::to_string(counts[bin]), count_width);
    if (counts[bin] > 0) text += "  " + std::string(static_cast<std::size_t>(std::max<std::int64_t>(marks, 1)), '#');
    text += '\n';
  }
  return text;
}

}  // namespace hextwist
