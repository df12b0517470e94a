// SPDX-License-Identifier: Apache-2.0
// The tables of `kinalign eval`: means, people, paired tests, joints and radii.
#pragma once

#include "apps/kinalign/eval/comparison.h"

#include <string>
#include <vector>

namespace kinalign {

/// The rows that are finished, with what the captions say about all of them.
struct EvalRows {
  const Comparison& comparison;
  std::string folds;  // "folds of people"
  std::vector<MethodMarks> rows;
};

/// Writes each table as .md, .tex, .csv and .json into the folder of results.
Result<void> write_tables(const EvalRows& all, Call& call);

/// Prints the tables; a text splits the marks into tables that fit a terminal. Long tables of tests
/// are only written to files.
void print_tables(const EvalRows& all, const std::string& format, Call& call);

}  // namespace kinalign
