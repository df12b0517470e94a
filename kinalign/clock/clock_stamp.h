// SPDX-License-Identifier: Apache-2.0
// When something happened on the host's axis, and how sure that is.
#pragma once

#include "kinalign/clock/assumptions.h"
#include "kinalign/wire/time.h"

#include <cstdint>
#include <optional>

namespace kinalign {

enum class Certainty : std::uint8_t {
  certified,  // the truth lies in the interval while the assumptions hold
  one_sided,  // too few exchanges: an end is open, or nothing may be claimed yet
  doubtful    // the exchanges contradict the assumptions around here
};

/// Whether a reading that can be as early as `earliest`, asked for when `heard` had arrived, is
/// surely not of before the counter stepped: such readings lie before `from`, or until then as if
/// they were still to come. A counter that stepped back by 20 ms at 30 s reads what it did then
/// again at 30.02 s: `from`. After one of an hour such a reading is one of 59 minutes ahead.
/// HostTime::min(): it has not stepped.
constexpr bool is_behind_step(HostTime earliest, HostTime from, HostTime heard) {
  return from <= earliest && (earliest <= heard || from <= heard);
}

struct ClockStamp {
  HostTime time{};                           // the likeliest
  std::optional<HostTime> earliest, latest;  // the interval; absent: that end is open
  Certainty certainty = Certainty::one_sided;
  Assumptions assumptions;  // under which it is certified
};

}  // namespace kinalign
