// SPDX-License-Identifier: Apache-2.0
// A whole report as JSON: other programs depend on exactly these names.
#include "kinalign/documents/report_json.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

AlignmentReport small_report() {
  AlignmentReport report;
  report.frames = 120;
  report.begin = utc_time(1'700'000'000'000'000'001);
  report.end = utc_time(1'700'000'001'983'333'334);
  report.rate_hz = 60.0;
  report.reference = "mocap";
  StreamReport imu;
  imu.stream = "imu";
  imu.nodes = {"waist"};
  imu.survey = {31, 1, 2, 3, 4'000'000, utc_time(5), utc_time(6), 66'666'667, 14, 16};
  imu.counted = true;
  imu.rate_hz = 15.0;
  imu.gap_ns = 206'666'668;
  imu.held_back = 15;
  imu.arrivals = {17, 18, 19, true};
  imu.gaps = 7;
  imu.gap_time_ns = 8;
  imu.samples = 120;
  imu.invalid = 9;
  imu.empty_rows = 19;
  imu.inferred = 10;
  imu.bridged = 11;
  imu.worst_nearest_ns = 12;
  imu.worst_interval_ns = 13;
  report.streams = {imu};
  SpaceReport space;
  space.stream = "kinect";
  space.onto = "mocap";
  space.method = "fit";
  space.transform.rotation = Quat(0.5, 0.5, -0.5, 0.5);
  space.transform.translation = Vec3(1.5, 0.0, -0.25);
  space.before_m = 2.5;
  space.after_m = 0.0625;
  space.joints = {{"Head", "Head\"s", 100, 2.0, 0.125}};
  report.spaces = {space};
  report.findings = {{Severity::error, {"k.csv", 3, "a", "b"}, "c", "d"}};
  return report;
}

const std::string whole = R"({
  "schema": "kinalign.report/1",
  "frames": 120,
  "begin_ns": 1700000000000000001,
  "end_ns": 1700000001983333334,
  "rate_hz": 60.0,
  "reference": "mocap",
  "streams": [
    {
      "stream": "imu",
      "nodes": [
        "waist"
      ],
      "stamps": {
        "samples": 31,
        "duplicates": 1,
        "backward": 2,
        "ahead": 3,
        "largest_step_back_ns": 4000000,
        "first_ns": 5,
        "last_ns": 6,
        "median_step_ns": 66666667,
        "long_steps": 14,
        "long_time_ns": 16
      },
      "stamps_counted": true,
      "rate_hz": 15.0,
      "gap_ns": 206666668,
      "held_back": 15,
      "near": 17,
      "late": 18,
      "worst_late_ns": 19,
      "gaps": 7,
      "gap_time_ns": 8,
      "samples": 120,
      "invalid": 9,
      "empty_rows": 19,
      "inferred": 10,
      "bridged": 11,
      "worst_nearest_ns": 12,
      "worst_interval_ns": 13
    }
  ],
  "spaces": [
    {
      "stream": "kinect",
      "onto": "mocap",
      "method": "fit",
      "rotation": [
        0.5,
        0.5,
        -0.5,
        0.5
      ],
      "translation_m": [
        1.5,
        0.0,
        -0.25
      ],
      "magnification": 1.0,
      "before_m": 2.5,
      "after_m": 0.0625,
      "joints": [
        {
          "joint": "Head",
          "onto": "Head\"s",
          "rows": 100,
          "before_m": 2.0,
          "after_m": 0.125
        }
      ]
    }
  ],
  "findings": [
    {
      "severity": "error",
      "file": "k.csv",
      "line": 3,
      "expected": "a",
      "found": "b",
      "meaning": "c",
      "repair": "d"
    }
  ]
}
)";

}  // namespace

TEST_CASE("a report is JSON of its schema, every figure under its unit") {
  CHECK(report_json(small_report()) == whole);
}

TEST_CASE("what is not known is absent, not zero") {
  AlignmentReport report = small_report();
  report.streams[0].nodes.clear();
  report.streams[0].worst_interval_ns.reset();
  const std::string json = report_json(report);
  CHECK(json.find("\"nodes\"") == std::string::npos);
  CHECK(json.find("worst_interval_ns") == std::string::npos);
}

TEST_CASE("a report of nothing has empty lists") {
  const std::string json = report_json({});
  for (const char* list : {"\"streams\": []", "\"spaces\": []", "\"findings\": []"}) {
    CAPTURE(list);
    CHECK(json.find(list) != std::string::npos);
  }
  CHECK(findings_json({}) == "[]\n");
}

TEST_CASE("bytes that are no UTF-8 are shown as such: the report stays JSON") {
  const Findings findings{{Severity::note, {"k\xff.csv", 0, "a", "b"}, "", ""}};
  CHECK(findings_json(findings).find("\"file\": \"k\xef\xbf\xbd.csv\"") != std::string::npos);
}

TEST_CASE("a report reads back as it was written") {
  const std::string text = report_json(small_report());
  const auto report = parse_report_json(text, "take.h5");
  REQUIRE(report);
  CHECK(report_json(*report) == text);
}

TEST_CASE("what is not of its type in a report keeps its default, and no text is an error") {
  const auto report = parse_report_json(
      R"({"frames": -1, "rate_hz": "60", "begin_ns": 1e300, "streams": [7, {"stream": "a\u001b",
          "stamps": {"samples": 2, "duplicates": 3}, "samples": 1, "invalid": 9}],
          "spaces": [{"rotation": [0, 0, 0, 0], "joints": {}}], "findings": 3, "marks": [null]})",
      "take.h5");
  REQUIRE(report);
  CHECK(report->frames == 0);
  CHECK(report->rate_hz == 0.0);
  CHECK(to_ns(report->begin) == 0);
  REQUIRE(report->streams.size() == 2);
  CHECK(report->streams[1].stream == "a?");
  CHECK(report->streams[1].survey.kept() == 2);
  CHECK(report->streams[1].invalid == 1);
  REQUIRE(report->spaces.size() == 1);
  CHECK(report->spaces[0].transform.rotation.w() == 1.0);
  CHECK(report->findings.empty());
  const auto none = parse_report_json("not JSON", "take.h5");
  REQUIRE(!none);
  CHECK(to_string(none.error()) ==
        "take.h5: expected a report as JSON, found text that is not JSON");
}
