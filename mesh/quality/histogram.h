// Histogram as text for the terminal.
#pragma once

#include <span>
#include <string>

namespace hextwist {

/// One line per bin, from the smallest values up: its bounds, how many values lie there, and a bar:
///
///     0.4913 .. 0.6609       12  ##
///     0.6609 .. 0.8304      300  ##################################################
///     0.8304 .. 1            26  ####
///
/// The bins divide smallest to largest evenly; a value on a bound counts to the bin above it, the largest to the last
/// bin. The fullest bin has 50 marks, any that is not empty at least one. When all values are equal, to the digits that
/// are shown, there is one bin.
/// "" for no values. bins >= 1 and finite values are preconditions.
std::string histogram(std::span<const double> values, int bins = 10);

}  // namespace hextwist
