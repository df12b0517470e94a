// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/silence_news.h"

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

TEST_CASE("who falls silent is told once, and once that it is back") {
  Scene scene;  // the Kinect is silent
  SilenceNews news;
  auto changes = news.changes(scene.status);
  REQUIRE(changes.size() == 1);
  CHECK(changes[0].silent);
  CHECK(changes[0].stream.stream == "kinect");
  CHECK(news.changes(scene.status).empty());
  scene.status.streams[1].heard = scene.status.now;
  changes = news.changes(scene.status);
  REQUIRE(changes.size() == 1);
  CHECK(!changes[0].silent);
  CHECK(news.changes(scene.status).empty());
}

TEST_CASE("the silence of strangers who found a device's port is not told") {
  Scene scene;
  SilenceNews news;
  for (int i = 0; i < 1000; ++i) {
    scene.status.streams.push_back(stranger(scene.status.streams[1], i));
  }
  CHECK(news.changes(scene.status).size() == 1);  // the news about the Kinect itself
}

TEST_CASE(
    "a device that said little before it fell silent is told, and one that spoke in an earlier "
    "take") {
  Scene scene;
  SilenceNews news;
  news.changes(scene.status);
  scene.status.streams[0].counts.messages = 3;  // 3 messages of the next take
  scene.status.streams[0].heard = scene.status.now - 3s;
  scene.status.streams[2] = stranger(scene.status.streams[0], 1);
  scene.status.streams[2].counts.messages = 4;  // another mocap device, as silent as the first
  const auto changes = news.changes(scene.status);
  REQUIRE(changes.size() == 2);
  CHECK(changes[0].stream.sender == "192.168.7.5:51234");
  CHECK(changes[1].stream.sender == "10.0.0.1:1");
}
