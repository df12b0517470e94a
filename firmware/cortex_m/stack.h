// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace kinalign {

/// The bytes of the stack that were ever written to: reset() fills the stack with a pattern, and
/// this counts the bytes from the lowest word without it.
std::uint32_t stack_used();

}  // namespace kinalign
