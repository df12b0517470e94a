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
  CHECK(
      whole(found[0]) ==
      "note: k.csv: expected rising stamps, found 3 that repeat the previous stamp; these samples "
      "were left out; ");
  CHECK(whole(found[1]) ==
        "warning: k.csv: expected stamps without jumps, found 2 far ahead of their neighbours; "
        "these samples were left out; ");
  CHECK(whole(found[2]) ==
        "warning: k.csv: expected rising stamps, found 50 of 1000 that step back, by up to "
        "1.500 s; these samples were left out; if there are many, check the device's clock");
}

TEST_CASE("delayed samples are a warning with a repair") {
  CHECK(judge_arrivals(kinect(), {}, Role::resampled).empty());
  CHECK(judge_arrivals(kinect(), {}, Role::reference).empty());
  const Findings found = judge_arrivals(kinect(), {3, 0, 0}, Role::resampled);
  REQUIRE(found.size() == 1);
  CHECK(whole(found[0]) ==
        "warning: kinect: expected samples at least a fifth of a step apart, found 3 closer to the "
        "next sample; these samples were delayed: they are dropped when the stream is resampled; "
        "stamp samples when they are measured, not when they arrive");
  CHECK(judge_arrivals(kinect(), {3, 0, 0}, Role::reference).at(0).meaning ==
        "these samples were delayed: this stream is the reference, so they keep their late stamps, "
        "and the other streams are resampled onto them");
}

TEST_CASE("samples that came late behind a pause are a warning with how late they were") {
  const Findings found = judge_arrivals(kinect(), {0, 12, 414'000'000}, Role::resampled);
  REQUIRE(found.size() == 1);
  CHECK(whole(found[0]) ==
        "warning: kinect: expected samples without delay, found 12 in a burst after a pause, late "
        "by 0.41 s or more; where these samples are used, the take lags behind the motion by this "
        "time; use the device's own stamps if the file has them, or remove the time column from "
        "its layout and set rate_hz");
}

TEST_CASE("a start_ns at a first sample that was late or wild is a warning") {
  StreamOptions options;
  CHECK(judge_start(kinect(), options, {1, 0, 0, true}).empty());
  options.start_ns = 0;
  CHECK(judge_start(kinect(), options, {1, 0, 0, false}).empty());
  const Findings late = judge_start(kinect(), options, {1, 0, 0, true});
  REQUIRE(late.size() == 1);
  CHECK(whole(late[0]) ==
        "warning: kinect: expected a first sample that was stamped when it was measured, for "
        "start_ns, found a delayed sample; the whole stream is shifted by this delay; remove this "
        "sample from the file, and set start_ns to the stamp of the next sample");
  options.start_ns = 7;  // and the first row that is kept has stamp 0
  CHECK(judge_start(kinect(), options, {}).at(0).what.found ==
        "a sample whose stamp is far from the others");
  options.files = {{"a.csv", "a"}, {"b.csv", "b"}};  // and the other begins 7 ns earlier
  RecordedStream s = kinect();
  s.clock.pieces.front().offset = Duration{14};
  CHECK(judge_start(s, options, {1, 0, 0, true}).empty());
  s.clock.pieces.front().offset = Duration{7};
  CHECK(judge_start(s, options, {1, 0, 0, true}).at(0).what.found == "a delayed sample");
}

TEST_CASE("if late samples can't be detected without a step, a note says so") {
  RecordedStream s = kinect();
  s.survey.usual_step_ns = 27'500'000;
  Arrivals arrivals;
  arrivals.near_only = true;
  CHECK(whole(judge_arrivals(s, arrivals, Role::resampled).at(0)) ==
        "note: kinect: expected a regular step, to detect late samples, found a median of 33 ms, "
        "a mean of 27.5; late samples were not looked for; set rate_hz to the device's true rate, "
        "or use finer stamps");
}

TEST_CASE("stamps that repeat in one of twenty samples and more are no chance") {
  RecordedStream s = kinect();
  s.survey.duplicates = 50;
  CHECK(judge_stamps(s, {}).at(0).severity == Severity::note);
  s.survey.duplicates = 51;
  CHECK(judge_stamps(s, {}).at(0).severity == Severity::warning);
}

