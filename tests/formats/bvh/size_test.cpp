// SPDX-License-Identifier: Apache-2.0
// The unit and the up axis, which a BVH does not state.
#include "tests/folder.h"

#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/sources/open_recording.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

using namespace kinalign;

namespace {

/// A person in the file's unit whose hips are `hip` above the feet along `up` ("y" or "z"): 11
/// joints, the trunk has 0.7 of the hips' height.
std::string person(double hip, const std::string& up) {
  const auto offset = [&](double across, double along) {
    return up == "y" ? fmt::format("OFFSET {} {} 0\n", across, along)
                     : fmt::format("OFFSET {} 0 {}\n", across, along);
  };
  std::string text = "HIERARCHY\nROOT Hips\n{\n" + offset(3, 5) +
                     "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n";
  for (const std::string side : {"Left", "Right"}) {
    text += "JOINT " + side + "UpLeg\n{\n" + offset(side == "Left" ? 0.1 * hip : -0.1 * hip, 0);
    text += "JOINT " + side + "Leg\n{\n" + offset(0, -0.5 * hip);
    text += "JOINT " + side + "Foot\n{\n" + offset(0, -0.4 * hip);
    text += "End Site\n{\n" + offset(0, -0.1 * hip) + "}\n}\n}\n}\n";
  }
  for (const std::string joint : {"Spine", "Spine1", "Neck", "Head"}) {
    text += "JOINT " + joint + "\n{\n" + offset(0, 0.175 * hip);
  }
  return text + "}\n}\n}\n}\n}\nMOTION\nFrames: 1\nFrame Time: 0.01\n1 2 3 0 0 0\n";
}

Findings judged(const std::string& text, double metres_per_unit, bool z_up) {
  const auto file = read_bvh(text, "p.bvh", {metres_per_unit, z_up, Time{}});
  REQUIRE(file);
  return file->findings;
}

const std::string same_unit =
    "set --metres-per-unit (metres_per_unit in a manifest) if the file has another unit";

std::string other_unit(const std::string& metres, const std::string& name) {
  return "set --metres-per-unit " + metres + " (metres_per_unit = " + metres +
         " in a manifest) if the file is in " + name;
}

}  // namespace

TEST_CASE("hips that are not 0.6 to 1.3 m high are a finding that proposes the unit") {
  for (const double hip : {61.0, 90.0, 129.0}) CHECK(judged(person(hip, "y"), 0.01, false).empty());
  struct Case {
    double hip;  // in the file's unit
    double metres;
    std::string found, repair;
  };
  for (const auto& [hip, metres, found, repair] :
       {Case{59, 0.01, "0.59 m", same_unit}, Case{131, 0.01, "1.31 m", same_unit},
        Case{0.9, 0.01, "0.009 m", other_unit("1", "metres")},
        Case{900, 0.01, "9 m", other_unit("0.001", "millimetres")},
        Case{36, 0.01, "0.36 m", other_unit("0.0254", "inches")},
        Case{16, 0.01, "0.16 m", other_unit("0.056444", "CMU units of 5.64 cm")},
        Case{90, 1.0, "90 m", other_unit("0.01", "centimetres")}}) {
    CAPTURE(hip);
    const Findings findings = judged(person(hip, "y"), metres, false);
    REQUIRE(findings.size() == 1);
    CHECK(findings[0].severity == Severity::warning);
    CHECK(to_string(findings[0].what) ==
          "p.bvh: expected hips 0.6 to 1.3 m above the lowest joint of the rest pose, found " +
              found);
    CHECK(findings[0].repair == repair);
  }
}

TEST_CASE("a rest pose that lies is a finding that proposes the other axis, either way") {
  const Findings z_as_y = judged(person(90, "z"), 0.01, false);
  // And no unit: the unit is judged along the axis on which the person stands.
  REQUIRE(z_as_y.size() == 1);
  CHECK(
      to_string(z_as_y[0].what) ==
      "p.bvh: expected a rest pose that is upright along y, found a pose that is upright along z");
  CHECK(z_as_y[0].repair == "set --up z (up = \"z\" in a manifest) if the person stood");
  const Findings y_as_z = judged(person(90, "y"), 0.01, true);
  REQUIRE(y_as_z.size() == 1);
  CHECK(y_as_z[0].repair == "set --up y (up = \"y\" in a manifest) if the person stood");
  CHECK(judged(person(90, "z"), 0.01, true).empty());
  CHECK(judged(person(900, "z"), 0.01, false).size() == 2);
}

TEST_CASE("what is no whole person is not judged") {
  CHECK(judged("HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\nEnd Site\n{\n"
               "OFFSET 0 -9000 0\n}\n}\nMOTION\nFrames: 0\nFrame Time: 0.01\n",
               0.01, false)
            .empty());
}

