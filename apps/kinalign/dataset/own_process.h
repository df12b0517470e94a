// SPDX-License-Identifier: Apache-2.0
// Starts this program again with other arguments, for verbs that fork, which a thread must not do.
#pragma once

#include "kinalign/core/error.h"

#include <string>
#include <vector>

namespace kinalign {

/// The end of a child. Its standard output is discarded, so only files and this structure carry
/// results.
struct Ended {
  int code = 0;           // exit code; 128 plus the signal's number if a signal ended it
  std::string complaint;  // the beginning of stderr
};

/// Runs kinalign with these arguments, without a terminal, and waits for its end. Several threads
/// may call it.
/// Fails only if the child could not be started. A child that fails is a result with its exit code.
Result<Ended> run_own_process(const std::vector<std::string>& words);

}  // namespace kinalign
