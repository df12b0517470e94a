// SPDX-License-Identifier: Apache-2.0
// Chooses which frames of a node are answered. Up to 30 frames per second, all are answered; at
// higher rates every second, third, ... frame is. More exchanges do not improve the clock estimate
// (docs/clock.md), and each takes radio time.
#pragma once

#include "kinalign/wire/time.h"

#include <cstdint>
#include <optional>

namespace kinalign {

/// One for each session. It counts seconds from the first frame.
class AnswerPace {
 public:
  static constexpr std::int64_t most_per_s = 30;

  /// Counts one received frame. Returns whether to answer it.
  bool ask(HostTime now);
  /// Frames per second in the last complete second. Absent before the first one.
  std::optional<double> rate_hz() const { return rate_hz_; }

 private:
  HostTime begin_{HostTime::min()};
  std::int64_t frames_ = 0, answers_ = 0, stride_ = 1;
  std::optional<double> rate_hz_;
};

}  // namespace kinalign
