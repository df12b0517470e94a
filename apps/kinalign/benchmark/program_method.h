// SPDX-License-Identifier: Apache-2.0
// A user's own method: a program that reads a Kinect's joints and writes the corrected ones.
#pragma once

#include "apps/kinalign/benchmark/cleaning.h"

#include <string>
#include <vector>

namespace kinalign {

/// A method from outside of kinalign. Any program that can read and write NPZ (NumPy) can be
/// compared.
struct ProgramMethod {
  std::string name, program;
};

/// Parses "NAME=PROGRAM". Fails for another text, and if the name is not made of letters, digits,
/// '-' and '_'.
Result<ProgramMethod> program_method(const std::string& words);

/// The program's answers [T,Jout,3] m to each tested stretch. PROGRAM is started for each with the
/// names of two NPZ files: it reads the first (docs/benchmark.md) and writes "positions" into the
/// second. Fails if it does not end with exit code 0 or writes another shape.
/// The folder with both files is removed at the end. It is kept if the program fails.
Result<std::vector<std::vector<float>>> answers_of_program(const ProgramMethod& method,
                                                           const std::string& folder,
                                                           const CleaningData& data, Call& call);

}  // namespace kinalign
