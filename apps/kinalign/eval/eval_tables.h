// SPDX-License-Identifier: Apache-2.0
// The tables of `kinalign eval`: means, values of people, paired tests, joints and radii.
#pragma once

#include "apps/kinalign/eval/comparison.h"

#include <string>
#include <vector>

namespace kinalign {

/// The rows that are finished, and the facts for the captions of all tables.
struct EvalRows {
  const Comparison& comparison;
  std::string folds;  // "folds of people"
  std::vector<MethodMarks> rows;
};

/// Writes each table as .md, .tex, .csv and .json into the folder of results.
Result<void> write_tables(const EvalRows& all, Call& call);

/// Prints the tables. In the format "text" a wide table is split into several that fit a terminal.
/// Long tables of tests are written to files only.
void print_tables(const EvalRows& all, const std::string& format, Call& call);

}  // namespace kinalign
