// SPDX-License-Identifier: Apache-2.0
// Functions that join values to bytes, for tests.
#pragma once

#include <cstdint>
#include <vector>

namespace kinalign {

using Bytes = std::vector<std::uint8_t>;

inline Bytes& operator+=(Bytes& bytes, const Bytes& more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
  return bytes;
}

}  // namespace kinalign
