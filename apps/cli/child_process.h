// SPDX-License-Identifier: Apache-2.0
// Other programs, started as child processes.
#pragma once

#include "kinalign/core/error.h"

#include <sys/types.h>

#include <array>
#include <string>
#include <vector>

namespace kinalign {

/// A pipe, [0] for reading and [1] for writing. Neither end is inherited, so the end of the output
/// of one child does not depend on another child.
Result<std::array<int, 2>> child_pipe();

/// Starts a program, which is searched in PATH if it has no '/'. `words`: its arguments from its
/// own name on. Standard input is /dev/null. `out` and `err` are copied to its standard output and
/// error; -1 stands for /dev/null.
Result<pid_t> start_child(const std::string& program, std::vector<std::string> words, int out,
                          int err);

/// Waits for the end. Returns the exit code; 128 plus the signal's number if a signal ended it, as
/// in a shell.
int wait_for_child(pid_t child);

}  // namespace kinalign
