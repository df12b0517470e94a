// SPDX-License-Identifier: Apache-2.0
#include "firmware/node/lights.h"

namespace kinalign {

namespace {

constexpr std::uint16_t low_battery_mv = 3500;  // one lithium cell: a tenth of its charge is left

constexpr LedColour dark{}, red{20, 0, 0}, yellow{14, 10, 0}, green{0, 16, 0};

LedColour sync_colour(SyncLight sync) {
  if (sync == SyncLight::locked) return green;
  return sync == SyncLight::answered ? yellow : red;
}

LedColour battery_colour(BatteryLight battery) {
  if (battery == BatteryLight::unknown) return dark;
  return battery == BatteryLight::good ? green : red;
}

}  // namespace

BatteryLight battery_light(bool has_battery, std::uint16_t mv) {
  if (!has_battery) return BatteryLight::unknown;
  return mv < low_battery_mv ? BatteryLight::low : BatteryLight::good;
}

Picture picture(const Lights& lights) {
  const std::array<LedColour, matrix_side> rows{
      lights.link_up ? green : red, lights.link_up ? green : red, sync_colour(lights.sync),
      sync_colour(lights.sync), battery_colour(lights.battery)};
  Picture picture{};
  for (std::size_t i = 0; i < picture.size(); ++i) picture[i] = rows[i / matrix_side];
  return picture;
}

}  // namespace kinalign
