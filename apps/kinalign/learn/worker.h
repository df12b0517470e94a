// SPDX-License-Identifier: Apache-2.0
// The program kinalign-learn, started with a job and watched.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/progress.h"

#include <functional>
#include <string>

namespace kinalign {

/// What is told while the program runs.
struct WorkerWatch {
  Progress progress{};
  std::function<void(const std::string& warning)> warn{};  // empty: warnings are dropped
};

/// Runs kinalign-learn, which lies beside this program or in the tree that it was built from, with
/// that file. Returns its last line, a JSON object. Fails with the error that the program told of,
/// or where it is not installed.
Result<std::string> run_worker(const std::string& job_file, const WorkerWatch& watch);

}  // namespace kinalign
