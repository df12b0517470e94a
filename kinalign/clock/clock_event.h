// SPDX-License-Identifier: Apache-2.0
// Events of a node's clock: a boot, a step, stamps that are no longer certified.
#pragma once

#include "kinalign/clock/exchange.h"

#include <cstdint>
#include <optional>

namespace kinalign {

struct ClockEvent {
  enum class Kind : std::uint8_t {
    new_boot,  // a piece begins with a life of the node
    step,      // a piece began, at `begin`: the counter stepped, or exchanges contradict each other
    slip,      // a piece began, at `begin`: the floors moved against each other, by a step too
               // small for the certificate, or left less between them than packets take
    uneasy,    // likewise, by so little that the certificate holds all the same; likeliest
               // stamps may be off by up to that
    settled,  // a piece began: a second without another step since one, or five since several; what
              // came meanwhile was not certified
    host_backwards,  // a piece begins: the host's clock went back
    withdrawn,       // stamps of frames that arrived from begin to end: certified, and are not
    violator,        // a crossing that can't be was left out
    relaxed,         // the piece that began allows for a clock that bends more than was assumed
    route            // the packets took another route
  };
  Kind kind{};
  BootKey boot = 0;
  HostTime begin{}, end{};
  /// s; of slip, uneasy, violator, and of step where it is known.
  std::optional<double> by = std::nullopt;
  /// 1/s; of relaxed: what is allowed for now.
  std::optional<double> curvature = std::nullopt;

  bool operator==(const ClockEvent&) const = default;
};

}  // namespace kinalign
