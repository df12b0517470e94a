// SPDX-License-Identifier: Apache-2.0
// A method of others: a program that is given a Kinect's joints and writes where they should be.
#pragma once

#include "apps/kinalign/benchmark/cleaning.h"

#include <string>
#include <vector>

namespace kinalign {

struct ProgramMethod {
  std::string name, program;
};

/// "NAME=PROGRAM". Fails for another text, and for a name that is not letters, digits, '-' and '_'.
Result<ProgramMethod> program_method(const std::string& words);

/// Its answers [T,Jout,3] m to each tested stretch. For each, PROGRAM is started with the names of
/// two NPZ files: it reads the first (docs/benchmark.md) and writes "positions" into the second.
/// Fails where it does not end well or writes another shape.
Result<std::vector<std::vector<float>>> answers_of_program(const ProgramMethod& method,
                                                           const std::string& folder,
                                                           const CleaningData& data, Call& call);

}  // namespace kinalign
