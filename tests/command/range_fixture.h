// Ranges as text, evaluated on a grid of 4 x 3 x 2 unit cubes with two blocks, a node set and a side set.
#pragma once

#include <gtest/gtest.h>

#include "command/meshed_brick.h"
#include "hextwist/command/command_error.h"
#include "hextwist/command/select/selection.h"
#include "hextwist/command/syntax.h"

namespace hextwist::test {

using Ids = std::vector<std::int64_t>;

struct RangeFixture {
  MeshedModel meshed = meshed_brick(4, 3, 2);
  std::vector<Group> groups;
  std::vector<std::string> notices;

  RangeFixture() {
    meshed.mesh.blocks = {{20, "right", {2, 3}}, {10, "left", {0, 1}}};
    meshed.mesh.node_sets = {{5, "corner", {0}}};
    meshed.mesh.side_sets = {{7, "low x", {{0, 0}, {4, 0}}}};
  }

  /// Ids of "hex in volume 1" and the like.
  Ids ids(const std::string& text) {
    DerivedTopology topology(meshed.mesh);
    const Selector selector{meshed, topology, groups};
    const auto statements = split_statements("list " + text);
    const Command command = parse(statements.at(0));
    const Item& item = *command.find("range");
    const std::string written = to_string(command);
    EXPECT_EQ(to_string(parse(split_statements(written).at(0))), written) << "not a fixed point: " << text;
    Ids result;
    for (const Index i : select(selector, command.statement, item.kind, item.range, notices))
      result.push_back(id_of(selector, item.kind, i));
    return result;
  }
  std::size_t n(const std::string& text) { return ids(text).size(); }

  std::string error(const std::string& text) {
    try {
      ids(text);
    } catch (const CommandError& error) {
      EXPECT_GE(error.column(), 6);
      return std::to_string(error.column() - 5) + ": " + error.message();  // column in `text`
    }
    return "no error";
  }
};

}  // namespace hextwist::test
