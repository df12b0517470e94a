// SPDX-License-Identifier: Apache-2.0
// How far a long job is, told to whoever asked; and whether it should stop.
#pragma once

#include "kinalign/core/error.h"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace kinalign {

/// Called now and then with what is being done, and how much of how much (bytes, frames).
/// False: stop, the user wants no more. An empty Progress is silence.
using Progress =
    std::function<bool(std::string_view what, std::uint64_t done, std::uint64_t total)>;

inline bool go_on(const Progress& progress, std::string_view what, std::uint64_t done,
                  std::uint64_t total) {
  return !progress || progress(what, done, total);
}

/// What a job fails with that was told to stop.
inline Error interruption(std::string file = {}) {
  return {std::move(file), 0, "the end of the job", "an interruption", ErrorKind::interrupted};
}

inline bool is_interruption(const Error& error) { return error.kind == ErrorKind::interrupted; }

}  // namespace kinalign
