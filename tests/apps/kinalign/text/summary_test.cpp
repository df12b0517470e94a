// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/summary.h"

#include "apps/cli/console.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

StreamReport stream(const std::string& name, std::vector<std::string> nodes,
                    std::uint64_t bridged) {
  StreamReport s;
  s.stream = name;
  s.nodes = std::move(nodes);
  s.samples = 1000;
  s.bridged = bridged;
  return s;
}

AlignmentReport report() {
  AlignmentReport report;
  report.frames = 3601;
  report.begin = utc_time(5);
  report.end = utc_time(60'000'000'005);
  report.rate_hz = 60.0;
  report.reference = "mocap";
  report.streams = {stream("mocap", {}, 0), stream("kinect", {}, 0), stream("imu", {"waist"}, 20),
                    stream("imu", {"wrist, left"}, 40)};
  report.streams[1].worst_interval_ns = 0;
  report.streams[1].gaps = 1;
  report.streams[1].gap_time_ns = 300'000'000;
  report.streams[1].invalid = 5;
  report.streams[2].worst_interval_ns = 2'000'000;
  report.streams[3].worst_interval_ns = 3'600'000;
  return report;
}

std::string plain(const AlignmentReport& report, const std::string& out,
                  const std::string& color = "never") {
  PosixFiles files;
  const Surroundings surroundings{
      [](const std::string&) { return std::string(); }, "/", 1, 2, false, false, files};
  Common common;
  common.color = color;
  const Console console(surroundings, common, "align");
  return summary(report, out, console);
}

}  // namespace

TEST_CASE("the summary is a line on time and one per group with losses, the worst first") {
  CHECK(plain(report(), "take.h5") ==
        "take.h5: 1 min 00 s, 3,601 frames at 60 Hz, mocap + kinect + imu (2 nodes)\n"
        "  time   imu (2 nodes) ± 3.6 ms, worst node: wrist, left   kinect shared clock\n"
        "  gaps   imu 3.0 % interpolated over loss, worst node: wrist, left\n"
        "  gaps   kinect 1 gap (0.30 s, marked), 0.5 % invalid\n"
        "  see    kinalign info take.h5\n");
}

TEST_CASE("stamps that the device did not write are called counted, however sure their clock is") {
  CHECK(clock_text(std::nullopt, false) == "stamps of unknown accuracy");
  CHECK(clock_text(std::nullopt, true) == "counted stamps of unknown accuracy");
  CHECK(clock_text(0, false) == "shared clock");
  CHECK(clock_text(0, true) == "counted stamps, shared clock");
  CHECK(clock_text(3'600'000, true) == "counted stamps ± 3.6 ms");
  AlignmentReport some = report();
  some.streams[3].counted = true;  // one node's file of two
  CHECK(plain(some, "").find("imu (2 nodes) counted stamps ± 3.6 ms") != std::string::npos);
}

TEST_CASE("a group with one node of unknown clock is of unknown accuracy, and that node is named") {
  AlignmentReport some = report();
  some.streams[2].worst_interval_ns.reset();
  const std::string text = plain(some, "");
  CHECK(text.starts_with("nothing written: "));
  CHECK(text.find("imu (2 nodes) stamps of unknown accuracy, worst node: waist ") !=
        std::string::npos);
}

TEST_CASE("five findings are shown, the word in colour where there is colour") {
  AlignmentReport some = report();
  some.findings.assign(7, {Severity::warning, {"a.csv", 3, "x", "y"}, "z", "do w"});
  const std::string text = plain(some, "t.h5", "always");
  CHECK(text.find("  \x1b[33mwarning\x1b[0m  a.csv:3: expected x, found y: z; do w\n") !=
        std::string::npos);
  CHECK(text.find("  and 2 more\n") != std::string::npos);
}

TEST_CASE("a share that one digit does not show is not shown as zero") {
  CHECK(share_text(1, 100'000) == "< 0.1 %");
  CHECK(share_text(0, 100'000).empty());
  CHECK(share_text(25, 1000) == "2.5 %");
}
