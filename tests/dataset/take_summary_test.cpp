// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/take_summary.h"

#include "kinalign/documents/report_json.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

/// A take of a skeleton, a Kinect and two streams of nodes that share a group.
TakeHeader header() {
  TakeHeader out;
  out.subject = "03";
  out.action = "S2A03";
  out.frames = 600;
  ClipGroup clip;
  clip.skeleton = {{"Hips", "Spine"}, {-1, 0}, {Vec3::Zero(), Vec3::UnitY()}, {}};
  out.groups.push_back({"mocap", clip, false, false, {{"a.bvh", std::string(64, 'a'), 7}}});
  out.groups.push_back(
      {"kinect", PointGroup{{"Head"}}, true, true, {{"k.csv", std::string(64, 'b'), 8}}});
  out.groups.push_back({"imu",
                        ImuGroup{{"waist", "wrist"}, {true, true, true, true}, ""},
                        true,
                        true,
                        {{"w.csv", std::string(64, 'c'), 9}}});
  return out;
}

StreamReport report_of(const std::string& stream, std::uint64_t samples, std::uint64_t invalid) {
  StreamReport out;
  out.stream = stream;
  out.samples = samples;
  out.invalid = invalid;
  return out;
}

AlignmentReport report() {
  AlignmentReport out;
  out.frames = 600;
  out.rate_hz = 60.0;
  out.begin = utc_time(1'000);
  out.end = utc_time(2'000);
  out.reference = "mocap";
  out.streams = {report_of("mocap", 0, 0), report_of("kinect", 600, 60), report_of("imu", 600, 0),
                 report_of("imu", 600, 300)};
  out.streams[1].inferred = 30;
  out.streams[1].gaps = 2;
  out.streams[1].gap_time_ns = 1'500'000'000;
  out.streams[2].worst_interval_ns = 3'000'000;
  out.streams[3].worst_interval_ns = 5'000'000;
  SpaceReport space;
  space.stream = "kinect";
  space.after_m = 0.07;
  out.spaces = {space};
  return out;
}

TakeSummary summary(const AlignmentReport& of) {
  const auto made = summary_of(header(), report_json(of));
  if (!made) FAIL(to_string(made.error()));
  return *made;
}

}  // namespace

TEST_CASE("a take's streams are counted by modality, the streams of nodes together") {
  const TakeSummary take = summary(report());
  REQUIRE(take.streams.size() == 3);
  CHECK(take.streams[0].modality == Modality::mocap);
  CHECK(take.streams[0].valid == 1.0);
  CHECK(take.streams[1].modality == Modality::kinect);
  CHECK(take.streams[1].valid == doctest::Approx(0.9));
  CHECK(take.streams[1].inferred == doctest::Approx(0.05));
  CHECK(take.streams[1].gaps == 2);
  CHECK(take.streams[1].gap_s == doctest::Approx(1.5));
  CHECK(take.streams[2].modality == Modality::imu);
  CHECK(take.streams[2].valid == doctest::Approx(0.75));
  CHECK(take.streams[2].interval_ns == 5'000'000);
  CHECK(take.streams[2].nodes == std::vector<std::string>{"waist", "wrist"});
  CHECK(take.residual_m == 0.07);
  CHECK(take.seconds() == doctest::Approx(10.0));
  CHECK(take.inputs.size() == 3);
}

TEST_CASE("points that are the reference are the mocap") {
  TakeHeader points = header();
  points.groups.erase(points.groups.begin());
  AlignmentReport of = report();
  of.reference = "kinect";
  const auto take = summary_of(points, report_json(of));
  REQUIRE(take);
  CHECK(take->streams[0].modality == Modality::mocap);
  CHECK_FALSE(take->has(Modality::kinect));
}

TEST_CASE("the verdict is that of the worst stream or finding, as on the take's page") {
  AlignmentReport of = report();
  of.streams = {report_of("mocap", 0, 0), report_of("kinect", 600, 0)};
  of.streams[1].worst_interval_ns = 1'000'000;
  const auto add = [&](Severity severity, const std::string& expected) {
    of.findings.insert(of.findings.begin(), {severity, Error{"f", 0, expected, "b"}, "", ""});
  };
  CHECK(summary(of).verdict() == "good");
  add(Severity::note, "a");
  CHECK(summary(of).verdict() == "good");
  CHECK(summary(of).worst.empty());
  of.streams[1].invalid = 120;
  CHECK(summary(of).verdict() == "usable");
  CHECK(summary(of).worst == "kinect: 20.0 % of samples invalid");
  add(Severity::warning, "rates");
  CHECK(summary(of).verdict() == "usable");
  add(Severity::error, "stamps");
  const TakeSummary bad = summary(of);
  CHECK(bad.verdict() == "bad");
  CHECK(bad.worst == "f: expected stamps, found b");
  CHECK(bad.errors == 1);
  CHECK(bad.warnings == 1);
}

TEST_CASE("a summary reads back as it was written, and says what is wrong with another text") {
  TakeSummary take = summary(report());
  take.sha256 = std::string(64, 'f');
  take.bytes = 123;
  take.software = "kinalign 9";
  const std::string json = summary_json(take);
  const auto again = parse_summary_json(json, "take.json");
  REQUIRE(again);
  CHECK(summary_json(*again) == json);
  for (const char* text : {"", "{}", "[1]", "{\"schema\": \"kinalign.take_summary/2\"}",
                           "{\"schema\": \"kinalign.take_summary/1\", \"frames\": -1}"}) {
    CAPTURE(text);
    const auto fault = parse_summary_json(text, "take.json");
    REQUIRE_FALSE(fault);
    CHECK(fault.error().file == "take.json");
  }
}

TEST_CASE("the recipe changes with every parameter, and not with where the files lie") {
  Manifest manifest;
  manifest.streams.resize(1);
  manifest.streams[0].name = "mocap";
  manifest.streams[0].files = {{"/a/x.bvh", ""}};
  Manifest moved = manifest;
  moved.streams[0].files = {{"/b/x.bvh", ""}};
  CHECK(recipe_of(moved) == recipe_of(manifest));
  Manifest other = manifest;
  other.streams[0].offset_ms = 1.0;
  CHECK(recipe_of(other) != recipe_of(manifest));
  other = manifest;
  other.subject = "04";
  CHECK(recipe_of(other) != recipe_of(manifest));
}

TEST_CASE("raw files that hold samples are known, wherever the manifest finds them") {
  for (const char* folder : {"", "../../raw/", "/raw/"}) {
    CAPTURE(folder);
    TakeHeader take = header();
    take.parameters.streams.resize(1);
    take.parameters.streams[0].name = "mocap";
    take.parameters.streams[0].files = {{std::string(folder) + "a.bvh", ""}};
    const auto made = summary_of(take, report_json(report()));
    REQUIRE(made);
    CHECK(made->sample_files == std::set<std::string>{"a.bvh"});
  }
}
