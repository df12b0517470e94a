// SPDX-License-Identifier: Apache-2.0
// A time on the host's axis, and how certain it is.
#pragma once

#include "kinalign/clock/assumptions.h"
#include "kinalign/wire/time.h"

#include <cstdint>
#include <optional>

namespace kinalign {

enum class Certainty : std::uint8_t {
  certified,  // the truth lies in the interval, as long as the assumptions hold
  one_sided,  // too few exchanges: one end is open, or the interval is not certified yet
  doubtful    // the exchanges around this time contradict the assumptions
};

/// True if a reading was surely taken after the counter stepped. `earliest`: earliest time that the
/// model gives to the reading; `arrival`: newest arrival when the reading was looked up. The model
/// puts a reading from before the step either before `from` or, while `from` has not come yet, into
/// the future. Example: a counter that stepped back by 20 ms at 30 s repeats its reading of that
/// moment at 30.02 s, which is `from`. If it stepped back by an hour, such a reading seems to lie
/// 59 minutes ahead. HostTime::min(): the counter has not stepped.
constexpr bool is_behind_step(HostTime earliest, HostTime from, HostTime arrival) {
  return from <= earliest && (earliest <= arrival || from <= arrival);
}

struct ClockStamp {
  HostTime time{};                           // the likeliest time
  std::optional<HostTime> earliest, latest;  // ends of the interval; absent: that end is open
  Certainty certainty = Certainty::one_sided;
  Assumptions assumptions;  // of the certificate
};

}  // namespace kinalign
