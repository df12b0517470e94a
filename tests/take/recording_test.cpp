// SPDX-License-Identifier: Apache-2.0
#include "kinalign/take/recording.h"

#include "tests/take/recorded.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

std::vector<Time> three_stamps() { return {utc_time(10), utc_time(20), utc_time(15)}; }

template <class Frames>
std::size_t rows_of_pass(const Passes<Frames>& passes) {
  auto pass = passes();
  REQUIRE(pass);
  std::size_t rows = 0;
  Frames block;
  for (;;) {
    const auto more = (*pass)(block);
    REQUIRE(more);
    if (!*more) return rows;
    CHECK(block.size() > 0);
    rows += block.size();
  }
}

}  // namespace

TEST_CASE("a stream in memory is surveyed and can be passed over again and again") {
  PointStream points;
  points.joint_names = {"Head"};
  points.frames.stamps = three_stamps();
  points.frames.positions = {0, 1, 2, 3, 4, 5, 6, 7, 8};
  points.frames.state.assign(3, Tracking::tracked);
  const RecordedStream stream = recorded("kinect", points);
  CHECK(stream.name == "kinect");
  CHECK(stream.survey.samples == 3);
  CHECK(stream.survey.backward == 1);
  const auto& input = std::get<PointInput>(stream.data);
  CHECK(input.joint_names == points.joint_names);
  CHECK(rows_of_pass(input.passes) == 3);
  CHECK(rows_of_pass(input.passes) == 3);
}

TEST_CASE("two passes do not disturb each other") {
  Clip clip;
  clip.frames.stamps = three_stamps();
  const RecordedStream stream = recorded("mocap", clip);
  const auto& passes = std::get<ClipInput>(stream.data).passes;
  auto first = passes(), second = passes();
  ClipFrames block;
  CHECK((*first)(block) == true);
  CHECK((*second)(block) == true);
  CHECK(block.size() == 3);
  CHECK((*first)(block) == false);
  CHECK((*second)(block) == false);
}

TEST_CASE("an empty stream has no block") {
  const RecordedStream stream = recorded("imu", ImuStream{});
  CHECK(rows_of_pass(std::get<ImuInput>(stream.data).passes) == 0);
  CHECK(stream.survey.kept() == 0);
}

TEST_CASE("an inertial stream keeps what it carries") {
  ImuStream imu;
  imu.node_names = {"waist"};
  imu.content.acceleration = true;
  imu.samples.stamps = three_stamps();
  const RecordedStream stream = recorded("imu", imu);
  const auto& input = std::get<ImuInput>(stream.data);
  CHECK(input.node_names == imu.node_names);
  CHECK(input.content == imu.content);
  CHECK(rows_of_pass(input.passes) == 3);
}
