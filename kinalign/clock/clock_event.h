// SPDX-License-Identifier: Apache-2.0
// Events of a node's clock, such as a boot, a step, or stamps that are no longer certified. A piece
// is a stretch of time in which one model of the clock is valid; a floor is the least delay in one
// direction (docs/clock.md).
#pragma once

#include "kinalign/clock/exchange.h"

#include <cstdint>
#include <optional>

namespace kinalign {

struct ClockEvent {
  enum class Kind : std::uint8_t {
    new_boot,  // a piece begins, because the node has booted
    step,      // a piece began at `begin`: the counter stepped, or bounds contradict each other
    slip,      // a piece began at `begin`: the floors show a step too small to contradict the
               // certificate, or the interval is narrower than the shortest round trip
    uneasy,    // the floors show a step so small that the certificate is still right; the likeliest
               // stamps may be wrong by up to that step
    settled,   // a piece began: no further step came for one second after a single step, or for
               // five seconds after several; stamps in between were not certified
    host_backwards,  // a piece begins, because the host's clock went back
    withdrawn,       // stamps of frames that arrived from `begin` to `end` are no longer certified
    violator,        // a packet that contradicts the certificate was ignored
    relaxed,         // the new piece allows a greater curvature than was assumed
    route            // the packets now take another route
  };
  Kind kind{};
  BootKey boot = 0;  // boot of the node
  HostTime begin{}, end{};
  /// s; set for slip, uneasy and violator, and for step if the size is known.
  std::optional<double> by = std::nullopt;
  /// 1/s; set for relaxed: the curvature that is now allowed.
  std::optional<double> curvature = std::nullopt;

  bool operator==(const ClockEvent&) const = default;
};

}  // namespace kinalign
