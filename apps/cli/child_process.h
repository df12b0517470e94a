// SPDX-License-Identifier: Apache-2.0
// Starts other programs as child processes and waits for them.
#pragma once

#include "kinalign/core/error.h"

#include <sys/types.h>

#include <array>
#include <string>
#include <vector>

namespace kinalign {

/// Opens a pipe: [0] is the end for reading, [1] the end for writing. No child inherits either end.
/// A reader therefore sees the end of a child's output even while another child runs.
Result<std::array<int, 2>> child_pipe();

/// Starts a program. A name without '/' is searched in PATH. `words` are the program's arguments;
/// the first word is the program's own name. The program's standard input is /dev/null. Its
/// standard output and error go to the descriptors `out` and `err`; -1 stands for /dev/null.
Result<pid_t> start_child(const std::string& program, std::vector<std::string> words, int out,
                          int err);

/// Waits until the child has ended. Returns the child's exit code. If a signal ended the child,
/// returns 128 plus the signal's number, as a shell does.
int wait_for_child(pid_t child);

}  // namespace kinalign
