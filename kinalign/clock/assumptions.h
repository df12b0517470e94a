// SPDX-License-Identifier: Apache-2.0
// The assumptions under which a stamp is certified. While H1 to H5 hold, the true time lies in the
// interval of the stamp:
//   H1  no delay is negative: the host stamps early on sending and late on receiving, on one
//       continuous clock that is never stepped or slewed (CLOCK_MONOTONIC_RAW);
//   H2  the rate of the node's clock differs from the host's by at most `rate`;
//   H3  this difference changes by at most `curvature` per second;
//   H4  within one boot id the node's counter is continuous: no step, no time lost in sleep;
//   H5  the datagrams were sent by the node itself.
#pragma once

#include <string>

namespace kinalign {

/// The rate error of any node's crystal is at most this.
inline constexpr double greatest_rate = 100e-6;

struct Assumptions {
  double rate = greatest_rate;
  /// Per second. The value is an estimate: three times the change of a crystal of 0.3 ppm per
  /// degree on a board that warms by 12 degrees in four minutes.
  double curvature = 5e-8;

  bool operator==(const Assumptions&) const = default;
};

/// The curvature assumed after bounds contradict each other, per second. It is twice the fastest
/// change of rate in the tests.
inline constexpr double most_curvature = 2e-6;

/// Returns text such as "H1-H5 rate<=100ppm curvature<=0.05ppm/s", which is part of every
/// certificate.
std::string to_string(const Assumptions& assumptions);

}  // namespace kinalign
