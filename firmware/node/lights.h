// SPDX-License-Identifier: Apache-2.0
// The state that a node's lights show, and its picture on a matrix of 5 x 5 LEDs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace kinalign {

enum class SyncLight : std::uint8_t {
  unanswered,  // no reply for 3 s
  answered,
  locked,  // the host has an interval for this node's clock
};

enum class BatteryLight : std::uint8_t { unknown, good, low };

struct Lights {
  bool link_up = false;
  SyncLight sync = SyncLight::unanswered;
  BatteryLight battery = BatteryLight::unknown;

  bool operator==(const Lights&) const = default;
};

BatteryLight battery_light(bool has_battery, std::uint16_t mv);

struct LedColour {
  std::uint8_t red = 0, green = 0, blue = 0;

  bool operator==(const LedColour&) const = default;
};

inline constexpr std::size_t matrix_side = 5;
using Picture = std::array<LedColour, matrix_side * matrix_side>;  // row by row from the top

/// The upper two rows are the link, the next two the sync, the last one the battery (dark where
/// unknown): red, yellow, green for bad, half, good. Dim: 25 LEDs at full brightness overheat.
Picture picture(const Lights& lights);

}  // namespace kinalign
