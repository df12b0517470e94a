// SPDX-License-Identifier: Apache-2.0
// Reports the progress of a long job, and asks whether the job should stop.
#pragma once

#include "kinalign/core/error.h"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace kinalign {

/// Called now and then with a description of the work, the amount done and the total, in bytes or
/// frames. Returns false if the user wants to stop. An empty Progress reports nothing.
using Progress =
    std::function<bool(std::string_view what, std::uint64_t done, std::uint64_t total)>;

inline bool go_on(const Progress& progress, std::string_view what, std::uint64_t done,
                  std::uint64_t total) {
  return !progress || progress(what, done, total);
}

/// The error of a job that the user stopped.
inline Error interruption(std::string file = {}) {
  return {std::move(file), 0, "the end of the job", "an interruption", ErrorKind::interrupted};
}

inline bool is_interruption(const Error& error) { return error.kind == ErrorKind::interrupted; }

}  // namespace kinalign
