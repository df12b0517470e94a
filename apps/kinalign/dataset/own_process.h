// SPDX-License-Identifier: Apache-2.0
// This program started again with other words: for verbs that fork, which no thread may do.
#pragma once

#include "kinalign/core/error.h"

#include <string>
#include <vector>

namespace kinalign {

struct Ended {
  int code = 0;           // exit code; 128 and the signal's number where a signal ended it
  std::string complaint;  // stderr, its beginning
};

/// Runs kinalign with these words behind its name, without a terminal, and waits for its end. Safe
/// to call from several threads.
Result<Ended> run_own_process(const std::vector<std::string>& words);

}  // namespace kinalign
