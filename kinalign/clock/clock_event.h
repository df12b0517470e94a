// SPDX-License-Identifier: Apache-2.0
// Events of a node's clock: a boot, a step, or stamps that lose their certificate.
#pragma once

#include "kinalign/clock/exchange.h"

#include <cstdint>
#include <optional>

namespace kinalign {

struct ClockEvent {
  enum class Kind : std::uint8_t {
    new_boot,  // a piece begins, because the node has booted
    step,      // a piece began at `begin`: the counter stepped, or exchanges contradict each other
    slip,      // a piece began at `begin`: the floors moved against each other, by a step too small
               // for the certificate; or the floors leave less room than packets take
    uneasy,    // the same, by so little that the certificate still holds; likeliest stamps may be
               // wrong by up to that amount
    settled,   // a piece began: one second after a single step, or five seconds after several,
               // without another step; stamps in between were not certified
    host_backwards,  // a piece begins, because the host's clock went back
    withdrawn,       // stamps of frames that arrived from `begin` to `end` lost their certificate
    violator,        // a crossing that contradicts the certificate was left out
    relaxed,         // the piece that began allows for a greater curvature than was assumed
    route            // the packets took another route
  };
  Kind kind{};
  BootKey boot = 0;  // the node's
  HostTime begin{}, end{};
  /// s; for slip, uneasy and violator, and for step if it is known.
  std::optional<double> by = std::nullopt;
  /// 1/s; for relaxed: the curvature that is now allowed.
  std::optional<double> curvature = std::nullopt;

  bool operator==(const ClockEvent&) const = default;
};

}  // namespace kinalign
