// SPDX-License-Identifier: Apache-2.0
// The counts of a twin next to the paper's counts.
#pragma once

#include "kinalign/dataset/twin/twin_plan.h"
#include "kinalign/view/table.h"

#include <vector>

namespace kinalign {

/// Frames by people (the paper's table 6), by classes (table 7) and by devices. Each table compares
/// the paper, the scale's plan and the takes made.
/// The plan can't meet the paper's counts exactly at a small scale, so all three are shown next to
/// each other.
std::vector<Table> twin_tables(double scale, const TwinCounts& made);

}  // namespace kinalign
