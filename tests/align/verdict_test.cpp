// SPDX-License-Identifier: Apache-2.0
#include "kinalign/align/verdict.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

/// A mocap that is the reference, a Kinect and one node, all without fault.
AlignmentReport fine_report() {
  AlignmentReport report;
  report.reference = "mocap";
  for (const char* name : {"mocap", "kinect", "imu"}) {
    StreamReport stream;
    stream.stream = name;
    stream.samples = 1000;
    stream.worst_interval_ns = 0;
    report.streams.push_back(stream);
  }
  report.streams[2].nodes = {"waist"};
  return report;
}

const std::vector<InputFacts> kinect_files{{"kinect.csv", "", 0}};

Verdict kinect_of(const AlignmentReport& report) {
  return verdict_of(report, "kinect", kinect_files);
}

void add_finding(AlignmentReport& report, Severity severity, const Error& what) {
  report.findings.push_back({severity, what, "left out", ""});
}

}  // namespace

TEST_CASE("streams without a fault are good, and the reference says that it is one") {
  const AlignmentReport report = fine_report();
  CHECK(kinect_of(report).quality == Quality::good);
  CHECK(kinect_of(report).reason == "complete");
  CHECK(verdict_of(report, "mocap", {}).reason == "the reference, complete");
  CHECK(worst_of({kinect_of(report)}, 3).empty());
}

TEST_CASE("an error makes a stream bad, a warning usable, a note changes nothing") {
  for (const auto& [severity, quality] : {std::pair{Severity::error, Quality::bad},
                                          {Severity::warning, Quality::usable},
                                          {Severity::note, Quality::good}}) {
    AlignmentReport report = fine_report();
    add_finding(report, severity, {"kinect.csv", 7, "rising stamps", "3 that step back"});
    CHECK(kinect_of(report).quality == quality);
    if (severity == Severity::note) continue;
    CHECK(kinect_of(report).reason == "left out (expected rising stamps, found 3 that step back)");
  }
}

TEST_CASE("a finding counts for the streams of its file, or for the one that it names") {
  AlignmentReport report = fine_report();
  const std::vector<InputFacts> shared{{"take.mcap", "", 0}};
  add_finding(report, Severity::warning, {"take.mcap", 0, "rising stamps in 'imu'", "two"});
  CHECK(verdict_of(report, "kinect", shared).quality == Quality::good);
  CHECK(verdict_of(report, "imu", shared).quality == Quality::usable);
  add_finding(report, Severity::warning, {"take.mcap", 0, "a whole file", "a torn one"});
  CHECK(verdict_of(report, "kinect", shared).quality == Quality::usable);
  add_finding(report, Severity::error, {"other.csv", 0, "a", "b"});
  CHECK(verdict_of(report, "kinect", shared).quality == Quality::usable);
}

TEST_CASE("shares of samples count from their limits on") {
  AlignmentReport report = fine_report();
  report.streams[1].invalid = 50;  // 50 of 1000: at the limit
  CHECK(kinect_of(report).quality == Quality::good);
  CHECK(kinect_of(report).reason == "5.0 % of samples invalid");
  report.streams[1].invalid = 51;
  CHECK(kinect_of(report).quality == Quality::usable);
  report.streams[1].invalid = 501;
  CHECK(kinect_of(report).quality == Quality::bad);
  report.streams[1].invalid = 0;
  report.streams[1].inferred = 101;
  CHECK(kinect_of(report).reason == "10.1 % of samples inferred");
  CHECK(kinect_of(report).quality == Quality::usable);
}

TEST_CASE("stamps of unknown accuracy make a stream usable, the reference's do not") {
  AlignmentReport report = fine_report();
  for (StreamReport& stream : report.streams) stream.worst_interval_ns.reset();
  CHECK(kinect_of(report).quality == Quality::usable);
  CHECK(kinect_of(report).reason == "stamps of unknown accuracy");
  CHECK(verdict_of(report, "mocap", {}).quality == Quality::good);
  report.streams[1].worst_interval_ns = 10'000'001;
  CHECK(kinect_of(report).reason == "stamps certain to 10.0 ms");
  CHECK(kinect_of(report).quality == Quality::usable);
}

TEST_CASE("a residual of more than 10 cm makes a stream usable, of more than 30 bad") {
  AlignmentReport report = fine_report();
  SpaceReport space;
  space.stream = "kinect";
  space.onto = "mocap";
  space.joints = {{"WristLeft", "LeftHand", 10, 1.0, 0.2}};
  for (const auto& [after, quality] :
       {std::pair{0.1, Quality::good}, {0.11, Quality::usable}, {0.31, Quality::bad}}) {
    space.after_m = after;
    report.spaces = {space};
    CHECK(kinect_of(report).quality == quality);
    CHECK(verdict_of(report, "mocap", {}).quality == Quality::good);
  }
  CHECK(kinect_of(report).reason == "31.0 cm rms from mocap, worst joint WristLeft 20.0 cm");
}

TEST_CASE("the worst things come first, and one fault of several nodes counts once") {
  AlignmentReport report = fine_report();
  report.streams[2].bridged = 40;
  StreamReport other = report.streams[2];
  other.nodes = {"wrist_left"};
  other.bridged = 60;
  report.streams.push_back(other);
  report.streams[1].gaps = 2;
  report.streams[1].gap_time_ns = 6'000'000'000;
  const std::vector<Concern> worst = worst_of(
      {verdict_of(report, "mocap", {}), kinect_of(report), verdict_of(report, "imu", {})}, 3);
  REQUIRE(worst.size() == 2);
  CHECK(worst[0].stream == "kinect");
  CHECK(worst[0].what == "2 gaps, 6.00 s in all");
  CHECK(worst[0].quality == Quality::usable);
  CHECK(worst[1].part == "wrist_left");
  CHECK(worst[1].what == "6.0 % of samples interpolated over loss");
}

TEST_CASE("a concern that the report does not know changes the verdict") {
  Verdict verdict = kinect_of(fine_report());
  add_concern({"kinect", "", "it stood still", 2.0, Quality::usable}, verdict);
  CHECK(verdict.quality == Quality::usable);
  CHECK(verdict.reason == "it stood still");
}
