// SPDX-License-Identifier: Apache-2.0
// The findings about a take: each with its full text, its meaning and its repair, and the figures
// from which on it appears.
#include "tests/align/findings.h"

#include "kinalign/align/judge.h"

#include <doctest/doctest.h>

using namespace kinalign;
using namespace kinalign::test;

namespace {

/// The findings about a take with this header, which is made of `streams` and lasts as long as
/// the first of them.
Findings judged(TakeHeader header, std::vector<RecordedStream> streams = {kinect()}) {
  AlignPlan plan;
  plan.begin = streams.front().survey.first;
  plan.end = streams.front().survey.last;
  plan.header = std::move(header);
  plan.header.frames = streams.front().survey.kept();
  Recording recording;
  recording.streams = std::move(streams);
  return judge_plan(recording, plan);
}

}  // namespace

TEST_CASE("a note says how to place points without a space; a stated method gets no note") {
  TakeHeader header;
  header.groups = {{"mocap", ClipGroup{}, false, false, {}, "take"},
                   {"kinect", PointGroup{}, true, false, {}, "kinect"},
                   {"imu", ImuGroup{}, true, false, {}, "imu"},
                   {"suit", ClipGroup{}, true, false, {}, "suit"}};
  const Findings found = judged(header);
  REQUIRE(found.size() == 2);
  CHECK(whole(found[1]) ==
        "note: expected 'suit' in the take's space, found a skeleton, but only points can be "
        "moved; its positions stay in its own space; ");
  CHECK(whole(found[0]) ==
        "note: expected a space for 'kinect', found no [space.kinect]; its positions stay in its "
        "own space; "
        "[space.kinect] method = \"fit\" (or \"none\", if this is intended)");
  header.parameters.spaces["kinect"].method = "none";
  CHECK(judged(header).size() == 1);
}

TEST_CASE("joints more than 30 cm rms from their counterparts are a warning with the distance") {
  SpaceReport space;
  space.stream = "kinect";
  space.onto = "mocap";
  space.after_m = 0.3;
  CHECK(judge_residual(space).empty());
  space.after_m = 0.301;
  CHECK(judge_residual(space).size() == 1);
  space.after_m = 0.4567;
  const Findings found = judge_residual(space);
  REQUIRE(found.size() == 1);
  CHECK(
      whole(found[0]) ==
      "warning: expected 'kinect' on 'mocap' to less than 30 cm rms, found 45.7 cm; the positions "
      "can't be trusted; check that both streams have the same motion, time, units and joints");
}

TEST_CASE("a fit by joints near one line is a warning with their names") {
  SpacePlan plan;
  plan.options.method = "fit";
  plan.off_line_m = 0.043;
  SpaceReport space;
  space.stream = "kinect";
  space.joints = {{"SpineBase", "Hips", 9, 0.1, 0.0}, {"Head", "Head", 9, 0.1, 0.0}};
  const Findings found = judge_fit(plan, space);
  REQUIRE(found.size() == 1);
  CHECK(whole(found[0]) ==
        "warning: expected joints that are at least 10 cm away from a line, to fit 'kinect', "
        "found 4.3 cm: SpineBase, Head; the rotation about this line is a guess, even if the "
        "residuals are small; also name joints of arms or legs: joints = { ... }");
  plan.off_line_m = 0.099;
  CHECK(judge_fit(plan, space).size() == 1);
  plan.off_line_m = 0.1;
  CHECK(judge_fit(plan, space).empty());
  plan.options.method = "given";
  plan.off_line_m = 0.0;
  CHECK(judge_fit(plan, space).empty());
}

TEST_CASE("one file for two nodes is a warning") {
  TakeHeader header;
  header.groups = {
      {"imu", ImuGroup{}, true, false, {{"w.csv", "aa", 1}, {"l.csv", "bb", 1}}, "imu"}};
  CHECK(judged(header).empty());
  header.groups[0].files.push_back({"w.csv", "aa", 1});
  header.groups.push_back(
      {"kinect", PointGroup{}, true, false, {{"p.txt", "cc", 1}, {"a.txt", "cc", 1}}, "take"});
  const Findings found = judged(header);
  REQUIRE(found.size() == 1);
  CHECK(whole(found[0]) ==
        "warning: w.csv: expected different files for the nodes of 'imu', found the same bytes as "
        "another file; "
        "two of its nodes have the same data; name the other node's own file");
}

TEST_CASE("one file with one selection for two streams is a warning, with another selection none") {
  TakeHeader header;
  header.groups = {{"left", PointGroup{}, false, false, {{"k.csv", "aa", 1}}, "take"},
                   {"right", PointGroup{}, true, false, {{"k.csv", "aa", 1}}, "take"}};
  header.parameters.streams.resize(2);
  header.parameters.streams[0].name = "left";
  header.parameters.streams[1].name = "right";
  header.parameters.streams[0].select = {{"Skeleton#", "0"}};
  CHECK(judged(header).empty());
  header.parameters.streams[1].select = header.parameters.streams[0].select;
  const Findings found = judged(header);
  REQUIRE(found.size() == 1);
  CHECK(whole(found[0]) ==
        "warning: k.csv: expected different samples in 'right' and 'left', found the same file and "
        "the same selection; both streams have the same data; name the file of the second stream, "
        "or select its rows");
}

TEST_CASE("streams that share less than half of the shortest one's time are a warning") {
  RecordedStream late = kinect();  // 32.967 s long, like the first stream
  late.name = "suit";
  late.survey.first = utc_time(16'000'000'000);
  late.survey.last = utc_time(48'967'000'000);
  AlignPlan plan;
  plan.begin = late.survey.first;
  plan.end = kinect().survey.last;
  plan.header.frames = 514;
  Recording recording;
  recording.streams = {kinect(), late};
  const Findings half = judge_plan(recording, plan);
  REQUIRE(half.size() == 1);
  CHECK(whole(half[0]) ==
        "note: expected all frames of 'kinect' within the common time of all streams, found 486 of "
        "1000 "
        "outside: 'suit' begins last, 'kinect' ends first; the frames outside are cut off; ");
  plan.header.frames = 900;
  CHECK(judge_plan(recording, plan).empty());  // a tenth is still accepted
  plan.header.frames = 899;
  CHECK(judge_plan(recording, plan).size() == 1);
  plan.header.frames = 514;
  plan.begin = recording.streams[1].survey.first = utc_time(17'000'000'000);
  recording.streams[1].survey.last = utc_time(49'967'000'000);
  const Findings less = judge_plan(recording, plan);
  REQUIRE(less.size() == 1);
  CHECK(whole(less[0]) ==
        "warning: expected a common time of most of 'kinect', 32.97 s, found 15.97 s in common: "
        "'suit' begins last, 'kinect' ends first; the rest is cut off; a fit over so little time "
        "looks good at any offset; check start_ns and offset_ms");
}

TEST_CASE("a stream that has nothing in most rows is a warning with its node") {
  StreamReport imu;
  imu.stream = "imu";
  imu.nodes = {"waist"};
  imu.empty_rows = 500;
  CHECK(judge_rows(imu, 1000).empty());
  imu.empty_rows = 501;
  const Findings found = judge_rows(imu, 1000);
  REQUIRE(found.size() == 1);
  CHECK(whole(found[0]) ==
        "warning: expected samples of 'imu waist' in most rows, found no sample in 50.1 % of the "
        "rows; "
        "the take contains little of this stream; check rate_hz and gap_ms of this device, and "
        "whether it sent during the whole take");
}
