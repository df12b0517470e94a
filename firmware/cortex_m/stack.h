// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace kinalign {

/// Bytes of the stack that were ever written to, by the paint that is gone.
std::uint32_t stack_used();

}  // namespace kinalign
