// The line that a long command shows.
#include "progress.h"

#include <gtest/gtest.h>

namespace hextwist::app {
namespace {

using namespace std::chrono_literals;

TEST(Progress, shows_nothing_in_the_first_second_and_then_share_and_time_left) {
  ProgressLine line;
  const ProgressLine::Clock::time_point begin{};
  line.begin(begin);
  line.report("split", 0.1, begin + 100ms);
  EXPECT_EQ(line.text(begin + 900ms), "");
  line.report("place", 0.25, begin + 2s);
  EXPECT_EQ(line.text(begin + 2s), "  place [#####...............]  25%, 6 s left (Ctrl-C cancels)");
  line.report("place", 0.5, begin + 300s);
  EXPECT_EQ(line.text(begin + 300s), "  place [##########..........]  50%, 5 min left (Ctrl-C cancels)");
}

TEST(Progress, does_not_show_a_share_that_stands_still_or_goes_back) {
  ProgressLine line;
  const ProgressLine::Clock::time_point begin{};
  line.begin(begin);
  line.report("verify", 0.9, begin + 3s);
  EXPECT_NE(line.text(begin + 3500ms).find("90%"), std::string::npos);
  EXPECT_EQ(line.text(begin + 5s), "  verify, 5 s so far (Ctrl-C cancels)");
  line.report("write", 0, begin + 6s);
  EXPECT_EQ(line.text(begin + 6s), "  write, 6 s so far (Ctrl-C cancels)");
  line.report("write", 0.95, begin + 6s);
  EXPECT_NE(line.text(begin + 6s).find("95%"), std::string::npos);
  line.begin(begin + 7s);
  EXPECT_EQ(line.text(begin + 7s), "");
}

TEST(Progress, tells_no_time_left_from_too_little) {
  ProgressLine line;
  const ProgressLine::Clock::time_point begin{};
  line.begin(begin);
  line.report("read", 0.01, begin + 2s);
  EXPECT_EQ(line.text(begin + 2s), "  read [....................]   1% (Ctrl-C cancels)");
}

}  // namespace
}  // namespace hextwist::app
