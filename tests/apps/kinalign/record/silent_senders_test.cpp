// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/silent_senders.h"

#include "tests/apps/kinalign/text/lab_scene.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

StreamStatus stranger(const StreamStatus& device, int number) {
  StreamStatus one = device;
  one.sender = "10.0.0.1:" + std::to_string(number);
  one.counts.messages = 1;
  return one;
}

}  // namespace

TEST_CASE("a sender that falls silent is reported once, and once when it is back") {
  Scene scene;  // the Kinect is silent
  SilentSenders senders;
  auto changes = senders.changes(scene.status);
  REQUIRE(changes.size() == 1);
  CHECK(changes[0].silent);
  CHECK(changes[0].stream.stream == "kinect");
  CHECK(senders.changes(scene.status).empty());
  scene.status.streams[1].last_arrival = scene.status.now;
  changes = senders.changes(scene.status);
  REQUIRE(changes.size() == 1);
  CHECK(!changes[0].silent);
  CHECK(senders.changes(scene.status).empty());
}

TEST_CASE("the silence of strangers at a device's port is not reported") {
  Scene scene;
  SilentSenders senders;
  for (int i = 0; i < 1000; ++i) {
    scene.status.streams.push_back(stranger(scene.status.streams[1], i));
  }
  CHECK(senders.changes(scene.status).size() == 1);  // the Kinect itself
}

TEST_CASE("a device that sent little before it fell silent is reported") {
  Scene scene;
  SilentSenders senders;
  senders.changes(scene.status);
  scene.status.streams[0].counts.messages = 3;
  scene.status.streams[0].last_arrival = scene.status.now - 3s;
  const auto changes = senders.changes(scene.status);
  REQUIRE(changes.size() == 1);
  CHECK(changes[0].stream.sender == "192.168.7.5:51234");
}
