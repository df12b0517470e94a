// SPDX-License-Identifier: Apache-2.0
#include "kinalign/documents/manifest_toml.h"

#include <doctest/doctest.h>

#include <string>

using namespace kinalign;

namespace {

std::string error_of(const std::string& toml) {
  const auto manifest = read_manifest(toml, "recording.toml");
  return manifest ? "none" : to_string(manifest.error());
}

const std::string mocap = "[stream.mocap]\nfile = \"walk.bvh\"\n";

}  // namespace

TEST_CASE("a manifest says who, what, which files, which clocks, which space") {
  const auto manifest = read_manifest(R"(
subject = "03"
action = "S1A02"
[align]
gap_ms = 100
reference = "mocap"
double = true
[stream.mocap]
file = "walk.bvh"
start_ns = 1700000000000000001
[stream.kinect]
file = "kinect.csv"
clock = "shared"
select = { "Skeleton#" = "0" }
[stream.imu]
root_node = "waist"
files = { wrist_left = "wl.csv", waist = "w.csv" }
interval_ms = 3.5
[stream.imu.mounting]
waist = [0.5, -0.5, 0.5, 0.5]
[space.kinect]
method = "given"
joints = { SpineBase = "Hips" }
rotation = [1, 0, 0, 0]
translation = [0, 0.5, -2]
)",
                                      "recording.toml");
  REQUIRE_MESSAGE(manifest, (manifest ? "" : to_string(manifest.error())));
  CHECK(manifest->subject == "03");
  CHECK(manifest->action == "S1A02");
  CHECK(manifest->align.gap_ms == 100.0);
  CHECK(manifest->align.store_double);
  REQUIRE(manifest->streams.size() == 3);
  CHECK(manifest->streams[0].name == "mocap");  // the file's order, not the alphabet's
  CHECK(manifest->streams[0].start_ns == 1700000000000000001);
  CHECK(manifest->streams[1].name == "kinect");
  CHECK(manifest->streams[1].clock == "shared");
  CHECK(manifest->streams[1].select.at("Skeleton#") == "0");
  const StreamOptions& imu = manifest->streams[2];
  CHECK(imu.root_node == "waist");
  CHECK(imu.interval_ms == 3.5);
  REQUIRE(imu.mounting.size() == 1);
  CHECK(imu.mounting.at("waist") == std::vector<double>{0.5, -0.5, 0.5, 0.5});
  REQUIRE(imu.files.size() == 2);
  CHECK(imu.files[0].node == "wrist_left");
  CHECK(imu.files[1].path == "w.csv");
  const SpaceOptions& space = manifest->spaces.at("kinect");
  CHECK(space.method == "given");
  CHECK(space.joints.at("SpineBase") == "Hips");
  CHECK(space.rotation == std::vector<double>{1, 0, 0, 0});
  CHECK(space.translation == std::vector<double>{0, 0.5, -2});
}

TEST_CASE("a lab.toml in a manifest's place is told as what it is") {
  CHECK(error_of("[record]\npre_roll_s = 3\n\n[device.mocap]\nport = 7012\n") ==
        "recording.toml:4: expected a manifest, recording.toml, with [stream.NAME], found "
        "[device], of a lab.toml: kinalign record takes it as --config");
}

TEST_CASE("an unknown key is refused with its line and the nearest known one") {
  CHECK(error_of("subjekt = \"03\"\n") ==
        "recording.toml:1: expected a known key (nearest: subject), found \"subjekt\"");
  CHECK(error_of(mocap + "[align]\nreference = \"mocap\"\ngap_m = 3\n") ==
        "recording.toml:5: expected a key of [align] (nearest: gap_ms), found \"gap_m\"");
  CHECK(error_of("[stream.mocap]\nfiel = \"walk.bvh\"\n") ==
        "recording.toml:2: expected a key of [stream.mocap] (nearest: file), found \"fiel\"");
  CHECK(error_of(mocap + "[space.mocap]\njoint = {}\n") ==
        "recording.toml:4: expected a key of [space.mocap] (nearest: joints), found \"joint\"");
}

TEST_CASE("a wrong type or a value out of range is refused with its line") {
  CHECK(error_of("[align]\ngap_ms = -1\n") ==
        "recording.toml:2: expected gap_ms as a number from 0 to 86400000, found -1");
  CHECK(error_of("[align]\ngap_ms = nan\n") ==
        "recording.toml:2: expected gap_ms as a number from 0 to 86400000, found nan");
  CHECK(error_of("[align]\ngap_ms = \"3\"\n") ==
        "recording.toml:2: expected gap_ms as a number from 0 to 86400000, found \"3\"");
  CHECK(error_of("[align]\nrotations = \"linear\"\n") ==
        "recording.toml:2: expected rotations as one of spline, slerp, found \"linear\"");
  CHECK(error_of("[align]\ndouble = 1\n") ==
        "recording.toml:2: expected double as true or false, found 1");
  CHECK(error_of("subject = 3\n") == "recording.toml:1: expected subject as a text, found 3");
  CHECK(error_of("stream = 3\n") == "recording.toml:1: expected stream as a table, found 3");
  CHECK(error_of(mocap + "start_ns = 1.5\n") ==
        "recording.toml:3: expected start_ns as a whole number from -4e+18 to 4e+18, found 1.5");
  CHECK(error_of(mocap + "files = 3\n") ==
        "recording.toml:3: expected files as a list of files or a table of nodes' files, found 3");
  CHECK(
      error_of(mocap + "start_ns = 2020-01-01\n") ==
      "recording.toml:3: expected start_ns as a whole number from -4e+18 to 4e+18, found a date or "
      "time");
  CHECK(error_of(mocap + "[space.mocap]\nrotation = [1, 0, 0]\n") ==
        "recording.toml:4: expected rotation as a list of 4 numbers, found 3 numbers");
  CHECK(error_of(mocap + "[space.mocap]\ntranslation = [1, 0, \"x\"]\n") ==
        "recording.toml:4: expected translation as a list of 3 numbers, found \"x\"");
}

