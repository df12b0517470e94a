// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/stream_write.h"

#include "tests/folder.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

template <class Write>
std::string written(const Write& write) {
  const FreshFolder folder;
  PosixFiles files;
  auto out = TextOut::create(files, folder / "table.csv", Overwrite::no);
  REQUIRE(out);
  REQUIRE(write(*out));
  REQUIRE(out->commit());
  return folder.read("table.csv");
}

}  // namespace

TEST_CASE("points stand in the layout kinect: stamp, then x, y, z and state of each joint") {
  PointStream stream{{"Head", "Neck"}, {}};
  stream.frames.stamps = {utc_time(5), utc_time(1'700'000'000'000'000'001)};
  stream.frames.positions = {0, 0, 0, 1, -0.25, 2.5, 0.1234567, 0, 0, 1e-9, 0, 0};
  stream.frames.state = {Tracking::missing, Tracking::tracked, Tracking::inferred,
                         Tracking::tracked};
  CHECK(written([&](TextOut& out) { return write_points(stream, out); }) ==
        "time_ns,Head_x,Head_y,Head_z,Head_state,Neck_x,Neck_y,Neck_z,Neck_state\n"
        "5,0.000000,0.000000,0.000000,0,1.000000,-0.250000,2.500000,2\n"
        "1700000000000000001,0.123457,0.000000,0.000000,1,0.000000,0.000000,0.000000,2\n");
}

TEST_CASE("a node stands in the layout imu, without what it did not measure or did not get") {
  ImuStream stream{{"waist"}, {.acceleration = true, .angular_velocity = true}, {}};
  stream.samples.stamps = {utc_time(-1), utc_time(2)};
  stream.samples.acceleration = {1, 2, 3, 0, 0, 0};
  stream.samples.angular_velocity = {4, 5, 6.5, 0, 0, 0};
  stream.samples.valid = {1, 0};
  CHECK(written([&](TextOut& out) { return write_node(stream, out); }) ==
        "time_ns,ax,ay,az,gx,gy,gz\n"
        "-1,1.000000,2.000000,3.000000,4.000000,5.000000,6.500000\n");
}
