// SPDX-License-Identifier: Apache-2.0
// Runs the program for main(): finds the verb, sets its options, runs it and returns the exit code.
#pragma once

#include "apps/cli/verb.h"

#include <string>
#include <vector>

namespace kinalign {

/// The exit codes, as docs/commands.md states them. Shells use 130 for a program that SIGINT has
/// ended.
enum ExitCode : int { done = 0, findings = 1, wrong_use = 2, failed = 3, stopped = 130 };

/// Runs the program. `words`: the command line without the program's name.
int run_program(const std::vector<Verb>& verbs, const std::vector<std::string>& words,
                const Surroundings& surroundings);

}  // namespace kinalign
