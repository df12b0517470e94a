// SPDX-License-Identifier: Apache-2.0
// One reading of a node's sensors, in SI units. Layout: docs/formats/imu_node.md.
#pragma once

#include "kinalign/wire/bytes.h"

#include <array>

namespace kinalign {

struct NodeSample {
  /// The age of the sample, us: the counter at sending (n_tx) minus the counter at the sample.
  std::uint32_t age_us = 0;
  bool has_acceleration = false;
  bool has_angular_velocity = false;
  bool has_orientation = false;
  bool gravity_included = false;            // true if the acceleration contains gravity
  std::array<float, 3> acceleration{};      // m/s2, in the node's own space
  std::array<float, 3> angular_velocity{};  // rad/s, in the node's own space
  std::array<float, 4> orientation{};       // w,x,y,z, world_from_sensor

  bool operator==(const NodeSample&) const = default;
};

/// Faults of a sample that is complete and has a valid stamp. A receiver marks such a sample and
/// passes on its numbers unchanged.
struct SampleFaults {
  bool not_finite = false;        // a value that is present is NaN or infinite
  bool zero_orientation = false;  // four zeros, which are not a rotation
};
SampleFaults faults(const NodeSample& sample);

inline constexpr std::size_t max_sample_size = 4 + 1 + 4 * (3 + 3 + 4);
std::size_t encoded_size(const NodeSample& sample);
void put_sample(ByteWriter& writer, const NodeSample& sample);

/// Reads a sample. Returns false if this version does not know all of its flags.
[[nodiscard]] bool take_sample(ByteReader& reader, NodeSample& sample);

}  // namespace kinalign
