// SPDX-License-Identifier: Apache-2.0
#include "tests/folder.h"
#include "tests/formats/any_points.h"
#include "tests/formats/reading.h"
#include "tests/seeds.h"
#include "tests/witness.h"

#include "kinalign/formats/c3d/c3d.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

using namespace kinalign;

namespace {

constexpr double rate_hz = 59.94;
constexpr std::int64_t start_ns = 1'790'000'000'000'000'000;

Result<std::string> written(const PointStream& stream, std::uint64_t frames,
                            double rate = rate_hz) {
  std::string bytes;
  auto writer = KA_TRY(C3dWriter::begin({stream.joint_names, rate, frames},
                                        [&](std::string_view more) -> Result<void> {
                                          bytes += more;
                                          return {};
                                        }));
  KA_TRY(writer.append(stream.frames));
  KA_TRY(writer.finish());
  return bytes;
}

std::string error_of(const PointStream& stream, std::uint64_t frames, double rate = rate_hz) {
  const auto bytes = written(stream, frames, rate);
  return bytes ? "" : to_string(bytes.error());
}

}  // namespace

TEST_CASE("points that were written as C3D are read again to a micrometre") {
  for (const std::uint64_t seed : fresh_seeds(30)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const PointStream stream =
        any_points(1 + random() % 400, random() % 40, rate_hz, start_ns, random);
    const auto bytes = written(stream, stream.frames.size());
    REQUIRE(bytes);
    CHECK(looks_like_c3d(*bytes));
    StreamOptions options;
    options.start_ns = start_ns;
    const auto read = read_in_pieces(make_c3d_reader(options, "w.c3d"), *bytes, 997);
    CHECK(read.error == "");
    CHECK(read.findings.empty());
    CHECK(read.header.joint_names == stream.joint_names);
    CHECK(read.rows.stamps == stream.frames.stamps);
    CHECK(read.rows.state == stream.frames.state);
    CHECK(largest_difference(read.rows.positions, stream.frames.positions) <=
          0.5e-6);  // half a step of an f32 between 8.2 and 16.4 m
  }
}

TEST_CASE("an independent reader finds in a written C3D what was given") {
  for (const std::size_t frames : {std::size_t{90}, std::size_t{70'000}}) {
    std::mt19937_64 random(frames);
    const std::size_t points = frames > 1000 ? 2 : 300;
    const PointStream stream = any_points(points, frames, rate_hz, start_ns, random);
    const FreshFolder folder;
    folder.write("written.c3d", written(stream, frames).value());
    put_points(folder, stream.frames);
    CHECK(run_witness("c3d_read.py", folder.path()) == 0);
  }
}

TEST_CASE("a C3D of more than 65,535 frames states them and is read whole") {
  std::mt19937_64 random(1);
  const PointStream stream = any_points(1, 66'000, rate_hz, start_ns, random);
  const auto read = read_all(make_c3d_reader({}, "w.c3d"), written(stream, 66'000).value());
  CHECK(read.findings.empty());
  CHECK(read.rows.state == stream.frames.state);
}

TEST_CASE("the same points give the same bytes, in whatever blocks they come") {
  std::mt19937_64 random(3);
  const PointStream stream = any_points(3, 50, rate_hz, start_ns, random);
  std::string bytes;
  auto writer = C3dWriter::begin({stream.joint_names, rate_hz, 50},
                                 [&](std::string_view more) -> Result<void> {
                                   bytes += more;
                                   return {};
                                 });
  REQUIRE(writer);
  for (std::size_t t = 0; t < 50; ++t) {
    PointFrames one;
    one.stamps = {stream.frames.stamps[t]};
    one.positions.assign(&stream.frames.positions[9 * t], &stream.frames.positions[9 * t] + 9);
    one.state.assign(&stream.frames.state[3 * t], &stream.frames.state[3 * t] + 3);
    CHECK(writer->append(one));
  }
  CHECK(writer->finish());
  CHECK(bytes == written(stream, 50).value());
}

TEST_CASE("what a C3D can't hold is refused") {
  std::mt19937_64 random(2);
  PointStream stream = any_points(2, 3, rate_hz, start_ns, random);
  CHECK(error_of(stream, 2) == "expected 2 frames, found more");
  CHECK(error_of(stream, 4) == "expected 4 frames, found 3");
  CHECK(error_of(stream, 3, 0.0) == "expected a rate of 0.001 to 1,000,000 Hz for a C3D, found 0");
  CHECK(error_of(stream, 1ULL << 31) ==
        "expected at most 2^31 - 1 frames for a C3D, found 2147483648");
  stream.frames.stamps[2] += Duration{9'000'000};
  CHECK(error_of(stream, 3) ==
        "expected evenly spaced stamps at 59.94 Hz, as required by C3D, found frame 3 off by 0.009 "
        "s");
  stream.joint_names[0] = std::string(121, 'x');
  CHECK(
      error_of(stream, 3).starts_with("expected names of at most 120 bytes for a C3D, found xxx"));
  CHECK(error_of({}, 0) == "expected 1 to 65,535 points for a C3D, found 0");
  stream = any_points(20'000, 0, rate_hz, start_ns, random);
  for (std::string& name : stream.joint_names) name += "_of_the_left_hand";
  CHECK(error_of(stream, 0) ==
        "expected names that fit into 130 KB of C3D parameters, found 20000 names that do not fit");
}

TEST_CASE("a disk that refuses is reported") {
  std::mt19937_64 random(2);
  const PointStream stream = any_points(2, 3, rate_hz, start_ns, random);
  auto writer =
      C3dWriter::begin({stream.joint_names, rate_hz, 3}, [](std::string_view) -> Result<void> {
        return Failure(Error{"", 0, "room", "none"});
      });
  REQUIRE(writer);
  CHECK(writer->append(stream.frames));
  CHECK(!writer->finish());
}
