// SPDX-License-Identifier: Apache-2.0
// A counter of 32 bits made 64 wide.
#pragma once

#include <cstdint>

namespace kinalign {

/// Has to be asked at least once a turn (71.6 min at 1 us): every sample does.
class WideCounter {
 public:
  std::uint64_t widen(std::uint32_t now) {
    wide_ += now - static_cast<std::uint32_t>(wide_);  // modulo 2^32: the step since the last time
    return wide_;
  }

 private:
  std::uint64_t wide_ = 0;
};

}  // namespace kinalign
