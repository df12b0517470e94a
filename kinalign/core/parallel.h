// SPDX-License-Identifier: Apache-2.0
// The only place where threads begin. Results do not depend on their number.
#pragma once

#include <cstddef>
#include <functional>

namespace kinalign {

/// Calls body(i) once for each i in [0, count), on at most `jobs` threads (1: on the caller's).
/// Bodies must not touch what another one writes. Returns when all are done; an exception that a
/// body threw (the first by time) is then thrown here.
void parallel_for(std::size_t count, std::size_t jobs,
                  const std::function<void(std::size_t)>& body);

}  // namespace kinalign
