// SPDX-License-Identifier: Apache-2.0
// The only code that starts threads. Results do not depend on their number.
#pragma once

#include <cstddef>
#include <functional>

namespace kinalign {

/// Calls body(i) once for each i in [0, count), on at most `jobs` threads (1: on the caller's
/// thread). A call must not access data that another one writes. Returns when all calls are done.
/// If calls threw exceptions, the first one by time is thrown again here.
void parallel_for(std::size_t count, std::size_t jobs,
                  const std::function<void(std::size_t)>& body);

}  // namespace kinalign
