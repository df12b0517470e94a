// SPDX-License-Identifier: Apache-2.0
#include "firmware/node/lights.h"

#include <doctest/doctest.h>

#include <string>

using namespace kinalign;

namespace {

/// The picture with one letter for each LED.
std::string drawn(const Lights& lights) {
  std::string text;
  for (const LedColour& colour : picture(lights)) {
    const bool red = colour.red != 0, green = colour.green != 0;
    text += red && green ? 'y' : red ? 'r' : green ? 'g' : '.';
    if (text.size() % (matrix_side + 1) == matrix_side) text += '\n';
  }
  return text;
}

}  // namespace

TEST_CASE("two rows of link, two of sync, one of battery") {
  CHECK(drawn({}) == "rrrrr\nrrrrr\nrrrrr\nrrrrr\n.....\n");
  CHECK(drawn({true, SyncLight::answered, BatteryLight::low}) ==
        "ggggg\nggggg\nyyyyy\nyyyyy\nrrrrr\n");
  CHECK(drawn({true, SyncLight::locked, BatteryLight::good}) ==
        "ggggg\nggggg\nggggg\nggggg\nggggg\n");
}

TEST_CASE("no LED has more than 24 of 765: 25 bright ones would heat the case") {
  for (const auto sync : {SyncLight::unanswered, SyncLight::answered, SyncLight::locked}) {
    for (const LedColour& colour : picture({false, sync, BatteryLight::low})) {
      CHECK(colour.red + colour.green + colour.blue <= 24);
    }
  }
}

TEST_CASE("a battery is low below 3.5 V") {
  CHECK(battery_light(false, 0) == BatteryLight::unknown);
  CHECK(battery_light(true, 3499) == BatteryLight::low);
  CHECK(battery_light(true, 3500) == BatteryLight::good);
}
