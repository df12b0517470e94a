// SPDX-License-Identifier: Apache-2.0
// Starts the program kinalign-learn with a job and watches it.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/progress.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace kinalign {

/// The functions that are called with the output of kinalign-learn, by the thread that runs it.
struct WorkerWatch {
  Progress progress{};
  std::function<void(const std::string& warning)> warn{};  // empty: warnings are dropped
  std::function<void(const std::string& row)> row{};       // gets each JSON object with marks
};

/// Runs kinalign-learn with a job file and returns its last line, a JSON object. Fails with the
/// error that kinalign-learn reports, or if it is not installed. It must be in the folder of this
/// program or in the tree where this program was built.
Result<std::string> run_worker(const std::string& job_file, const WorkerWatch& watch);

/// Runs several processes that train together, with one job file each. The first process is
/// watched. If one fails, the others are ended. The error is that of the process that failed by
/// itself.
Result<std::string> run_workers(const std::vector<std::string>& job_files,
                                const WorkerWatch& watch);

/// A TCP port of this machine that is free when the function returns. Another program might take
/// the port before the workers do, which is unlikely.
Result<std::uint16_t> free_port();

}  // namespace kinalign
