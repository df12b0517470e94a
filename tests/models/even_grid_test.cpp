// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/even_grid.h"

#include "tests/models/bodies.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

constexpr double rate = 30.0, gap = 0.2;

Time at_ms(std::int64_t ms) { return utc_time(1'000'000'000 + ms * 1'000'000); }

/// The standing body at these times, moved to x = time in seconds.
PointFrames walking(const std::vector<std::int64_t>& times_ms) {
  PointFrames out;
  for (const std::int64_t ms : times_ms) {
    out.stamps.push_back(at_ms(ms));
    for (const auto& joint : standing_body) {
      const double x = static_cast<double>(joint[0]) + static_cast<double>(ms) * 1e-3;
      out.positions.insert(out.positions.end(), {x, joint[1], joint[2]});
      out.state.push_back(Tracking::tracked);
    }
  }
  return out;
}

std::vector<std::int64_t> steps(std::size_t n, std::int64_t ms) {
  std::vector<std::int64_t> out;
  for (std::size_t i = 0; i < n; ++i) out.push_back(static_cast<std::int64_t>(i) * ms);
  return out;
}

Result<EvenFrames> even(const PointFrames& points, double rate_hz = rate) {
  return even_frames(body_joint_names(), body_joint_names(), points, {rate_hz, gap});
}

std::string refusal(const Result<EvenFrames>& frames) {
  return frames ? "no error" : to_string(frames.error());
}

void put_state(PointFrames& points, std::size_t frame, std::size_t joint, Tracking state) {
  points.state[frame * standing_body.size() + joint] = state;
}

std::uint8_t seen(const EvenFrames& frames, std::size_t t, std::size_t joint) {
  return frames.body.seen[t * standing_body.size() + joint];
}

}  // namespace

TEST_CASE("even grid: between two samples joints lie on the line between both") {
  // 25 Hz onto 30 Hz: 24 steps of 40 ms are 29 of 33.3 ms.
  const auto frames = even(walking(steps(25, 40)));
  REQUIRE(frames);
  CHECK(frames->start == at_ms(0));
  CHECK(frames->rate_hz == rate);
  REQUIRE(frames->body.frames() == 30);
  for (std::size_t t = 0; t < 29; ++t) {
    const double x = frames->body.positions[t * standing_body.size() * 3];
    CHECK(x == doctest::Approx(static_cast<double>(t) / rate).epsilon(1e-6));
    CHECK(seen(*frames, t, 0) == 2);
  }
}

TEST_CASE("even grid: a joint is seen as well as the worse of the samples around") {
  PointFrames points = walking(steps(25, 40));
  put_state(points, 3, 5, Tracking::inferred);
  put_state(points, 3, 6, Tracking::missing);
  const auto frames = even(points);
  REQUIRE(frames);
  // Sample 3 is at 120 ms, between rows 3 (100 ms) and 4 (133 ms).
  for (const std::size_t t : {3U, 4U}) {
    CHECK(seen(*frames, t, 5) == 1);
    CHECK(seen(*frames, t, 6) == 0);
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(frames->body.positions[(t * standing_body.size() + 6) * 3 + k] == 0.0F);
    }
  }
  CHECK(seen(*frames, 2, 5) == 2);
  CHECK(seen(*frames, 5, 5) == 2);
}

TEST_CASE("even grid: a row at a sample's stamp takes that sample alone") {
  PointFrames points = walking(steps(11, 100));
  put_state(points, 5, 0, Tracking::missing);
  const auto frames = even(points, 10.0);
  REQUIRE(frames);
  REQUIRE(frames->body.frames() == 11);
  for (std::size_t t = 0; t < 11; ++t) CHECK(seen(*frames, t, 0) == (t == 5 ? 0 : 2));
}

TEST_CASE("even grid: rows far from any sample are missing") {
  auto times = steps(30, 33);
  for (std::size_t i = 15; i < 30; ++i) times[i] += 1000;  // 1 s without samples
  const auto frames = even(walking(times));
  REQUIRE(frames);
  std::size_t missing = 0;
  for (std::size_t t = 0; t < frames->body.frames(); ++t)
    missing += seen(*frames, t, 0) == 0 ? 1 : 0;
  // 1.033 s of gap, minus 0.2 s at both ends, at 30 Hz: 19 rows.
  CHECK(missing == 19);
  CHECK(seen(*frames, 14 + 5, 0) == 2);
  CHECK(seen(*frames, 14 + 6, 0) == 0);
}

TEST_CASE("even grid: a joint that the device does not have is missing") {
  auto names = body_joint_names();
  names.push_back("Tail");
  const auto frames = even_frames(names, body_joint_names(), walking(steps(30, 33)), {rate, gap});
  REQUIRE(frames);
  const std::size_t joints = names.size();
  for (std::size_t t = 0; t < frames->body.frames(); ++t) {
    CHECK(frames->body.seen[t * joints + joints - 1] == 0);
    CHECK(frames->body.seen[t * joints] == 2);
  }
}

TEST_CASE("even grid: what can't be cleaned is refused") {
  CHECK(refusal(even(walking({}))) == "expected at least two frames, found 0");
  CHECK(refusal(even(walking({0}))) == "expected at least two frames, found 1");
  CHECK(refusal(even(walking({0, 33, 20, 66}))) ==
        "expected rising stamps, found frame 2 is earlier");
  CHECK(refusal(even(walking(steps(30, 100)))) ==
        "expected about 30 frames a second, found 10 frames a second");
  CHECK(refusal(even(walking(steps(30, 5)))) ==
        "expected about 30 frames a second, found 200 frames a second");
  auto names = body_joint_names();
  names[12] = "Tail";  // the left hip
  CHECK(refusal(even_frames(body_joint_names(), names, walking(steps(30, 33)), {rate, gap})) ==
        "expected a joint \"HipLeft\", which the model needs, found no such joint");
}

TEST_CASE("even grid: a body that is no person's size is refused") {
  PointFrames points = walking(steps(30, 33));
  for (double& value : points.positions) value *= 1000.0;  // millimetres
  CHECK(refusal(even(points)) ==
        "expected a body of 0.4 to 2.6 m, in metres, y up, found 1610 m from the lowest joint to "
        "the highest");
  for (Tracking& state : points.state) state = Tracking::missing;
  CHECK_FALSE(even(points));
}

TEST_CASE("even grid: too many frames are refused before memory is taken") {
  PointFrames points = walking(steps(30, 33));
  points.stamps.back() = utc_time(9'000'000'000'000'000'000);
  CHECK(refusal(even(points)).starts_with("expected at most 10,000,000 frames"));
}

TEST_CASE("even grid: on a span of others, joints are missing where the device has no samples") {
  const PointFrames points = walking(steps(30, 33));
  const auto own = even_frames(body_joint_names(), body_joint_names(), points, {rate, gap});
  REQUIRE(own);
  const EvenSpan span{points.stamps.front() - Duration(1'000'000'000), 90};
  const auto wide = even_frames(body_joint_names(), body_joint_names(), points, {rate, gap, span});
  REQUIRE(wide);
  CHECK(wide->body.frames() == 90);
  CHECK(wide->start == span.start);
  const std::size_t joints = body_joint_names().size();
  CHECK(wide->body.seen[0] == 0);
  CHECK(wide->body.seen[89 * joints] == 0);
  for (std::size_t t = 0; t + 2 < own->body.frames(); ++t) {
    const std::size_t from = 3 * t * joints, to = 3 * (t + 30) * joints;
    CHECK(wide->body.positions[to] == doctest::Approx(own->body.positions[from]).epsilon(1e-4));
  }
}