TEST_CASE("a clock that steps back is an error from 5 % of the samples on") {
  RecordedStream s = kinect();
  s.survey.backward = 51;
  s.survey.largest_step_back_ns = 3'600'000'000'000;
  const Findings found = judge_stamps(s, {});
  REQUIRE(found.size() == 1);
  CHECK(whole(found[0]) ==
        "error: kinect: expected rising stamps, found 51 of 1000 that step back, by up to "
        "3600.000 s; these samples were left out; the device's clock was set back: cut the file "
        "there, or remove the time column from its layout and set rate_hz");
}

TEST_CASE("a stream that pauses for half its time gives a warning with both causes") {
  RecordedStream s = kinect();
  s.survey.last = utc_time(65'934'000'000);
  s.survey.long_steps = 500;
  s.survey.long_time_ns = 49'450'000'000;
  const Findings found = judge_stamps(s, {});
  REQUIRE(found.size() == 1);
  CHECK(whole(found[0]) ==
        "warning: kinect: expected steps near their median of 33 ms, found a mean of 66 ms; "
        "stretches longer than three median steps count as gaps; if the device sends this way, set "
        "rate_hz = 15.2 or gap_ms = 198; otherwise many samples are missing");
  s.survey.last = utc_time(329'670'000'000);
  s.survey.long_time_ns = 296'703'000'000;
  CHECK(whole(judge_stamps(s, {}).at(0)) ==
        "warning: kinect: expected steps near their median of 33 ms, found 500 longer steps, 90 % "
        "of the time; the device paused, or samples came in bursts and were stamped on arrival; if "
        "the device paused, set rate_hz = 30.3; if samples came in bursts, remove the time column "
        "from the layout and set rate_hz = 3.03");
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
        "warning: kinect: expected steps of 10 ms, as stated by rate_hz, found a median of 33 ms; "
        "gaps and invalid samples are judged by the wrong rate; set rate_hz = 30.3, or remove it");
  options.rate_hz = 5.0;
  CHECK(judge_stamps(s, options).size() == 1);
}

TEST_CASE("bursts of any size are reported, single pauses are not") {
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
  CHECK(meaning_of(steps(33, 99, 2)).find("count as gaps") != std::string::npos);
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
        "warning: kinect: expected 0.5 to 1200 samples per second, found 3.03e+04 according to the "
        "stamps; the stamps were probably read in the wrong unit; if a layout reads the stamps, "
        "correct the unit in its [time]: ns, us, ms, s or ticks_100ns");
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
        "warning: kinect: expected a grid that can represent the stream's content, found 30 % of "
        "the rms "
        "of Head's position above what a 29.97 Hz grid can represent; fast changes between the "
        "rows of "
        "the take are lost or look slower; choose a faster stream as the reference, or use this "
        "stream's original file");
  count.positions = {carried(0.1, 0.0099), carried(0.0, 0.0)};
  CHECK(judge_content(kinect(), count, 29.97).empty());
  count.positions = {carried(0.002, 0.0019), carried(0.0, 0.0)};  // a Kinect's own noise
  CHECK(judge_content(kinect(), count, 29.97).empty());
}

TEST_CASE("both quantities of nodes are judged, each against a sensor's noise") {
  RecordedStream imu = kinect();
  imu.name = "imu";
  imu.data = ImuInput{{"waist", "wrist_left"}, {}, {}};
  ResampleCount count;
  count.acceleration = {carried(0.06, 0.049), carried(0.06, 0.051)};
  count.angular_velocity = {carried(0.02, 0.011), carried(0.02, 0.009)};
  const Findings found = judge_content(imu, count, 60.0);
  REQUIRE(found.size() == 2);
  CHECK(found[0].what.found ==
        "85 % of the rms of wrist_left's acceleration above what a 60 Hz grid can represent");
  CHECK(found[1].what.found ==
        "55 % of the rms of waist's angular velocity above what a 60 Hz grid can represent");
}
