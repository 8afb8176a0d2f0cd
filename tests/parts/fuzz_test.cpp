// Random meshes, commands, partitions and halos, by several processes and from disk to disk, against one process: the
// joined file is the same byte for byte, or the refinement is refused in a sentence that says why.
//
// HEXTWIST_SEED=n begins with that seed, HEXTWIST_RUNS=n makes so many runs.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <random>

#include "hextwist/base/text.h"
#include "hextwist/io/file_part.h"
#include "hextwist/mesh/quality/quality.h"
#include "hextwist/parts/files.h"
#include "hextwist/parts/on_disk.h"
#include "hextwist/session/session.h"
#include "io/io_support.h"
#include "ranks_support.h"
#include "split_judge.h"

namespace hextwist {
namespace {

using test::model;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  int number(int low, int high) {  // both included
    return low + static_cast<int>(engine_() % static_cast<unsigned>(high - low + 1));
  }
  bool one_in(int n) { return number(1, n) == 1; }
  template <class T>
  const T& of(const std::vector<T>& items) {
    return items[static_cast<std::size_t>(number(0, static_cast<int>(items.size()) - 1))];
  }

 private:
  std::mt19937 engine_;
};

struct Input {
  std::filesystem::path mesh;
  std::string cad;  ///< empty: none
};

const std::vector<std::string> names = {"bracket",       "bracket_fillet", "plate_hole",   "cam",       "sphere",
                                        "pipe_tee",      "curved_plate",   "notched_cube", "l_block",   "inclusion",
                                        "plate_quarter", "cylinder",       "bent_bar",     "ring_twist"};

/// Grids with their numbers in any order, sets, fields and gaps among ids; tidy ones; models, coarse or refined.
Input random_input(Random& random, const std::filesystem::path& folder, bool may_be_on_cad) {
  Input input;
  const int kind = random.number(0, may_be_on_cad ? 4 : 2);
  input.mesh = folder / "input.e";
  if (kind == 0) {
    const std::array<int, 3> cells = {random.number(6, 40), random.number(2, 4), random.number(2, 3)};
    Mesh mesh = test::rich_mesh(static_cast<unsigned>(random.number(1, 1 << 20)), random.one_in(2), cells);
    if (!may_be_on_cad || random.one_in(2)) {  // as most files are, and as it must be from disk to disk
      mesh.blocks = {{3, "", {}}};
      for (Index h = 0; h < mesh.n_hexes(); ++h) mesh.blocks[0].hexes.push_back(h);
    }
    write_mesh(input.mesh, mesh, nullptr);
  } else if (kind == 1) {
    Session session;
    const auto interval = [&](int high) { return " " + std::to_string(random.number(2, high)); };
    session.run("create brick x 4 y 3 z 2 interval" + interval(40) + interval(4) + interval(3));
    session.run("nodeset 7 add surface 1 2; sideset 3 add surface 5");
    session.export_mesh(input.mesh);
  } else {
    const std::string name = random.of(names);
    Session session;
    if (kind > 2) input.cad = model(name + ".brep"), session.import_cad(input.cad);
    session.import_mesh(model(name + ".msh"));
    if (random.one_in(3) && session.meshed().mesh.n_hexes() < 150) session.run("refine volume all numsplit 1");
    session.export_mesh(input.mesh);
  }
  return input;
}

std::string random_ids(Random& random, std::int64_t low, std::int64_t high) {
  const auto id = [&] { return low + random.number(0, static_cast<int>(high - low)); };
  switch (random.number(0, 3)) {
    case 0: {
      std::string list;
      for (int n = random.number(1, 12); n > 0; --n) list += " " + std::to_string(id());
      return list;
    }
    case 1: {  // every few
      std::string list;
      const int step = random.number(2, 40);
      for (std::int64_t k = low + random.number(0, step); k <= high; k += step) list += " " + std::to_string(k);
      return list.empty() ? " " + std::to_string(low) : list;
    }
    case 2: {
      const auto [first, last] = std::minmax({id(), id()});
      return " " + std::to_string(first) + " to " + std::to_string(last);
    }
    default: {
      const auto [first, last] = std::minmax({id(), id()});
      return " " + std::to_string(first) + " to " + std::to_string(last) + " by " +
             std::to_string(random.number(1, 17));
    }
  }
}

std::string random_hexes(Random& random, const Mesh& mesh) {
  return "hex" + random_ids(random, hex_id(mesh, 0), hex_id(mesh, mesh.n_hexes() - 1));
}
std::string random_entity(Random& random, const Model& model) {
  const int dim = random.number(0, 2);
  const char* const words[] = {"vertex ", "curve ", "surface "};
  return words[dim] + std::to_string(random.number(1, std::max(1, model.count(dim))));
}

/// Sizes around what the hexes have. Some are met in parts, some by the first rank, most are refused from disk to disk:
/// there those that are not come more often.
std::string random_sizes(Random& random, const MeshedModel& meshed, bool by_ranks) {
  const double edge = std::cbrt(average_volume(meshed.mesh));
  const auto size = [&] { return short_number(edge * random.number(4, 12) / 10); };
  const auto growth = [&] { return "1." + std::to_string(random.number(2, 9)); };
  const auto entity = [&] { return random_entity(random, *meshed.model); };
  std::string command;
  if (random.one_in(3)) {
    const std::string where = random.one_in(3) ? "volume all" : random.one_in(2) ? entity() : "hex in " + entity();
    command = random.one_in(3)
                  ? "refine " + where + " sizing_function \"" + size() + "*(1 + 0.3*abs(x))\""
                  : "sizing function f" + std::to_string(random.number(1, 2)) + " linear " + entity() + " size " +
                        size() + " growth " + growth() + "; refine " + where + " sizing_function";
  } else {
    command = "refine " + (random.one_in(5) ? random_hexes(random, meshed.mesh) : entity()) + " size " + size();
    if (!random.one_in(5)) command += " bias " + growth();
    if (random.one_in(6)) command += " radius " + short_number(edge * random.number(5, 30) / 10);
  }
  if (!by_ranks && !random.one_in(3)) return command + " transition regular";
  if (random.one_in(3)) command += " method single";
  if (random.one_in(3)) command += random.one_in(2) ? " transition regular" : " transition nested";
  return command;
}

/// What the first rank does with the whole mesh.
std::string random_whole_command(Random& random, const MeshedModel& meshed, bool is_first) {
  const auto hexes = [&] { return random_hexes(random, meshed.mesh); };
  const auto entities = [&] { return random_entity(random, *meshed.model); };
  switch (random.number(2, is_first ? 5 : 7)) {
    case 2:
      return "refine " + hexes() + " smooth";
    case 3:
      return "refine " + hexes() + " method parallel";
    case 4:
      return "refine " + entities() + " direction thickness";
    case 5:
      return "smooth volume all iterations 2";
    case 6:
      return "coarsen " + (random.one_in(2) ? hexes() : entities());
    default:
      return "refine " + hexes();  // a second level
  }
}

/// For what the session has by now. is_first: nothing was refined; later a second level would be refused.
std::string random_command(Random& random, const MeshedModel& meshed, bool is_first) {
  const Mesh& mesh = meshed.mesh;
  std::string command = "refine ";
  const int kind = random.number(0, random.one_in(4) ? 11 : 10);
  bool is_solid = false;
  if (kind < 4) {
    command += "hex" + random_ids(random, hex_id(mesh, 0), hex_id(mesh, mesh.n_hexes() - 1));
    is_solid = true;
  } else if (kind < 6) {
    command += "node" + random_ids(random, node_id(mesh, 0), node_id(mesh, mesh.n_nodes() - 1));
  } else if (kind < 10 && meshed.model) {
    const int dim = random.of(std::vector<int>{0, 1, 1, 2, 2, 2});
    const char* const words[] = {"vertex", "curve", "surface"};
    const int n = meshed.model->count(dim);
    if (n == 0) return "refine volume all";
    command += words[dim];
    for (int k = random.of(std::vector<int>{1, 1, 1, 2, 3}); k > 0; --k)
      command += " " + std::to_string(random.number(1, n));
    if (random.one_in(12)) return command + " radius " + std::to_string(random.number(1, 20) / 10.0);
  } else if (kind == 10 && !mesh.side_sets.empty()) {
    command += "hex in surface " + std::to_string(random.number(1, std::max(1, meshed.model->count(2))));
    is_solid = true;
  } else {
    command += "volume all";
    if (random.one_in(2)) command += " numsplit " + std::to_string(random.number(1, 2));
    return command;
  }
  const bool has_depth = is_solid ? random.one_in(4) : random.one_in(2);
  const int depth = has_depth ? random.number(is_solid, 2) : 0;
  if (has_depth) command += " depth " + std::to_string(depth);
  const bool is_whole = is_solid || depth > 0;
  if (is_whole || random.one_in(10)) {
    if (random.one_in(4)) command += " numsplit " + std::to_string((random.one_in(12) ? 3 : 2));
    if (random.one_in(4)) command += " concave fill";
    if (is_first ? random.one_in(5) : !random.one_in(5)) command += " transition nested";
  } else if (random.one_in(4)) {
    command += random.one_in(2) ? " method parallel" : " transition nested numsplit 2";
  }
  if (random.one_in(10)) command += " graded";
  return command;
}

/// What happened in all runs of a test. gathered: of those that are the same.
struct Tally {
  int same = 0, gathered = 0, refused = 0, wrong_anyhow = 0;
};

/// Ranks refuse no command.
bool is_refusal(const std::string& said, bool by_ranks) {
  std::vector<const char*> parts = {"has no ", "can't be shared out"};
  if (!by_ranks) parts.insert(parts.end(), {"not done part after part", "are not refined from disk to disk"});
  return std::ranges::any_of(parts, [&](const char* part) { return said.find(part) != std::string::npos; });
}

void expect_same(const std::filesystem::path& folder, int n, const std::string& all_said) {
  std::string faults;
  for (const std::string& line : test::split_faults(folder / "fine.e", n)) faults += line + "\n";
  EXPECT_EQ(faults, "");
  join_files(part_name(folder / "fine.e", n, 0), folder / "joined.e");
  EXPECT_TRUE(test::same_mesh(read_mesh(folder / "serial.e").mesh, read_mesh(folder / "joined.e").mesh));
  EXPECT_EQ(test::text_of(folder / "joined.e") == test::text_of(folder / "serial.e"), true) << all_said;
}

/// One run. by_ranks: by several processes, else from disk to disk.
void try_one(unsigned seed, bool by_ranks, Tally& counts) {
  Random random(seed);
  const auto folder = test::output_folder();
  const Input input = random_input(random, folder, by_ranks);
  // What one process makes of it, and of which sentences.
  Session session;
  if (!input.cad.empty()) session.import_cad(input.cad);
  session.import_mesh(input.mesh);
  std::string commands, serial_error;
  constexpr Index most_hexes = 12000;
  int n_left = random.of(std::vector<int>{1, 1, 2, 3});
  for (int k = 0; n_left > 0 && k < 12; ++k) {
    const std::string command = random.one_in(3) ? random_sizes(random, session.meshed(), by_ranks)
                                : by_ranks && random.one_in(4)
                                    ? random_whole_command(random, session.meshed(), commands.empty())
                                    : random_command(random, session.meshed(), commands.empty());
    try {
      session.run(command);
    } catch (const std::exception& error) {
      if (k < 11 && !random.one_in(10)) continue;  // another one instead
      serial_error = error.what();
    }
    commands += (commands.empty() ? "" : "; ") + command;
    --n_left;
    if (!serial_error.empty() || session.meshed().mesh.n_hexes() > most_hexes) break;
  }
  const int n = random.of(std::vector<int>{1, 2, 2, 3, 4, 4, 8}), rings = random.number(1, 6);
  std::vector<std::string> ways = {"slabs", "ids", "random", "boxes"};
  if (has_scotch()) ways.push_back("scotch");
  const std::string by = random.of(ways);
  const bool is_split = !by_ranks || random.one_in(3);
  SCOPED_TRACE("seed " + std::to_string(seed) + ": " + commands + " of " + input.mesh.string() + " on '" + input.cad +
               "' by " + std::to_string(n) + ", " + by + (is_split ? ", split" : "") + ", rings " +
               std::to_string(rings));
  if (session.meshed().mesh.n_hexes() > most_hexes) return;
  if (std::getenv("HEXTWIST_RUNS"))
    std::cout << "seed " << seed << ": " << commands << (serial_error.empty() ? "" : ": " + serial_error) << std::endl;
  if (serial_error.empty()) session.export_mesh(folder / "serial.e");

  std::string said, all_said;
  try {
    std::filesystem::path from = input.mesh;
    if (is_split) {
      const int n_split = by_ranks ? random.of(std::vector<int>{2, n}) : n;
      split_file(input.mesh, folder / "parts.e", n_split, partition_by(by));
      from = part_name(folder / "parts.e", n_split, 0);
    }
    if (by_ranks) {
      const test::Outcome outcome =
          test::run_ranks(n, (input.cad.empty() ? "" : "--cad '" + input.cad + "' ") + "'" + from.string() + "' " +
                                 (is_split ? "" : "--by " + by) + " --rings " + std::to_string(rings) + " -c '" +
                                 commands + "' -o '" + (folder / "fine.e").string() + "'");
      all_said = outcome.out + outcome.err;
      if (outcome.status != 0) said = outcome.err.empty() ? "no word" : outcome.err;
    } else {
      refine_on_disk(from, PartCommands(std::vector{commands}), folder / "fine.e", {rings, {}},
                     [&](const std::string& line) { all_said += line + "\n"; });
    }
  } catch (const std::exception& error) {
    said = error.what();
  }
  if (!serial_error.empty()) {
    EXPECT_NE(said, "") << "one process says: " << serial_error;
    ++counts.wrong_anyhow;
  } else if (!said.empty()) {
    EXPECT_TRUE(is_refusal(said, by_ranks)) << said;
    ++counts.refused;
    if (std::getenv("HEXTWIST_RUNS")) std::cout << "seed " << seed << ": " << commands << ": " << said << "\n";
  } else {
    expect_same(folder, n, all_said);
    ++counts.same;
    if (all_said.find("the first process does it") != std::string::npos) ++counts.gathered;
    if (std::getenv("HEXTWIST_RUNS") && all_said.find("needed") != std::string::npos)
      std::cout << "seed " << seed << ": " << commands << " on '" << input.cad << "': " << all_said << "\n";
  }
}

unsigned number_from(const char* name, unsigned otherwise) {
  const char* const text = std::getenv(name);
  return text ? static_cast<unsigned>(std::strtoul(text, nullptr, 10)) : otherwise;
}

void expect_same_in_all(unsigned first, unsigned n_runs, bool by_ranks) {
  first = number_from("HEXTWIST_SEED", first);
  n_runs = number_from("HEXTWIST_RUNS", n_runs);
  Tally counts;
  for (unsigned seed = first; seed < first + n_runs; ++seed) {
    try_one(seed, by_ranks, counts);
    if (std::getenv("HEXTWIST_RUNS"))
      std::cout << seed << ": " << counts.same << ", " << counts.refused << ", " << counts.wrong_anyhow << std::endl;
    if (testing::Test::HasFailure()) break;
  }
  std::cout << counts.same << " the same (" << counts.gathered << " of them by the first process), " << counts.refused
            << " refused, " << counts.wrong_anyhow << " that one process refuses too\n";
  if (n_runs >= 20) {
    EXPECT_GT(counts.same, static_cast<int>(n_runs / 3)) << "too few were compared";
  }
}

TEST(RandomInRanks, is_the_same_as_by_one) {
  expect_same_in_all(1, 6, true);
}
TEST(RandomOnDisk, is_the_same_as_at_once) {
  expect_same_in_all(21, 4, false);
}
TEST(SlowRandomInRanks, is_the_same_as_by_one) {
  expect_same_in_all(100, 20, true);
}
TEST(SlowRandomOnDisk, is_the_same_as_at_once) {
  expect_same_in_all(100, 15, false);
}

}  // namespace
}  // namespace hextwist
