// SPDX-License-Identifier: Apache-2.0
// Runs work in a child process with limits, if a file may crash or hang the library that reads it.
// Whatever happens there becomes an ordinary error in this process. The child is a copy of this
// process (fork), so call it while no other thread runs.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/progress.h"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace kinalign {

/// The kernel enforces the limits of memory and processor time (setrlimit), the parent the others.
struct GuardLimits {
  std::uint64_t memory_bytes = std::uint64_t{2} << 30;  // more than the process uses at the start
  std::uint64_t cpu_seconds = 600;
  double wall_seconds = 3600.0;
  std::uint64_t output_bytes = std::uint64_t{1} << 30;  // for the forms that return a text
};

/// Sends bytes from the child to the parent. Fails if the parent has ended.
/// Used in the child only.
using GuardSend = std::function<Result<void>(std::string_view bytes)>;

/// Runs `work` in a child. The bytes that it sends reach `receive` in order, in pieces cut
/// anywhere. An error of either ends the job; errors of the work are passed on unchanged. A crash,
/// a hang or a lack of memory is also an error: "<file>: expected a take that HDF5 can read, found
/// one on which the library crashed (signal 11)". Its `file` and `expected` come from `blame`.
Result<void> run_guarded(const GuardLimits& limits, const Error& blame,
                         const std::function<Result<void>(const GuardSend&)>& work,
                         const std::function<Result<void>(std::string_view)>& receive);

/// The overload for work whose result is one text.
Result<std::string> run_guarded(const GuardLimits& limits, const Error& blame,
                                const std::function<Result<std::string>()>& work);
/// The overload for long work. Its progress reports reach `progress` in the parent, which can end
/// the job.
Result<std::string> run_guarded(const GuardLimits& limits, const Error& blame,
                                const Progress& progress,
                                const std::function<Result<std::string>(const Progress&)>& work);

}  // namespace kinalign
