// SPDX-License-Identifier: Apache-2.0
// Work on a file that may crash or hang the library that reads it, done in a child process with
// limits: whatever happens there is an ordinary error here.
// The child is a copy of this process (fork): call while no other thread runs.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/progress.h"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace kinalign {

struct GuardLimits {
  std::uint64_t memory_bytes = std::uint64_t{2} << 30;  // beyond what is in use at the start
  std::uint64_t cpu_seconds = 600;
  double wall_seconds = 3600.0;
  std::uint64_t output_bytes = std::uint64_t{1} << 30;  // of the form that returns a text
};

/// Hands bytes from the child to the parent; fails where the parent has gone.
using GuardSend = std::function<Result<void>(std::string_view bytes)>;

/// Runs `work` in a child. What it sends comes to `receive` piece by piece, in order, cut anywhere;
/// an error of either ends the job. Errors of the work come through unchanged. A crash, a hang or a
/// lack of memory is an error: "<file>: expected a take that HDF5 can read, found one on which the
/// library crashed (signal 11)", where `file` and `expected` are of `blame`.
Result<void> run_guarded(const GuardLimits& limits, const Error& blame,
                         const std::function<Result<void>(const GuardSend&)>& work,
                         const std::function<Result<void>(std::string_view)>& receive);

/// The same for work whose result is one text.
Result<std::string> run_guarded(const GuardLimits& limits, const Error& blame,
                                const std::function<Result<std::string>()>& work);
/// The same for long work. What it tells of its progress reaches `progress` here, which can end it.
Result<std::string> run_guarded(const GuardLimits& limits, const Error& blame,
                                const Progress& progress,
                                const std::function<Result<std::string>(const Progress&)>& work);

}  // namespace kinalign
