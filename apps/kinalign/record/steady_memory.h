// SPDX-License-Identifier: Apache-2.0
// The memory of a program that receives for hours. It is taken at the start and kept, so that
// neither page faults nor a growing heap delay a datagram on its way to the file.
#pragma once

#include <cstddef>

namespace kinalign {

/// Call before other threads begin. Makes `bytes` resident for later allocations; freed memory
/// stays with the program.
void keep_memory(std::size_t bytes);

}  // namespace kinalign
