// SPDX-License-Identifier: Apache-2.0
// Memory of a program that receives for hours: taken at the start and kept, so that neither page
// faults nor the allocator's growth come between a datagram and the file.
#pragma once

#include <cstddef>

namespace kinalign {

/// Before other threads begin. Makes `bytes` resident for what is allocated from now on; what is
/// freed stays with the program.
void keep_memory(std::size_t bytes);

}  // namespace kinalign