TEST_CASE("a rotation that is none is refused with its line") {
  const std::string worn = mocap + "[stream.mocap.mounting]\n";
  CHECK(error_of(worn + "waist = [0.3, 0, 0, 0.3]\n") ==
        "recording.toml:4: expected waist as w,x,y,z of a length from 0.5 to 2, found a length of "
        "0.424264");
  CHECK(error_of(worn + "waist = [0, 0, 0, 90]\n") ==
        "recording.toml:4: expected waist as w,x,y,z of a length from 0.5 to 2, found a length of "
        "90");
  CHECK(error_of(worn + "waist = [1, 0, 0]\n") ==
        "recording.toml:4: expected waist as a list of 4 numbers, found 3 numbers");
  CHECK(error_of(worn + "waist = [1, 0, 0, nan]\n") ==
        "recording.toml:4: expected waist as a list of 4 numbers, found nan");
  CHECK(error_of(worn + "waist = \"x\"\n") ==
        "recording.toml:4: expected waist as a list of 4 numbers, found \"x\"");
  CHECK(error_of(mocap + "mounting = [1, 0, 0, 0]\n") ==
        "recording.toml:3: expected mounting as a table, found a list");
  CHECK(error_of(mocap + "[space.mocap]\nrotation = [0, 0, 0, 0]\n") ==
        "recording.toml:4: expected rotation as w,x,y,z of a length from 0.5 to 2, found a length "
        "of 0");
}

TEST_CASE("a stream that is spoken of must be there and have files") {
  CHECK(error_of(mocap + "[align]\nreference = \"mocab\"\n") ==
        "recording.toml:4: expected a stream of this file (nearest: mocap), found \"mocab\"");
  CHECK(error_of(mocap + "[space.kinect]\nmethod = \"fit\"\n") ==
        "recording.toml:3: expected a stream of this file (known: mocap), found \"kinect\"");
  CHECK(error_of(mocap + "[space.mocap]\nonto = \"x\"\n") ==
        "recording.toml:4: expected a stream of this file (known: mocap), found \"x\"");
  CHECK(error_of("[stream.mocap]\nrate_hz = 60\n") ==
        "recording.toml:1: expected file or files in [stream.mocap], found none");
}

TEST_CASE("what is no TOML is refused with its line") {
  CHECK(error_of("subject = \"03\"\naction = = 3\n")
            .starts_with("recording.toml:2: expected TOML, found a fault in it: "));
  // Found by fuzzing: toml++ 3.3.0 has an assertion there, which Debian's library is built without.
  CHECK(error_of("[&a]\n").starts_with("recording.toml:1: expected TOML"));
  CHECK(error_of(std::string(100'000, '[')).starts_with("recording.toml:1: expected TOML"));
  CHECK(error_of(std::string("a\0b", 3)).starts_with("recording.toml:1: expected TOML"));
}

TEST_CASE("a table whose name has blanks is told how it is quoted") {
  const std::string quoted = "TOML (a name with blanks stands in quotes: [stream.\"my suit\"])";
  CHECK(error_of(mocap + "[stream.my suit]\r\nfile = \"a.bvh\"\n")
            .starts_with("recording.toml:3: expected " + quoted + ", found a fault in it: "));
  CHECK(error_of("[my suit]\n").find(": [\"my suit\"])") != std::string::npos);
  for (const std::string other :
       {"[stream.my suit", "[stream.\"my\" suit]", "[]", "[ ]", "[a b.c]"}) {
    CHECK(error_of(other + "\n").starts_with("recording.toml:1: expected TOML, found "));
  }
}

TEST_CASE("an empty manifest is one without streams") {
  const auto manifest = read_manifest("", "recording.toml");
  REQUIRE(manifest);
  CHECK(manifest->streams.empty());
}

TEST_CASE("rows are selected by texts and by whole numbers") {
  const auto manifest =
      read_manifest(mocap + "select = { \"Skeleton#\" = 1, who = \"ann\" }\n", "recording.toml");
  REQUIRE(manifest);
  CHECK(manifest->streams[0].select ==
        std::map<std::string, std::string>{{"Skeleton#", "1"}, {"who", "ann"}});
  CHECK(error_of(mocap + "select = { who = 1.5 }\n") ==
        "recording.toml:3: expected who as a text, found 1.5");
}

TEST_CASE("only a shared clock leaves no doubt: an interval of nothing is refused") {
  CHECK(error_of(mocap + "interval_ms = 0\n") ==
        "recording.toml:3: expected interval_ms as a number from 1e-06 to 86400000, found 0");
  CHECK(error_of(mocap + "interval_ms = 0.000001\n") == "none");
}
