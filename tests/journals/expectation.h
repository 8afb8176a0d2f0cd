// What a journal test demands of the session that its journal leaves behind. See README.md for the keys.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hextwist/session/session.h"

namespace hextwist::test {

/// Everything that a journal did, as far as a user could see it.
struct Outcome {
  Session session;
  std::vector<std::string> printed, notes;
  std::string error;
  int error_line = 0;
  std::int64_t hexes_at_error = 0;  ///< hexes before the command that failed
};

/// Adds a failure unless the value is the expected number, or within the expected [least, most].
void expect_number(double value, const nlohmann::json& expected, const std::string& what);

/// Adds a failure for each promise that the mesh breaks: conformity, orientation, sets, ownership.
void expect_promises(const MeshedModel& meshed, const nlohmann::json& expected);

/// Adds a failure to the running test for each expectation that does not hold, and for each unknown key.
void expect_outcome(const Outcome& outcome, const nlohmann::json& expected);

}  // namespace hextwist::test
