// SPDX-License-Identifier: Apache-2.0
// Rules for any stream in memory.
#include "tests/seeds.h"
#include "tests/take/recorded.h"

#include "kinalign/motion/frame_arrays.h"
#include "kinalign/take/recording.h"

#include <doctest/doctest.h>

#include <random>
#include <thread>
#include <vector>

using namespace kinalign;

namespace {

std::vector<Time> any_stamps(std::size_t n, std::mt19937_64& random) {
  std::vector<Time> out;
  for (std::size_t i = 0; i < n; ++i) {
    out.push_back(utc_time(static_cast<std::int64_t>(i * 30 + random() % 70) * 1'000'000));
  }
  return out;
}

std::vector<double> numbers(std::size_t n, std::mt19937_64& random) {
  std::uniform_real_distribution<double> any(-3.0, 3.0);
  std::vector<double> out(n);
  for (double& v : out) v = any(random);
  return out;
}

PointStream any_points(std::mt19937_64& random) {
  const std::size_t n = random() % 50;
  PointStream points{{"Head", "Neck"}, {any_stamps(n, random), numbers(6 * n, random), {}}};
  for (std::size_t i = 0; i < 2 * n; ++i) {
    points.frames.state.push_back(static_cast<Tracking>(random() % 3));
  }
  return points;
}

ImuStream any_nodes(std::mt19937_64& random) {
  const std::size_t n = random() % 50;
  return {{"waist"},
          {true, true, false, true},
          {any_stamps(n, random),
           numbers(4 * n, random),
           numbers(3 * n, random),
           {},
           std::vector<std::uint8_t>(n, 1)}};
}

Clip any_clip(std::mt19937_64& random) {
  const std::size_t n = random() % 50;
  return {{{"Hips"}, {-1}, {Vec3(0, 1, 0)}, {}},
          {any_stamps(n, random), numbers(3 * n, random), numbers(4 * n, random)}};
}

/// All blocks of a pass, joined.
template <class Frames>
Frames gathered(Pass<Frames> pass) {
  Frames all, block;
  for (;;) {
    const auto more = pass(block);
    REQUIRE(more);
    if (!*more) return all;
    REQUIRE(block.size() > 0);
    for_each_frame_array<Frames>([&](auto array) {
      (all.*array).insert((all.*array).end(), (block.*array).begin(), (block.*array).end());
    });
  }
}

template <class Frames>
bool same(const Frames& a, const Frames& b) {
  bool all = true;
  for_each_frame_array<Frames>([&](auto array) { all = all && a.*array == b.*array; });
  return all;
}

template <class Input, class Frames>
void check_stream(const RecordedStream& stream, const Frames& expected) {
  StampSurveyor surveyor;
  surveyor.add(expected.stamps);
  const StampSurvey survey = surveyor.result();
  CHECK(stream.survey.samples == expected.size());
  CHECK(stream.survey.kept() == survey.kept());
  CHECK(stream.survey.duplicates == survey.duplicates);
  CHECK(stream.survey.backward == survey.backward);
  CHECK(stream.survey.first == survey.first);
  CHECK(stream.survey.last == survey.last);
  CHECK(stream.survey.median_step_ns == survey.median_step_ns);
  CHECK_FALSE(stream.step_ns);  // the stream has stamps of its own, not a rate
  const Passes<Frames> passes = std::get<Input>(stream.data).passes;
  for (int i = 0; i < 2; ++i) {
    auto pass = passes();
    REQUIRE(pass);
    CHECK(same(gathered(*pass), expected));
  }
}

}  // namespace

TEST_CASE("each pass over a stream in memory gives the frames that were put in, to the last bit") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Clip clip = any_clip(random);
    const PointStream points = any_points(random);
    const ImuStream nodes = any_nodes(random);
    check_stream<ClipInput>(recorded("mocap", clip), clip.frames);
    check_stream<PointInput>(recorded("kinect", points), points.frames);
    check_stream<ImuInput>(recorded("imu", nodes), nodes.samples);
  }
}

TEST_CASE("a pass outlives the stream that began it") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const PointStream points = any_points(random);
    const auto begin = [&points] {
      const RecordedStream stream = recorded("kinect", points);
      return std::get<PointInput>(stream.data).passes();
    };
    auto pass = begin();
    REQUIRE(pass);
    CHECK(same(gathered(*pass), points.frames));
  }
}

TEST_CASE("threads that pass over one stream at a time do not disturb each other") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Clip clip = any_clip(random);
    const RecordedStream stream = recorded("mocap", clip);
    std::vector<ClipFrames> found(4);
    {
      std::vector<std::jthread> threads;
      for (ClipFrames& one : found) {
        threads.emplace_back(
            [&stream, &one] { one = gathered(*std::get<ClipInput>(stream.data).passes()); });
      }
    }
    for (const ClipFrames& one : found) CHECK(same(one, clip.frames));
  }
}
