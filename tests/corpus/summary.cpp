#include "corpus/summary.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <ostream>

namespace hextwist::corpus {
namespace {

std::string one_line(std::string text) {
  for (char& c : text)
    if (c == '\t' || c == '\n') c = ' ';
  return text;
}

std::string digits(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return text;
}

/// Without numbers and names of files, so that equal reasons are counted together.
std::string reason(const std::string& said) {
  std::string result;
  for (std::size_t i = said.rfind('/') == std::string::npos ? 0 : said.rfind('/') + 1; i < said.size(); ++i) {
    const bool number = said[i] >= '0' && said[i] <= '9';
    if (!number)
      result += said[i];
    else if (!result.ends_with('#'))
      result += '#';
  }
  return result.substr(0, 90);
}

/// What kind of command it is: its words.
std::string words(const std::string& command) {
  std::string result;
  for (std::size_t i = 0; i < command.size();) {
    const std::size_t end = std::min(command.find(' ', i), command.size());
    const std::string word = command.substr(i, end - i);
    if (std::ranges::all_of(word, [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; })) result += " " + word;
    i = end + 1;
  }
  return result.empty() ? result : result.substr(1);
}

using Counts = std::array<int, 5>;
struct Group {
  Counts counts{};
  std::vector<double> scaled_jacobian, ratio;
};

std::string quantiles(std::vector<double> values) {
  if (values.empty()) return "";
  std::ranges::sort(values);
  std::string result;
  for (const double q : {0.0, 0.01, 0.05, 0.25, 0.5})
    result +=
        (q > 0 ? " / " : "") + digits(values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))]);
  return result;
}

void print(std::ostream& out, const std::string& name, const Group& group) {
  out << "| " << name;
  for (const int n : group.counts) out << " | " << n;
  out << " | " << quantiles(group.scaled_jacobian) << " | " << quantiles(group.ratio) << " |\n";
}

}  // namespace

std::string header_line() {
  return "file\tcad\tseed\trun\tcommand\toutcome\thexes\tmin_scaled_jacobian\tmin_shape\tseconds\tsaid";
}

std::string line(const FileRow& of, unsigned seed) {
  const Row& row = of.row;
  return one_line(of.input.mesh.string()) + "\t" + one_line(of.input.cad.filename().string()) + "\t" +
         std::to_string(seed) + "\t" + std::to_string(row.run) + "\t" + one_line(row.command) + "\t" +
         name(row.outcome) + "\t" + std::to_string(row.hexes) + "\t" + digits(row.scaled_jacobian) + "\t" +
         digits(row.shape) + "\t" + digits(row.seconds) + "\t" + one_line(row.said);
}

void print_summary(std::ostream& out, const std::vector<FileRow>& rows) {
  std::map<std::string, Group> groups;
  std::map<std::string, int> reasons;
  Group all;
  double seconds = 0, slowest = 0;
  for (const auto& [input, row] : rows) {
    Group& group = groups[words(row.command)];
    ++group.counts[static_cast<std::size_t>(row.outcome)];
    ++all.counts[static_cast<std::size_t>(row.outcome)];
    seconds += row.seconds;
    slowest = std::max(slowest, row.seconds);
    if (row.outcome != Outcome::ok && row.outcome != Outcome::broken) ++reasons[reason(row.said)];
    if (row.outcome != Outcome::ok || row.request < 0) continue;
    for (Group* to : {&group, &all}) {
      to->scaled_jacobian.push_back(row.scaled_jacobian);
      to->ratio.push_back(row.scaled_jacobian / row.first_scaled_jacobian);
    }
  }
  out << "| command | ok | refused | dropped | limited | broken | smallest scaled Jacobian (quantiles 0 / 1 / 5 / 25 / "
         "50 %) "
         "| divided by that of the file |\n|---|---|---|---|---|---|---|---|\n";
  for (const auto& [name, group] : groups) print(out, name, group);
  print(out, "all", all);
  out << "\n" << rows.size() << " commands, " << digits(seconds) << " s, the slowest " << digits(slowest) << " s\n\n";
  for (const auto& [text, n] : reasons) out << n << " times: " << text << "\n";
  for (const auto& row : rows)
    if (row.row.outcome == Outcome::broken) out << "BROKEN\t" << line(row, 0) << "\n";
}

}  // namespace hextwist::corpus
