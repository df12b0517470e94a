// SPDX-License-Identifier: Apache-2.0
// The findings about streams: each with its full text, its meaning and its repair, and the figures
// from which on it appears.
#include "kinalign/align/judge.h"

#include "tests/align/findings.h"

#include "kinalign/resample/resample.h"

#include <doctest/doctest.h>

using namespace kinalign;
using namespace kinalign::test;

namespace {

/// The content of a sine of rms `rms`, of which `lost` is not carried by the grid.
CarriedContent carried(double rms, double lost) {
  CarriedContent out;
  out.samples = 100;
  out.squares = 100 * rms * rms;
  out.lost = 100 * lost * lost;
  return out;
}

}  // namespace

TEST_CASE("sound stamps are no finding") { CHECK(judge_stamps(kinect(), {}).empty()); }

TEST_CASE("stamps that repeat are a note, those that ran ahead or back a warning, in the file") {
  RecordedStream s = kinect();
  s.files = {{"k.csv", "", 0}, {"lab.toml", "", 0}};
  s.survey.duplicates = 3;
  s.survey.ahead = 2;
  s.survey.backward = 50;
  s.survey.largest_step_back_ns = 1'500'000'000;
  const Findings found = judge_stamps(s, {});
  REQUIRE(found.size() == 3);
  CHECK(whole(found[0]) ==
        "note: k.csv: expected stamps that rise, found 3 that repeat the one before; these samples "
        "were left out; ");
  CHECK(whole(found[1]) ==
        "warning: k.csv: expected stamps that go on from one another, found 2 far ahead of the "
        "ones around; these samples were left out; ");
  CHECK(whole(found[2]) ==
        "warning: k.csv: expected stamps that rise, found 50 of 1000 that step back, by up to "
        "1.500 s; these samples were left out; look at the device's clock if there are many");
}

TEST_CASE("samples held back are a warning that says what to do about it") {
  CHECK(judge_arrivals(kinect(), {}, Role::resampled).empty());
  CHECK(judge_arrivals(kinect(), {}, Role::reference).empty());
  const Findings found = judge_arrivals(kinect(), {3, 0, 0}, Role::resampled);
  REQUIRE(found.size() == 1);
  CHECK(whole(found[0]) ==
        "warning: kinect: expected samples a fifth of a step or more apart, found 3 with the next "
        "one nearer; held back on their way: they are left out where the stream is resampled; "
        "stamp samples where they are taken, not where they arrive");
  CHECK(judge_arrivals(kinect(), {3, 0, 0}, Role::reference).at(0).meaning ==
        "held back on their way: as the reference they keep the stamp of their arrival, at which "
        "the other streams are taken");
}

TEST_CASE("samples that came late behind a pause are a warning with how late they were") {
  const Findings found = judge_arrivals(kinect(), {0, 12, 414'000'000}, Role::resampled);
  REQUIRE(found.size() == 1);
  CHECK(whole(found[0]) ==
        "warning: kinect: expected samples that come as they are taken, found 12 that came quicker "
        "behind a pause, 0.41 s late and more; where they are used, the take is so far behind "
        "the motion; use the device's own stamps where the file has them, or leave the time column "
        "out of its layout and say rate_hz");
}

TEST_CASE("a start_ns at a first sample that was late or wild is a warning") {
  StreamOptions options;
  CHECK(judge_start(kinect(), options, {1, 0, 0, true}).empty());
  options.start_ns = 0;
  CHECK(judge_start(kinect(), options, {1, 0, 0, false}).empty());
  const Findings late = judge_start(kinect(), options, {1, 0, 0, true});
  REQUIRE(late.size() == 1);
  CHECK(whole(late[0]) ==
        "warning: kinect: expected start_ns at a first sample stamped when it was taken, found one "
        "that was held back; all of the stream is shifted by as much; cut that sample from the "
        "file, and say start_ns of the one behind it");
  options.start_ns = 7;  // and the first row that is kept has stamp 0
  CHECK(judge_start(kinect(), options, {}).at(0).what.found ==
        "one with a stamp far from the others'");
  options.files = {{"a.csv", "a"}, {"b.csv", "b"}};  // and the other begins 7 ns earlier
  RecordedStream s = kinect();
  s.clock.pieces.front().offset = Duration{14};
  CHECK(judge_start(s, options, {1, 0, 0, true}).empty());
  s.clock.pieces.front().offset = Duration{7};
  CHECK(judge_start(s, options, {1, 0, 0, true}).at(0).what.found == "one that was held back");
}

