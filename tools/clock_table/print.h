// SPDX-License-Identifier: Apache-2.0
// A set, or what became of its bars, for who looks at it in a terminal.
#pragma once

#include "tools/clock_table/bars.h"

namespace kinalign {

/// "1 min, 15 frames a second, seeds 5 to 24": what a run is made again from.
std::string describe(const RunSet& set);

/// A table a link, what its certificates and starts were, and all links side by side.
void print_tables(const RunSet& set, std::span<const LinkFigures> tables);

/// A line a column, with the seed to look at, and how many were met.
void print_verdicts(const RunSet& set, std::span<const Verdict> verdicts);

}  // namespace kinalign
