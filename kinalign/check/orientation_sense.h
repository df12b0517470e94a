// SPDX-License-Identifier: Apache-2.0
// Checks whether the orientations of nodes fit their accelerations and angular velocities. A file
// does not state the order of a quaternion's parts, its direction, or the axis that is up, but its
// numbers show them.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/formats/reader.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// Sums over all samples of a stream, per node. Memory does not grow with the file. Blocks must be
/// added in the order of the stream, since turns are measured between consecutive samples.
class OrientationSense {
 public:
  void add(const ImuSamples& block);
  /// Adds findings if gravity, turned into the world by the orientations, does not point up, or if
  /// the orientations turn about other axes than the gyroscope states.
  void judge(const ImuHeader& header, FileFindings& out) const;

 private:
  struct Last {
    std::int64_t t = 0;
    Quat q = Quat::Identity();
    Vec3 rate = Vec3::Zero();
  };
  struct Node {
    std::uint64_t samples = 0;
    Vec3 up = Vec3::Zero();    // sum of accelerations in the world, m/s2
    std::optional<Last> last;  // the last valid sample
    std::uint64_t turns = 0;   // pairs of consecutive samples
    double both = 0.0;         // sum of (turn by the orientations) . (turn by the gyroscope), rad2
    double turned = 0.0, measured = 0.0;  // sums of their squares
    double times = 0.0;                   // sum of the squared times between, s2
  };

  void add_turn(Node& node, const Last& now);

  std::vector<Node> nodes_;
};

}  // namespace kinalign
