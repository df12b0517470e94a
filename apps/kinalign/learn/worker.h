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

/// What is told while the program runs.
struct WorkerWatch {
  Progress progress{};
  std::function<void(const std::string& warning)> warn{};  // empty: warnings are dropped
  std::function<void(const std::string& row)> row{};  // of marks: a JSON object; empty: dropped
};

/// Runs kinalign-learn, which lies beside this program or in the tree that it was built from, with
/// that file. Returns its last line, a JSON object. Fails with the error that the program told of,
/// or where it is not installed.
Result<std::string> run_worker(const std::string& job_file, const WorkerWatch& watch);

/// The same as several processes that train together, a file each. The first one is watched. Where
/// one fails, the others are ended; the error is that of the one that failed by itself.
Result<std::string> run_workers(const std::vector<std::string>& job_files,
                                const WorkerWatch& watch);

/// A TCP port of this machine's loopback that nobody has now.
Result<std::uint16_t> free_port();

}  // namespace kinalign