namespace {

struct Opened {
  Skeleton skeleton;
  ClipFrames frames;
  StampSurvey survey;
  Findings findings;
};

/// A file of a person of 90 units, at (1, 2, 3) in its only frame of 10 ms, opened with `options`.
Opened opened(StreamOptions options, const std::string& up = "y") {
  const FreshFolder folder;
  options.name = "mocap";
  options.files = {{folder.write("p.bvh", person(90, up)), ""}};
  PosixFiles files;
  const auto streams = open_streams(files, {options});
  REQUIRE(streams);
  const auto& input = std::get<ClipInput>(streams->streams.front().data);
  auto pass = input.passes();
  REQUIRE(pass);
  Opened out{
      input.skeleton, {}, streams->streams.front().survey, streams->streams.front().findings};
  REQUIRE((*pass)(out.frames));
  return out;
}

}  // namespace

TEST_CASE("metres_per_unit scales offsets and channels, and what is judged") {
  const Opened centimetres = opened({});
  CHECK(centimetres.findings.empty());
  CHECK((centimetres.skeleton.rest_offsets[0] - Vec3(0.03, 0.05, 0)).norm() < 1e-12);
  StreamOptions inches;
  inches.metres_per_unit = 0.0254;
  const Opened larger = opened(inches);
  CHECK((larger.skeleton.rest_offsets[0] - 2.54 * Vec3(0.03, 0.05, 0)).norm() < 1e-12);
  CHECK((vec3(larger.frames.local_positions, 0) - 2.54 * Vec3(0.01, 0.02, 0.03)).norm() < 1e-12);
  CHECK(larger.findings.size() == 1);
}

TEST_CASE("up = z turns the world, and what is judged") {
  StreamOptions z_up;
  z_up.up = "z";
  const Opened turned = opened(z_up, "z");
  CHECK(turned.findings.empty());
  CHECK((turned.skeleton.rest_offsets[0] - Vec3(0.03, 0.05, 0)).norm() < 1e-12);
  CHECK((vec3(turned.frames.local_positions, 0) - Vec3(0.01, 0.03, -0.02)).norm() < 1e-12);
  CHECK(opened({}, "z").findings.size() == 1);
  CHECK(opened(z_up, "y").findings.size() == 1);
}

TEST_CASE("a click on record begins the frames, later by its latency") {
  StreamOptions clicked;
  clicked.start_ns = 1'000'000'000'000;
  CHECK(opened(clicked).survey.first == utc_time(1'000'000'000'000));
  clicked.click_latency_ms = 12.5;
  const Opened late = opened(clicked);
  CHECK(late.survey.first == utc_time(1'000'012'500'000));
  CHECK(late.frames.stamps.front() == utc_time(1'000'012'500'000));
  clicked.click_latency_ms = -1.0;
  CHECK(opened(clicked).survey.first == utc_time(999'999'000'000));
}

TEST_CASE("two clicks that are not as far apart as the frames say are a finding") {
  StreamOptions clicked;
  clicked.start_ns = 1'000'000'000'000;
  const auto findings_of = [&](std::int64_t after) {
    clicked.end_ns = *clicked.start_ns + after;
    return opened(clicked).findings;
  };
  CHECK(findings_of(10'000'000).empty());  // one frame of 10 ms
  CHECK(findings_of(29'000'000).empty());  // less than two steps off: within the error of a click
  CHECK(findings_of(-10'000'000).empty());
  const Findings late = findings_of(1'010'000'000);
  REQUIRE(late.size() == 1);
  CHECK(late[0].severity == Severity::warning);
  CHECK(late[0].what.expected == "1.010 s between the clicks");
  CHECK(late[0].what.found == "1 frames of 0.01 s, 0.010 s");
  CHECK(findings_of(-20'000'000).size() == 1);
  // The latency of both clicks, so the time between them stays the same.
  clicked.click_latency_ms = 500.0;
  CHECK(findings_of(10'000'000).empty());
}

TEST_CASE("where rest pose and first frame stand along different axes, the frame decides") {
  std::string text = person(90.0, "y");
  const std::string row = "1 2 3 0 0 0\n", turned = "1 2 3 0 90 0\n";  // about x: y becomes z
  text.replace(text.find(row), row.size(), turned);
  CHECK(judged(text, 0.01, true).empty());
  const Findings findings = judged(text, 0.01, false);
  REQUIRE(findings.size() == 1);
  CHECK(to_string(findings[0].what) ==
        "p.bvh: expected a first frame that is upright along y, like the rest pose, found a pose "
        "that is upright along z");
  CHECK(findings[0].meaning == "the person appears to lie");
  CHECK(findings[0].repair == "set --up z (up = \"z\" in a manifest) if the person stood");
}

TEST_CASE("a survey judges a BVH as reading does, also by a frame without a line end") {
  const FreshFolder folder;
  PosixFiles files;
  std::string text = person(90.0, "y");
  text.replace(text.find("1 2 3 0 0 0\n"), 12, "1 2 3 0 90 0");
  StreamOptions options;
  options.name = "mocap";
  options.files = {{folder.write("p.bvh", text), ""}};
  const auto streams = open_streams(files, {options});
  REQUIRE(streams);
  const Findings& findings = streams->streams.front().findings;
  REQUIRE(!findings.empty());
  CHECK(findings.back().what.found == "a pose that is upright along z");
}
