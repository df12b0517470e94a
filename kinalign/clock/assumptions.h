// SPDX-License-Identifier: Apache-2.0
// Assumptions on which a certified stamp rests. While H1 to H5 hold, the truth lies in its
// interval:
//   H1  no delay is negative: the host stamps early on sending and late on receiving, on one
//       continuous clock that nobody steps or slews (CLOCK_MONOTONIC_RAW);
//   H2  the node's clock is at most `rate` off the host's;
//   H3  that error changes by at most `curvature` per second;
//   H4  within one boot id the node's counter is continuous: no step, no loss of time in sleep;
//   H5  the datagrams are the node's own.
#pragma once

#include <string>

namespace kinalign {

/// No crystal of a node is further off.
inline constexpr double greatest_rate = 100e-6;

struct Assumptions {
  double rate = greatest_rate;
  /// Per second. An estimate: three times the change of a crystal of 0.3 ppm per degree on a board
  /// that warms by 12 degrees in four minutes.
  double curvature = 5e-8;

  bool operator==(const Assumptions&) const = default;
};

/// The curvature assumed after a contradiction, per second: twice the fastest ramp that is tested.
inline constexpr double most_curvature = 2e-6;

/// "H1-H5 rate<=100ppm curvature<=0.05ppm/s": part of every certificate.
std::string to_string(const Assumptions& assumptions);

}  // namespace kinalign
