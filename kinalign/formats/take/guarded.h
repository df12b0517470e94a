// SPDX-License-Identifier: Apache-2.0
// Runs work in a child process with limits, because a file may crash or block the library that
// reads it. A crash there becomes an ordinary error in this process. The child is a copy of this
// process (fork), so no other thread may run during the call.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/progress.h"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace kinalign {

/// Limits of the child. The kernel enforces memory and processor time (setrlimit). The parent
/// enforces the other limits.
struct GuardLimits {
  std::uint64_t memory_bytes = std::uint64_t{2} << 30;  // beyond the memory in use before
  std::uint64_t cpu_seconds = 600;
  double wall_seconds = 3600.0;
  std::uint64_t output_bytes = std::uint64_t{1} << 30;  // for results that are a text
};

/// Sends bytes from the child to the parent. Fails if the parent has ended.
using GuardSend = std::function<Result<void>(std::string_view bytes)>;

/// Runs `work` in a child process. The bytes that it sends reach `receive` in order, in pieces that
/// may be cut anywhere. An error of either function ends the job and is returned unchanged. A
/// crash, a blocked child or a lack of memory is also an error, for example "<file>: expected a
/// take that HDF5 can read, found one on which the library crashed (signal 11)". Its `file` and
/// `expected` come from `blame`.
Result<void> run_guarded(const GuardLimits& limits, const Error& blame,
                         const std::function<Result<void>(const GuardSend&)>& work,
                         const std::function<Result<void>(std::string_view)>& receive);

/// Like the function above, for work whose result is a single text.
Result<std::string> run_guarded(const GuardLimits& limits, const Error& blame,
                                const std::function<Result<std::string>()>& work);
/// Like the function above, for long work. Its progress reports reach `progress` in the parent,
/// which can stop the job.
Result<std::string> run_guarded(const GuardLimits& limits, const Error& blame,
                                const Progress& progress,
                                const std::function<Result<std::string>(const Progress&)>& work);

}  // namespace kinalign