TEST_CASE("where no step is known to tell late samples by, a note says so") {
  RecordedStream s = kinect();
  s.survey.usual_step_ns = 27'500'000;
  Arrivals arrivals;
  arrivals.near_only = true;
  CHECK(whole(judge_arrivals(s, arrivals, Role::resampled).at(0)) ==
        "note: kinect: expected a step by which late samples can be told, found a median of 33 ms, "
        "a mean of 27.5; they were not looked for; the device's true rate as rate_hz, or finer "
        "stamps");
}

TEST_CASE("stamps that repeat in one of twenty samples and more are no chance") {
  RecordedStream s = kinect();
  s.survey.duplicates = 50;
  CHECK(judge_stamps(s, {}).at(0).severity == Severity::note);
  s.survey.duplicates = 51;
  CHECK(judge_stamps(s, {}).at(0).severity == Severity::warning);
}

TEST_CASE("from one sample in twenty on, a clock that stepped back is an error") {
  RecordedStream s = kinect();
  s.survey.backward = 51;
  s.survey.largest_step_back_ns = 3'600'000'000'000;
  const Findings found = judge_stamps(s, {});
  REQUIRE(found.size() == 1);
  CHECK(whole(found[0]) ==
        "error: kinect: expected stamps that rise, found 51 of 1000 that step back, by up to "
        "3600.000 s; these samples were left out; the device's clock was set back: cut the file "
        "there, or leave the time column out of its layout and say rate_hz");
}

