#pragma once

namespace hextwist::app {

inline constexpr int done = 0;
inline constexpr int command_failed = 1;
inline constexpr int wrong_usage = 2;

}  // namespace hextwist::app
