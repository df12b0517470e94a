// SPDX-License-Identifier: Apache-2.0
#include "firmware/host_node/formula.h"

#include <cmath>
#include <numbers>

namespace kinalign {

NodeSample swing_at(std::uint64_t counter_us, bool with_orientation) {
  constexpr double pace = 2 * std::numbers::pi * 0.4, gravity = 9.80665;
  const double t = static_cast<double>(counter_us) * 1e-6;
  const double angle = std::sin(pace * t);
  const auto number = [](double value) { return static_cast<float>(value); };
  NodeSample sample;
  sample.has_acceleration = sample.has_angular_velocity = sample.gravity_included = true;
  sample.has_orientation = with_orientation;
  sample.acceleration = {0, number(gravity * std::cos(angle)), number(-gravity * std::sin(angle))};
  sample.angular_velocity = {number(pace * std::cos(pace * t)), 0, 0};
  sample.orientation = {number(std::cos(angle / 2)), number(std::sin(angle / 2)), 0, 0};
  if (!with_orientation) sample.orientation = {};
  return sample;
}

}  // namespace kinalign
