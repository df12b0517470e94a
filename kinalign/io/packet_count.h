// SPDX-License-Identifier: Apache-2.0
// A device's own count of its packets, in 16 bits or 32.
#pragma once

#include "kinalign/core/error.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

namespace kinalign {

/// Counts on over a 16-bit counter's wraps.
class PacketCount {
 public:
  /// The packet's place among all, which falls where one was overtaken by the next or the device
  /// began anew. Fails, without a place, on what is no counter.
  Result<std::int64_t> next(double cell) {
    constexpr double most = 4294967295.0;
    if (!(cell >= 0.0) || cell > most || cell != std::floor(cell)) {
      return Failure(Error{"", 0, "a whole PacketCounter", std::to_string(cell)});
    }
    const auto counter = static_cast<std::int64_t>(cell);
    count_ += rows_++ == 0 ? counter : step_to(counter);
    last_ = counter;
    if (rows_ == 1 || count_ > highest_) {
      lost_ += rows_ == 1 ? 0 : count_ - highest_ - 1;
      highest_ = count_;
    } else if (lost_ > 0 && count_ < highest_) {
      --lost_;  // it was only late
    }
    return count_;
  }

  std::int64_t lost() const { return lost_; }
  /// The longest loss that is only guessed, since the counter fell: a device that began anew?
  std::int64_t guessed() const { return guessed_; }

 private:
  /// Sixteen bits wrap. A packet that was overtaken lies little behind; any other fall is a wrap.
  std::int64_t step_to(std::int64_t counter) {
    constexpr std::int64_t wrap = 65'536, most_late = 1000;
    const std::int64_t plain = counter - last_;
    if (plain >= 0 && (counter >= wrap || wrap - plain > most_late)) return plain;
    const std::int64_t forward = (plain % wrap + wrap) % wrap;
    if (wrap - forward <= most_late) return forward - wrap;
    if (forward > most_late) guessed_ = std::max(guessed_, forward);
    return forward;
  }

  std::int64_t rows_ = 0, last_ = 0, count_ = 0, highest_ = 0, lost_ = 0, guessed_ = 0;
};

}  // namespace kinalign
