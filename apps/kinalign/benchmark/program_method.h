// SPDX-License-Identifier: Apache-2.0
// A user's own method: a program that reads the joints of a Kinect and writes better ones.
#pragma once

#include "apps/kinalign/benchmark/cleaning.h"

#include <string>
#include <vector>

namespace kinalign {

/// The name and the program of a user's method. Any program that can read and write NPZ (NumPy) can
/// be compared.
struct ProgramMethod {
  std::string name, program;
};

/// Parses "NAME=PROGRAM". The name may have letters, digits, '-' and '_'. Fails for any other text.
Result<ProgramMethod> program_method(const std::string& words);

/// The program's answers [frame, joint, 3] in m to each tested stretch. PROGRAM is started once for
/// each stretch with the names of two NPZ files. It reads the first one (docs/benchmark.md) and
/// writes "positions" into the second one. Fails if the exit code is not 0 or the shape is wrong.
/// The folder with both files is removed at the end, but kept after a failure.
Result<std::vector<std::vector<float>>> answers_of_program(const ProgramMethod& method,
                                                           const std::string& folder,
                                                           const CleaningData& data, Call& call);

}  // namespace kinalign
