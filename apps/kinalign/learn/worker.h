// SPDX-License-Identifier: Apache-2.0
// The program kinalign-learn, started with a job and watched.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/progress.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace kinalign {

/// The callbacks for the output of a running kinalign-learn.
/// All callbacks are called by the thread that runs the worker, while its output is read.
struct WorkerWatch {
  Progress progress{};
  std::function<void(const std::string& warning)> warn{};  // empty: warnings are dropped
  std::function<void(const std::string& row)> row{};       // a JSON object with marks
};

/// Runs kinalign-learn with a job file. The program lies in this program's folder or in the tree
/// that it was built from. Returns its last line, a JSON object. Fails with the error that it
/// reported, or if it is not installed.
Result<std::string> run_worker(const std::string& job_file, const WorkerWatch& watch);

/// Runs several processes that train together, with a job file each. The first one is watched. If
/// one fails, the others are ended; the error is that of the process that failed by itself.
Result<std::string> run_workers(const std::vector<std::string>& job_files,
                                const WorkerWatch& watch);

/// A free TCP port of this machine's loopback.
/// The port is free when the function returns. Another program could take it before the workers do,
/// which is unlikely but not excluded.
Result<std::uint16_t> free_port();

}  // namespace kinalign
