// SPDX-License-Identifier: Apache-2.0
// Starts kinalign as a second process. A thread uses it to run a verb that forks, since a thread
// must not fork.
#pragma once

#include "kinalign/core/error.h"

#include <string>
#include <vector>

namespace kinalign {

/// The result of a child process. Its standard output is discarded.
struct Ended {
  int code = 0;           // exit code; 128 plus the number of the signal that ended the child
  std::string complaint;  // the beginning of the child's stderr
};

/// Runs kinalign with these arguments, without a terminal, and waits until it ends. Several threads
/// may call it. Fails only if the child can't be started. An error of the child shows in its exit
/// code.
Result<Ended> run_own_process(const std::vector<std::string>& words);

}  // namespace kinalign
