// SPDX-License-Identifier: Apache-2.0
// Which frames of a node are answered: all up to 30 in a second, of more every second, third, …
// More exchanges do not make its clock better (docs/clock.md), and take the radio's time.
#pragma once

#include "kinalign/wire/time.h"

#include <cstdint>
#include <optional>

namespace kinalign {

class AnswerPace {
 public:
  static constexpr std::int64_t most_per_s = 30;

  /// A frame came; whether to answer it.
  bool ask(HostTime now);
  /// Frames a second, of the last second that is over; absent before the first is.
  std::optional<double> rate_hz() const { return rate_hz_; }

 private:
  HostTime begin_{HostTime::min()};
  std::int64_t frames_ = 0, answers_ = 0, stride_ = 1;
  std::optional<double> rate_hz_;
};

}  // namespace kinalign
