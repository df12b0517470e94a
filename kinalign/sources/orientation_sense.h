// SPDX-License-Identifier: Apache-2.0
// Whether nodes' orientations belong to what they felt: the order of a quaternion's parts, which
// way it turns, and which axis is up can't be read from a file, but they show in its numbers.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/formats/reader.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

class OrientationSense {
 public:
  void add(const ImuSamples& block);
  /// Findings where gravity, turned into the world by the orientations, does not point up, and
  /// where the orientations turn about other axes than the gyroscope says.
  Findings judge(const ImuHeader& header, const std::string& file) const;

 private:
  struct Last {
    std::int64_t t = 0;
    Quat q = Quat::Identity();
    Vec3 rate = Vec3::Zero();
  };
  struct Node {
    std::uint64_t samples = 0;
    Vec3 up = Vec3::Zero();           // accelerations in the world, their sum, m/s2
    std::optional<Last> last;         // valid sample
    std::uint64_t turns = 0;          // pairs of samples one behind the other
    double both = 0.0;                // (turn by the orientations) . (by the gyroscope), rad2
    double turned = 0.0, felt = 0.0;  // their squares
    double times = 0.0;               // the squares of the times between, s2
  };

  void add_turn(Node& node, const Last& now);

  std::vector<Node> nodes_;
};

}  // namespace kinalign
