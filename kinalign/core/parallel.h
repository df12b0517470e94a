// SPDX-License-Identifier: Apache-2.0
// The only code that starts threads for computing. Results do not depend on the number of threads.
#pragma once

#include <cstddef>
#include <functional>

namespace kinalign {

/// Calls body(i) once for each i in [0, count), on at most `jobs` threads (1: on the caller's
/// thread). A call must not access data that another call writes. Returns when all calls are done.
/// If calls throw, the earliest exception is thrown again in the caller's thread.
void parallel_for(std::size_t count, std::size_t jobs,
                  const std::function<void(std::size_t)>& body);

}  // namespace kinalign
