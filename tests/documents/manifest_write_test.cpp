// SPDX-License-Identifier: Apache-2.0
#include "kinalign/documents/manifest_toml.h"

#include <doctest/doctest.h>

using namespace kinalign;

TEST_CASE("a manifest is written with what differs from the defaults alone") {
  Manifest manifest;
  manifest.subject = "03";
  manifest.align.reference = "mocap";
  StreamOptions mocap;
  mocap.name = "mocap";
  mocap.files = {{"walk.bvh", ""}};
  mocap.start_ns = 1'700'000'000'000'000'001;
  mocap.click_latency_ms = 53.5;
  StreamOptions imu;
  imu.name = "imu";
  imu.files = {{"w.csv", "waist"}, {"l.csv", "wrist left"}};
  imu.mounting["waist"] = {1, 0, 0, 0};
  manifest.streams = {mocap, imu};
  manifest.spaces["kinect"].method = "fit";
  manifest.spaces["kinect"].joints = {{"SpineBase", "Hips"}};
  CHECK(manifest_toml(manifest) == R"(subject = "03"

[align]
reference = "mocap"

[stream.mocap]
file = "walk.bvh"
start_ns = 1700000000000000001
click_latency_ms = 53.5

[stream.imu]
files = { waist = "w.csv", "wrist left" = "l.csv" }
mounting = { waist = [1.0, 0.0, 0.0, 0.0] }

[space.kinect]
method = "fit"
joints = { SpineBase = "Hips" }
)");
}

TEST_CASE("what is written is read again, odd names, the order of streams and all") {
  Manifest manifest;
  manifest.subject = "a \"b\"\\\n\xc3\xa4";
  manifest.align = {"z", 12.25, "slerp", true};
  for (const char* name : {"z", "a b", "m"}) {
    StreamOptions stream;
    stream.name = name;
    stream.files = {{std::string(name) + "/1.csv", ""}, {"2.csv", ""}};
    stream.select = {{"Skeleton#", "0"}};
    stream.clock = "shared";
    stream.drift_ppm = -1e-3;
    manifest.streams.push_back(stream);
  }
  SpaceOptions space;
  space.method = "given";
  space.rotation = {0.5, 0.5, 0.5, 0.5};
  space.translation = {1e-9, -2, 3};
  manifest.spaces["a b"] = space;
  const auto read = read_manifest(manifest_toml(manifest), "again.toml");
  REQUIRE_MESSAGE(read, (read ? "" : to_string(read.error())));
  CHECK(read->subject == manifest.subject);
  CHECK(read->align.rotations == "slerp");
  CHECK(read->align.store_double);
  REQUIRE(read->streams.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(read->streams[i].name == manifest.streams[i].name);
    CHECK(read->streams[i].files.at(0).path == manifest.streams[i].files[0].path);
    CHECK(read->streams[i].files.at(1).path == "2.csv");
    CHECK(read->streams[i].select == manifest.streams[i].select);
    CHECK(read->streams[i].clock == "shared");
    CHECK(read->streams[i].drift_ppm == -1e-3);
  }
  CHECK(read->spaces.at("a b").rotation == space.rotation);
  CHECK(read->spaces.at("a b").translation == space.translation);
  CHECK(manifest_toml(*read) == manifest_toml(manifest));
}