TEST_CASE("a stream that stands still for half its time is told as what the stamps allow") {
  RecordedStream s = kinect();
  s.survey.last = utc_time(65'934'000'000);
  s.survey.long_steps = 500;
  s.survey.long_time_ns = 49'450'000'000;
  const Findings found = judge_stamps(s, {});
  REQUIRE(found.size() == 1);
  CHECK(whole(found[0]) ==
        "warning: kinect: expected steps near their median of 33 ms, found a mean of 66 ms; "
        "stretches longer than three median steps are taken for gaps; where that is the device's "
        "way, say rate_hz = 15.2 or gap_ms = 198; else many are missing");
  s.survey.last = utc_time(329'670'000'000);
  s.survey.long_time_ns = 296'703'000'000;
  CHECK(
      whole(judge_stamps(s, {}).at(0)) ==
      "warning: kinect: expected steps near their median of 33 ms, found 500 longer ones, 90 % of "
      "the time; the device paused, or samples came in bursts and were stamped on arrival; if it "
      "paused, say rate_hz = 30.3; if they came in bursts, leave the time column out of a layout "
      "and say rate_hz = 3.03");
  s.survey.long_steps = 10;  // 10 of eleven steps are long
  CHECK(judge_stamps(s, {}).empty());
  s.survey.long_steps = 500;
  s.counted = true;  // stamps made from the rate, not by the device, always have its step
  CHECK(judge_stamps(s, {}).empty());
  s.counted = false;
  s.survey.samples = 9;  // too few to tell
  CHECK(judge_stamps(s, {}).empty());
}

TEST_CASE("a stated rate is held against the stamps, and says that long steps are pauses") {
  RecordedStream s = kinect();
  StreamOptions options;
  options.rate_hz = 30.0;
  CHECK(judge_stamps(s, options).empty());
  // Half of the samples are missing; they are counted as gaps.
  s.survey.last = utc_time(65'934'000'000);
  s.survey.long_steps = 500;
  s.survey.long_time_ns = 49'450'000'000;
  CHECK(judge_stamps(s, options).empty());
  options.rate_hz = 15.0;  // the option that the advice names
  CHECK(judge_stamps(s, options).empty());
  options.rate_hz = 100.0;
  const Findings found = judge_stamps(s, options);
  REQUIRE(found.size() == 1);
  CHECK(whole(found[0]) ==
        "warning: kinect: expected steps of 10 ms, by rate_hz, found a median of 33 ms; gaps and "
        "invalid samples are told by the wrong rate; say rate_hz = 30.3, or nothing");
  options.rate_hz = 5.0;
  CHECK(judge_stamps(s, options).size() == 1);
}

TEST_CASE("bursts of any size are told, and a pause now and then is none") {
  const auto meaning_of = [](const std::vector<std::int64_t>& ms) {
    std::vector<Time> stamps;
    for (const std::int64_t t : ms) stamps.push_back(utc_time(t * 1'000'000));
    StampSurveyor surveyor;
    surveyor.add(stamps);
    RecordedStream s = kinect();
    s.survey = surveyor.result();
    const Findings found = judge_stamps(s, {});
    return found.empty() ? "" : found[0].meaning;
  };
  const auto steps = [](std::int64_t usual, std::int64_t rare, std::int64_t each) {
    std::vector<std::int64_t> ms{0};
    for (std::int64_t k = 1; k < 2000; ++k)
      ms.push_back(ms.back() + (k % each == 0 ? rare : usual));
    return ms;
  };
  const std::string bursts =
      "the device paused, or samples came in bursts and were stamped on arrival";
  CHECK(meaning_of(steps(2, 160, 5)) == bursts);
  CHECK(meaning_of(steps(1, 91, 10)) == bursts);
  CHECK(meaning_of(steps(2, 902, 100)) == bursts);
  CHECK(meaning_of(steps(33, 99, 2)).find("taken for gaps") != std::string::npos);
  CHECK(meaning_of(steps(33, 57'000, 500)).empty());  // three pauses
  CHECK(meaning_of(steps(33, 20'000, 200)).empty());  // nine pauses
  CHECK(meaning_of(steps(33, 66, 4)).empty());        // a loss now and then
  CHECK(meaning_of(steps(33, 34, 2)).empty());
}

TEST_CASE("a rate that no device has is a unit taken for another") {
  RecordedStream s = kinect();
  s.survey.median_step_ns = 33'000;  // microseconds read as nanoseconds
  s.survey.last = utc_time(32'967'000);
  const Findings found = judge_stamps(s, {});
  REQUIRE(found.size() == 1);
  CHECK(whole(found[0]) ==
        "warning: kinect: expected 0.5 to 1200 samples a second, found 3.03e+04 by the stamps; the "
        "stamps may be in another unit than they were read in; where a layout reads them, "
        "its [time] says the column's unit: ns, us, ms, s or ticks_100ns");
  s.survey.median_step_ns = 33'000'000'000;
  s.survey.last = utc_time(32'967'000'000'000);
  CHECK(judge_stamps(s, {}).size() == 1);
  s.survey.median_step_ns = 1'000'000;  // a thousand a second
  s.survey.last = utc_time(999'000'000);
  CHECK(judge_stamps(s, {}).empty());
  s.survey.median_step_ns = 500'000;  // inertial sensors of 2,000 Hz there are, cameras not
  s.survey.last = utc_time(499'500'000);
  CHECK(judge_stamps(s, {}).size() == 1);
  s.data = ImuInput{{"waist"}, {}, {}};
  CHECK(judge_stamps(s, {}).empty());
}

TEST_CASE("a grid that loses more than a tenth of a joint's motion names the worst joint") {
  ResampleCount count;
  count.positions = {carried(0.1, 0.02), carried(0.1, 0.03)};
  const Findings found = judge_content(kinect(), count, 29.97);
  REQUIRE(found.size() == 1);
  CHECK(whole(found[0]) ==
        "warning: kinect: expected a grid that carries the stream's content, found 30 % of the rms "
        "of Head's position beyond what a 29.97 Hz grid carries; fast changes between the take's "
        "rows are lost or look slower than they were; choose a faster stream as the reference, or "
        "read this stream's own file for them");
  count.positions = {carried(0.1, 0.0099), carried(0.0, 0.0)};
  CHECK(judge_content(kinect(), count, 29.97).empty());
  count.positions = {carried(0.002, 0.0019), carried(0.0, 0.0)};  // a Kinect's own noise
  CHECK(judge_content(kinect(), count, 29.97).empty());
}

TEST_CASE("of nodes both quantities are judged, each against a sensor's own noise") {
  RecordedStream imu = kinect();
  imu.name = "imu";
  imu.data = ImuInput{{"waist", "wrist_left"}, {}, {}};
  ResampleCount count;
  count.acceleration = {carried(0.06, 0.049), carried(0.06, 0.051)};
  count.angular_velocity = {carried(0.02, 0.011), carried(0.02, 0.009)};
  const Findings found = judge_content(imu, count, 60.0);
  REQUIRE(found.size() == 2);
  CHECK(found[0].what.found ==
        "85 % of the rms of wrist_left's acceleration beyond what a 60 Hz grid carries");
  CHECK(found[1].what.found ==
        "55 % of the rms of waist's angular velocity beyond what a 60 Hz grid carries");
}
