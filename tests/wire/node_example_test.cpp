// SPDX-License-Identifier: Apache-2.0
// The example of docs/formats/imu_node_example.md, read from the page: its bytes must be those that
// we send.
#include "tests/page_bytes.h"
#include "tests/wire/node_cases.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

constexpr const char* page = "imu_node_example.md";

}  // namespace

TEST_CASE("the page's frame is what we send") {
  NodeFrame frame;
  frame.origin = {7, 0x5eedf00d, 1000};
  frame.n_tx_us = 60'012'345;
  frame.has_battery = true;
  frame.battery_mv = 3912;
  frame.has_echo = true;
  frame.echo = {998, 0xc0ffee11, 60'001'234};
  frame.sample_count = 1;
  NodeSample& sample = frame.samples[0];
  sample.age_us = 1845;
  sample.has_acceleration = sample.has_angular_velocity = sample.gravity_included = true;
  sample.acceleration = {0.25F, 9.8125F, -0.5F};
  sample.angular_velocity = {0.5F, -0.25F, 0.125F};
  CHECK(encoded(frame, &counted_key) == bytes_of_page(page, "frame"));
}

TEST_CASE("the page's reply is what we send") {
  const NodeReply reply{{7, 0x5eedf00d, 1000}, true, 999, 0x1badcafe, 86'400'123'456'789};
  CHECK(encoded(reply, &counted_key) == bytes_of_page(page, "reply"));
}

TEST_CASE("the page's answer is what we send, and its confirm differs in type and CRC") {
  const ClocklessTimes times{0x1badcafe, 86'400'123'456'789, 86'400'123'556'789};
  const Bytes answer = bytes_of_page(page, "answer");
  CHECK(encoded(ClocklessAnswer{{7, 0x5eedf00d, 1000}, times}, nullptr) == answer);
  Bytes confirm = encoded(ClocklessConfirm{{7, 0x5eedf00d, 1000}, times}, nullptr);
  REQUIRE(confirm.size() == answer.size());
  confirm[5] = 4;
  std::copy(answer.end() - 4, answer.end(), confirm.end() - 4);
  CHECK(confirm == answer);
}
