// A judge of split files that reads them with netCDF alone, by the names that the files have inside: it knows neither
// our code nor the Exodus library.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hextwist::test {

/// What is wrong with the parts name.n.0 .. name.n.(n - 1), one line each; empty when nothing is:
///  1. each part says that it is one of n, and the same global counts, which are those of the union;
///  2. ids ascend within blocks and are unique over all parts (hexes), nodes of the same id are at the same place;
///  3. inner and border nodes are all nodes, each once; border nodes are exactly those that other parts have too;
///  4. every node that two parts have is in the map of either for the other, in the same order;
///  5. every face that a hex of one part shares with a hex of another is in both maps, at the same place.
/// most: lines.
std::vector<std::string> split_faults(const std::filesystem::path& name, int n_parts, std::size_t most = 10);

}  // namespace hextwist::test
