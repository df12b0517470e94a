// SPDX-License-Identifier: Apache-2.0
// A time on the host's time axis, with the certainty of that time.
#pragma once

#include "kinalign/clock/assumptions.h"
#include "kinalign/wire/time.h"

#include <cstdint>
#include <optional>

namespace kinalign {

enum class Certainty : std::uint8_t {
  certified,  // the true time lies in the interval if the assumptions hold
  one_sided,  // too few exchanges: one end is unknown, or the interval is not certified yet
  doubtful    // the exchanges around this time contradict the assumptions
};

/// Returns whether a reading was certainly taken after the counter stepped. `earliest`: earliest
/// time that the model gives for the reading. `arrival`: newest arrival when the reading was
/// converted. `from`: first time at which no reading is ambiguous; HostTime::min() if the counter
/// has not stepped.
///
/// The model gives a reading from before the step a time before `from`, or a time in the future.
/// Example: the counter steps back by 20 ms at 30 s. It shows the reading of that moment again at
/// 30.02 s, which is `from`. If it steps back by an hour, that reading seems to be 59 minutes in
/// the future.
constexpr bool is_behind_step(HostTime earliest, HostTime from, HostTime arrival) {
  return from <= earliest && (earliest <= arrival || from <= arrival);
}

struct ClockStamp {
  HostTime time{};                           // the likeliest time
  std::optional<HostTime> earliest, latest;  // ends of the interval; absent: not known
  Certainty certainty = Certainty::one_sided;
  Assumptions assumptions;  // assumptions of the certificate
};

}  // namespace kinalign
