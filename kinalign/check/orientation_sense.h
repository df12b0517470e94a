// SPDX-License-Identifier: Apache-2.0
// Checks whether the orientations of nodes agree with their accelerations and angular velocities. A
// file does not state the order of the quaternion's components, its direction, or the vertical
// axis. The values show whether these are right.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/formats/reader.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// Sums over all samples of a stream, for each node. Memory does not grow with the file. Add blocks
/// in the order of the stream, since rotations are measured between consecutive samples.
class OrientationSense {
 public:
  void add(const ImuSamples& block);
  /// Adds a finding if gravity does not point up after the orientations rotate it into the world.
  /// Also adds a finding if the orientations rotate about other axes than the gyroscope measures.
  void judge(const ImuHeader& header, FileFindings& out) const;

 private:
  struct Last {
    std::int64_t t = 0;
    Quat q = Quat::Identity();
    Vec3 rate = Vec3::Zero();
  };
  struct Node {
    std::uint64_t samples = 0;
    Vec3 up = Vec3::Zero();               // sum of accelerations in the world's axes, m/s2
    std::optional<Last> last;             // the newest valid sample
    std::uint64_t turns = 0;              // number of pairs of consecutive samples
    double both = 0.0;                    // sum of scalar products of the rotation vectors, rad2
    double turned = 0.0, measured = 0.0;  // sums of the squared rotation vectors, rad2
    double times = 0.0;                   // sum of the squared time steps, s2
  };

  void add_turn(Node& node, const Last& now);

  std::vector<Node> nodes_;
};

}  // namespace kinalign
