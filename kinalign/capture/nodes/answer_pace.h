// SPDX-License-Identifier: Apache-2.0
// Decides which frames of a node get an answer. Up to 30 frames per second, every frame is
// answered; at higher rates every second or third frame, and so on. More exchanges would not
// improve the clock estimate (docs/clock.md), and each exchange takes radio time.
#pragma once

#include "kinalign/wire/time.h"

#include <cstdint>
#include <optional>

namespace kinalign {

/// The pace of one session. It counts seconds from the first frame.
class AnswerPace {
 public:
  static constexpr std::int64_t most_per_s = 30;

  /// Counts one received frame. Returns whether this frame is answered.
  bool ask(HostTime now);
  /// Frames per second in the last complete second. Absent during the first second.
  std::optional<double> rate_hz() const { return rate_hz_; }

 private:
  HostTime begin_{HostTime::min()};
  std::int64_t frames_ = 0, answers_ = 0, stride_ = 1;
  std::optional<double> rate_hz_;
};

}  // namespace kinalign
