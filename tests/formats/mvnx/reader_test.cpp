// SPDX-License-Identifier: Apache-2.0
#include "tests/formats/mvnx/gzip.h"
#include "tests/formats/mvnx/mvnx_text.h"
#include "tests/formats/reading.h"

#include "kinalign/formats/mvnx/mvnx.h"
#include "kinalign/motion/kinematics.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

using namespace kinalign;

namespace {

Read<ClipReader> read_mvnx(std::string_view text, const StreamOptions& options = {}) {
  return read_all(make_mvnx_reader(options, "a.mvnx"), text);
}
Read<ImuReader> read_sensors(std::string_view text) {
  return read_all(make_mvnx_sensor_reader({}, "a.mvnx"), text);
}

const std::string two_frames =
    upright("time=\"0\" index=\"0\" ms=\"1542082631842\" type=\"normal\"", "0") +
    upright("time=\"10\" index=\"1\" ms=\"1542082631852\" type=\"normal\"", "0.5");

std::vector<std::string> texts_of(const Findings& findings) {
  std::vector<std::string> out;
  for (const Finding& finding : findings) out.push_back(text_of(finding));
  return out;
}

}  // namespace

TEST_CASE("segments become joints: y up, offsets by the joints' points, tips as end sites") {
  const auto read = read_mvnx(mvnx_of(two_frames));
  CHECK(read.error == "");
  CHECK(read.findings.empty());
  CHECK(read.header.joint_names == std::vector<std::string>{"Pelvis", "Leg"});
  CHECK(read.header.parents == std::vector<int>{-1, 0});
  CHECK((read.header.rest_offsets[1] - Vec3(0, -1, -0.1)).norm() < 1e-15);
  REQUIRE(read.header.end_sites.size() == 1);
  CHECK(read.header.end_sites[0].parent == 1);
  CHECK((read.header.end_sites[0].offset - Vec3(0.2, -0.4, 0)).norm() < 1e-15);
  CHECK(read.rows.stamps == std::vector<Time>{utc_time(1'542'082'631'842'000'000),
                                              utc_time(1'542'082'631'852'000'000)});
  CHECK(read.rows.local_positions ==
        std::vector<double>{0, 1, 0, 0, -1, -0.1, 0.5, 1, 0, 0, -1, -0.1});
  CHECK(read.rows.local_rotations ==
        std::vector<double>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
}

TEST_CASE("a segment that turns about the file's z turns about our y, its child with it") {
  // 90 degrees about z: x becomes y.
  const auto read = read_mvnx(
      mvnx_of(frame("index=\"0\" type=\"normal\"",
                    element("orientation", "0.70710678 0 0 0.70710678 0.70710678 0 0 0.70710678") +
                        element("position", "0 0 1 -0.1 0 0"))));
  CHECK(read.error == "");
  const Quat turn = quat(read.rows.local_rotations, 0);
  CHECK((turn * Vec3(1, 0, 0) - Vec3(0, 0, -1)).norm() < 1e-7);
  CHECK(quat(read.rows.local_rotations, 1).angularDistance(Quat::Identity()) < 1e-7);
  CHECK((Vec3(vec3(read.rows.local_positions, 1)) - Vec3(0, -1, -0.1)).norm() < 1e-7);
  std::vector<double> global(6);
  forward_kinematics(read.header, read.rows, global);
  CHECK((Vec3(vec3(global, 1)) - Vec3(-0.1, 0, 0)).norm() < 1e-7);
}

TEST_CASE("calibration poses are no frames; they are the rest pose of segments without points") {
  const std::string other = frame("type=\"tpose\"", element("orientation", "1 0 0 0 1 0 0 0") +
                                                        element("position", "0 0 3 0 0 2.5"));
  const std::string identity =
      frame("type=\"identity\"",
            element("orientation", "1 0 0 0 1 0 0 0") + element("position", "0 0 2 0 0.2 0.5"));
  const auto pelvis_and_leg = [&](const std::string& frames) {
    const auto read = read_mvnx(mvnx_of(frames + two_frames, "100", ""));
    CHECK(read.error == "");
    CHECK(read.rows.size() == 2);
    return std::vector<double>{read.header.rest_offsets[0].y(), read.header.rest_offsets[1].y()};
  };
  CHECK(pelvis_and_leg(identity + other) == std::vector<double>{2, -1.5});
  CHECK(pelvis_and_leg(other + identity) == std::vector<double>{2, -1.5});
  CHECK(pelvis_and_leg(other) == std::vector<double>{3, -0.5});
  CHECK(pelvis_and_leg("") == std::vector<double>{1, -1});
}

TEST_CASE("stamps come from index and rate, and begin at start_ns where that is given") {
  StreamOptions options;
  options.start_ns = 1000;
  options.rate_hz = 50.0;
  options.metres_per_unit = 2.0;
  options.up = "y";
  const auto read = read_mvnx(mvnx_of(upright("index=\"7\" type=\"normal\"", "1") +
                                      upright("index=\"10\" type=\"normal\"", "1")),
                              options);
  CHECK(read.error == "");
  CHECK(read.rows.stamps == std::vector<Time>{utc_time(1000), utc_time(60'001'000)});
  CHECK(texts_of(read.findings) ==
        std::vector<std::string>{"a.mvnx: expected every frame index, found 2 missing indices"});
  CHECK(std::vector<double>(read.rows.local_positions.begin(),
                            read.rows.local_positions.begin() + 3) == std::vector<double>{2, 0, 2});
  CHECK(read_mvnx(mvnx_of(two_frames, "none")).error ==
        "a.mvnx:9: expected a frameRate of 0.001 to 1,000,000 Hz, or rate_hz, found none");
}

TEST_CASE("frames that lack a segment or step back are left out, with a finding") {
  const std::string lacking =
      frame("index=\"2\" type=\"normal\"",
            element("orientation", "1 0 0 0 1 0 0 0") + element("position", "0 0 1"));
  const std::string zero =
      frame("index=\"3\" type=\"normal\"",
            element("orientation", "1 0 0 0 0 0 0 0") + element("position", "0 0 1 0 0 0"));
  const std::string no_number =
      frame("index=\"4\" type=\"normal\"",
            element("orientation", "1 0 0 0 1 0 0 nan") + element("position", "0 0 1 0 0 0"));
  const std::string back = upright("index=\"1\" type=\"normal\"", "9");
  const auto read = read_mvnx(mvnx_of(two_frames + lacking + zero + no_number + back));
  CHECK(read.rows.size() == 2);
  CHECK(texts_of(read.findings) ==
        std::vector<std::string>{
            "a.mvnx: expected orientation and position of all segments in "
            "each frame, found 3 frames without them",
            "a.mvnx: expected frames with a rising index, found 1 other frames"});
}

TEST_CASE("times that are not those of the frame rate are a finding") {
  const auto read = read_mvnx(mvnx_of(two_frames, "30"));
  CHECK(read.findings.empty());  // off by 23 ms, less than a frame and a half
  const auto later =
      read_mvnx(mvnx_of(two_frames + upright("time=\"90\" index=\"2\" type=\"normal\"", "0")));
  CHECK(texts_of(later.findings) ==
        std::vector<std::string>{
            "a.mvnx: expected times of frameRate 100, found times that differ by up to 0.07 s"});
}

TEST_CASE("a packed file is read as the plain one, and rows do not depend on the pieces") {
  const std::string text = mvnx_of(two_frames);
  const auto whole = read_mvnx(text);
  const std::string packed = gzip(text);
  CHECK(looks_like_mvnx(text));
  CHECK(looks_like_mvnx(packed));
  CHECK(!looks_like_mvnx("<html>"));
  CHECK(!looks_like_mvnx(gzip("HIERARCHY")));
  CHECK(!looks_like_mvnx("// <mvnx"));
  for (const std::string& bytes : {text, packed}) {
    for (std::size_t piece = 1; piece < bytes.size(); piece += 1 + piece / 7) {
      CAPTURE(piece);
      const auto cut = read_in_pieces(make_mvnx_reader({}, "a.mvnx"), bytes, piece);
      CHECK(cut.error == "");
      CHECK(cut.rows.stamps == whole.rows.stamps);
      CHECK(cut.rows.local_positions == whole.rows.local_positions);
      CHECK(cut.rows.local_rotations == whole.rows.local_rotations);
    }
  }
}

TEST_CASE("a file that was cut gives its whole frames, with a finding") {
  const std::string text = mvnx_of(two_frames);
  const auto cut = read_mvnx(text.substr(0, text.rfind("</frame>")));
  CHECK(cut.error == "");
  CHECK(cut.rows.size() == 1);
  CHECK(texts_of(cut.findings) ==
        std::vector<std::string>{"a.mvnx:16: expected well-formed XML, found no element found"});
  const std::string packed = gzip(text);
  const auto torn = read_mvnx(packed.substr(0, packed.size() - 4));
  CHECK(torn.rows.size() == 2);
  CHECK(
      texts_of(torn.findings) ==
      std::vector<std::string>{"a.mvnx: expected a whole gzip archive, found the end of the file"});
}

TEST_CASE("a fault in the last bytes of a file is an error, in whatever pieces they come") {
  const std::string text = mvnx_of(two_frames);
  const std::string faulty = text.substr(0, text.rfind("</frames>")) + "<frame a=\"1\"b\"2\"";
  for (std::size_t piece = 1; piece < 40; ++piece) {
    CAPTURE(piece);
    const auto read = read_in_pieces(make_mvnx_reader({}, "a.mvnx"), faulty, piece);
    CHECK(read.error ==
          "a.mvnx:17: expected well-formed XML, found not well-formed (invalid token)");
  }
}

TEST_CASE("what is no motion of segments is an error with its line") {
  CHECK(read_mvnx("").error == "a.mvnx:1: expected well-formed XML, found no element found");
  CHECK(read_mvnx("<html/>").error == "a.mvnx:1: expected the element mvnx, found html");
  CHECK(read_mvnx(mvnx_of("")).error ==
        "a.mvnx: expected a frame of type normal with all segments, found the end of the file "
        "after 0 incomplete frames");
  CHECK(read_mvnx(mvnx_of(two_frames, "100",
                          "<points><point label=\"x\"><pos_b>1 2</pos_b>"
                          "</point></points>"))
            .error == "a.mvnx:4: expected three numbers in pos_b, found 1 2");
  std::string looped = mvnx_of(two_frames);
  looped.replace(looped.find("Leg/jHip"), 8, "Leg/jXip");
  looped.replace(looped.find("Pelvis/jHip"), 11, "Leg/jHip/xx");
  CHECK(read_mvnx(looped).error ==
        "a.mvnx:9: expected each parent before its children, found joint 'Leg'");
  CHECK(read_mvnx(mvnx_of(upright("index=\"-1\" type=\"normal\"", "0"))).error ==
        "a.mvnx:9: expected a frame's index, found -1");
  CHECK(read_mvnx(gzip("<mvnx>").substr(0, 12) + std::string(30, 'x')).error ==
        "a.mvnx: expected a whole gzip archive, found damaged bytes");
}

TEST_CASE("a second subject is reported and not read") {
  std::string text = mvnx_of(two_frames);
  text.replace(text.find("</mvnx>"), 7,
               "<subject label=\"B\"><frames>" + two_frames + "</frames></subject></mvnx>");
  const auto read = read_mvnx(text);
  CHECK(read.error == "");
  CHECK(read.rows.size() == 2);
  CHECK(texts_of(read.findings) ==
        std::vector<std::string>{"a.mvnx: expected one subject, found 2"});
}

TEST_CASE("sensors become nodes: free acceleration is turned into the sensor's space") {
  // The second sensor is turned by 90 degrees about z: x of the space is its -y.
  const std::string sensors = element("sensorOrientation", "1 0 0 0 0.70710678 0 0 0.70710678") +
                              element("sensorFreeAcceleration", "1 2 3 1 0 0");
  const auto read = read_sensors(mvnx_of(frame("index=\"0\" type=\"normal\"", sensors) +
                                         frame("index=\"1\" type=\"normal\"", "")));
  CHECK(read.error == "");
  CHECK(read.header.node_names == std::vector<std::string>{"Pelvis", "Leg"});
  CHECK(read.header.content == ImuContent{true, true, false, false});
  CHECK(read.rows.valid == std::vector<std::uint8_t>{1, 1, 0, 0});
  CHECK((Vec3(vec3(read.rows.acceleration, 0)) - Vec3(1, 2, 3)).norm() < 1e-12);
  CHECK((Vec3(vec3(read.rows.acceleration, 1)) - Vec3(0, -1, 0)).norm() < 1e-7);
  CHECK((quat(read.rows.orientation, 0) * Vec3(0, 0, 1) - Vec3(0, 1, 0)).norm() < 1e-15);
  CHECK(texts_of(read.findings) ==
        std::vector<std::string>{"a.mvnx: expected the same sensor values in each frame as in the "
                                 "first frame, found 1 frames without them"});
}

TEST_CASE("accelerations with gravity and angular velocities of sensors are taken as they are") {
  const auto read = read_sensors(mvnx_of(
      frame("index=\"0\" type=\"normal\"", element("sensorAcceleration", "0 0 9.8 0 9.8 0") +
                                               element("sensorAngularVelocity", "1 2 3 4 5 6"))));
  CHECK(read.error == "");
  CHECK(read.header.content == ImuContent{false, true, true, true});
  CHECK(read.rows.acceleration == std::vector<double>{0, 0, 9.8, 0, 9.8, 0});
  CHECK(read.rows.angular_velocity == std::vector<double>{1, 2, 3, 4, 5, 6});
  CHECK(read_sensors(mvnx_of(two_frames)).error ==
        "a.mvnx:9: expected sensors with orientation, acceleration or angular velocity, found "
        "no such sensors in the first frame");
}
