// SPDX-License-Identifier: Apache-2.0
// Prints a set, or the verdicts on its bars, to a terminal.
#pragma once

#include "tools/clock_table/bars.h"

namespace kinalign {

/// "1 min, 15 frames a second, seeds 5 to 24": enough to repeat a run.
std::string describe(const RunSet& set);

/// Prints a table for each link, with its certificates and starts, and then all links side by side.
void print_tables(const RunSet& set, std::span<const LinkFigures> tables);

/// Prints a line for each column, with the seed to look at, and the number of bars that were met.
void print_verdicts(const RunSet& set, std::span<const Verdict> verdicts);

}  // namespace kinalign
