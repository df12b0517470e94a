// SPDX-License-Identifier: Apache-2.0
#include "kinalign/align/align.h"

#include "tests/align/streams.h"

#include "kinalign/align/space.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>

using namespace kinalign;
using namespace kinalign::test;

namespace {

const std::vector<std::string> joints{"SpineBase", "Head", "HandLeft", "HandRight"};

Recording two(PointStream reference, PointStream other) {
  Recording recording;
  recording.streams.push_back(recorded("optical", std::move(reference)));
  recording.streams.push_back(recorded("kinect", std::move(other)));
  return recording;
}

const PointRows& rows(const Take& take, std::size_t group) {
  return std::get<PointRows>(take.all.rows[group]);
}

Vec3 at(const PointRows& rows, std::size_t row, std::size_t joint) {
  return vec3(std::span<const double>(rows.positions), row * joints.size() + joint);
}

}  // namespace

TEST_CASE("a take is cut to the span that all streams share, on the reference's own stamps") {
  const auto take = align(two(points(joints, every(10 * ms, 101), wander),
                              points(joints, every(33 * ms, 20, 207 * ms), wander)),
                          {});
  REQUIRE(take);
  CHECK(to_ns(take->all.stamps.front()) == 210 * ms);
  CHECK(to_ns(take->all.stamps.back()) == 830 * ms);  // 207 + 19 * 33 = 834
  CHECK(take->header.frames == 63);
  CHECK(take->report.frames == 63);
  CHECK(take->report.rate_hz == doctest::Approx(100.0).epsilon(0.01));
}

TEST_CASE("a smooth motion is given back between its samples, and exactly at them") {
  const auto take = align(
      two(points(joints, every(10 * ms, 400), wander), points(joints, every(30 * ms, 134), wander)),
      {});
  REQUIRE(take);
  const PointRows& kinect = rows(*take, 1);
  for (std::size_t r = 0; r < take->all.stamps.size(); ++r) {
    const double t = 1e-9 * static_cast<double>(to_ns(take->all.stamps[r]));
    const bool inner = r > 30 && r + 30 < take->all.stamps.size();  // the natural ends are flat
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const double off = (at(kinect, r, j) - wander(j, t)).norm();
      CHECK(off < (r % 3 == 0 ? 1e-12 : inner ? 2e-6 : 2e-3));
      CHECK(kinect.valid[r * joints.size() + j] == 1);
      CHECK(kinect.state[r * joints.size() + j] == Tracking::tracked);
    }
    CHECK(kinect.distance.nearest_raw_ns[r] == (r % 3 == 0 ? 0 : 10 * ms));
  }
}

TEST_CASE("across a gap nothing is invented: samples are there, invalid and zero") {
  auto stamps = every(30 * ms, 100);
  stamps.erase(stamps.begin() + 40, stamps.begin() + 50);  // 1170 ms .. 1500 ms
  const auto take =
      align(two(points(joints, every(10 * ms, 298), wander), points(joints, stamps, wander)), {});
  REQUIRE(take);
  const PointRows& kinect = rows(*take, 1);
  for (std::size_t r = 0; r < take->all.stamps.size(); ++r) {
    const bool in_gap = r > 117 && r < 150;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const std::size_t cell = r * joints.size() + j;
      CHECK(kinect.valid[cell] == (in_gap ? 0 : 1));
      CHECK((at(kinect, r, j) == Vec3::Zero()) == in_gap);
      if (in_gap) CHECK(kinect.state[cell] == Tracking::missing);
    }
  }
  CHECK(take->report.streams[1].gaps == 1);
  CHECK(take->report.streams[1].gap_time_ns == 330 * ms);
  CHECK(take->report.streams[1].invalid == 32 * joints.size());
}

TEST_CASE("a gap of just three steps is bridged, a longer one is not") {
  for (const std::size_t lost : {std::size_t{2}, std::size_t{3}}) {
    auto stamps = every(30 * ms, 100);
    stamps.erase(stamps.begin() + 40, stamps.begin() + 40 + static_cast<std::ptrdiff_t>(lost));
    const auto take =
        align(two(points(joints, every(10 * ms, 298), wander), points(joints, stamps, wander)), {});
    REQUIRE(take);
    CHECK((take->report.streams[1].invalid == 0) == (lost == 2));
  }
}

TEST_CASE("a joint's spline does not run through samples that were not seen") {
  auto kinect = points(joints, every(30 * ms, 100), wander);
  const std::size_t hand = 2, frame = 50;
  kinect.frames.state[frame * joints.size() + hand] = Tracking::missing;
  for (int k = 0; k < 3; ++k)
    kinect.frames.positions[(frame * joints.size() + hand) * 3 + static_cast<std::size_t>(k)] = 0.0;
  const auto take = align(two(points(joints, every(10 * ms, 298), wander), kinect), {});
  REQUIRE(take);
  const PointRows& out = rows(*take, 1);
  for (std::size_t r = 148; r <= 152; ++r) {  // around 1500 ms
    const std::size_t cell = r * joints.size() + hand;
    const double t = 0.01 * static_cast<double>(r);
    CHECK((at(out, r, hand) - wander(hand, t)).norm() < 1e-4);
    CHECK(out.valid[cell] == 1);
    CHECK(out.state[cell] == Tracking::missing);
    CHECK(out.state[cell + 1] == Tracking::tracked);
  }
  CHECK(out.state[147 * joints.size() + hand] == Tracking::tracked);
  CHECK(out.state[153 * joints.size() + hand] == Tracking::tracked);
}

TEST_CASE("inferred joints stay marked between and at their samples") {
  auto kinect = points(joints, every(30 * ms, 100), wander);
  kinect.frames.state[50 * joints.size() + 1] = Tracking::inferred;
  const auto take = align(two(points(joints, every(10 * ms, 298), wander), kinect), {});
  REQUIRE(take);
  for (std::size_t r = 148; r <= 152; ++r) {
    CHECK(rows(*take, 1).state[r * joints.size() + 1] == Tracking::inferred);
    CHECK(rows(*take, 1).valid[r * joints.size() + 1] == 1);
  }
  CHECK(take->report.streams[1].inferred == 5);
}

TEST_CASE("stamps that repeat or step back are left out and reported") {
  auto stamps = every(30 * ms, 100);
  stamps[20] = stamps[19];
  stamps[60] = stamps[57];
  const auto take =
      align(two(points(joints, every(10 * ms, 298), wander), points(joints, stamps, wander)),
            own_space());
  REQUIRE(take);
  CHECK(take->report.streams[1].survey.duplicates == 1);
  CHECK(take->report.streams[1].survey.backward == 1);
  REQUIRE(take->report.findings.size() == 2);
  CHECK(to_string(take->report.findings[0].what) ==
        "kinect: expected stamps that rise, found 1 of 100 that step back, by up to 0.060 s");
}

TEST_CASE("streams that do not overlap are refused with their spans") {
  const auto take = align(two(points(joints, every(10 * ms, 100), wander),
                              points(joints, every(30 * ms, 100, 5'000 * ms), wander)),
                          {});
  REQUIRE(!take);
  CHECK(to_string(take.error()) ==
        "expected streams that overlap in time (see start_ns and offset_ms), found "
        "optical 0.000 to 0.990 s, kinect 5.000 to 7.970 s");
}

TEST_CASE("a rigid fit once per take finds a camera's place and turn") {
  const Quat turn = turn_about_y(-58.7);
  const Vec3 place(0.4, -0.9, 2.5);
  const auto seen = [&](std::size_t j, double t) { return Vec3(turn * wander(j, t) + place); };
  Manifest manifest;
  manifest.spaces["kinect"].method = "fit";
  const auto take = align(
      two(points(joints, every(10 * ms, 3000), wander), points(joints, every(30 * ms, 1000), seen)),
      manifest);
  REQUIRE(take);
  REQUIRE(take->report.spaces.size() == 1);
  const SpaceReport& space = take->report.spaces[0];
  CHECK(space.transform.rotation.angularDistance(turn.conjugate()) < 1e-5);
  CHECK(space.after_m < 2e-4);  // what the splines leave at the ends
  CHECK(space.before_m > 2.0);
  CHECK(space.joints.size() == 4);
  for (std::size_t r = 100; r < 2900; ++r) {
    CHECK((at(rows(*take, 1), r, 2) - at(rows(*take, 0), r, 2)).norm() < 1e-4);
  }
}

TEST_CASE("without named joints a Kinect is fitted by the places that both skeletons have") {
  // Neck and Head stand on both, but are not the same places: they must not be paired by name.
  const std::vector<std::string> kinect{"SpineBase", "Neck", "Head", "KneeLeft", "WristLeft"};
  const std::vector<std::string> mocap{"Hips", "Neck", "Head", "LeftLeg", "LeftHand"};
  const auto higher = [](std::size_t j, double t) {
    return Vec3(wander(j, t) + (j == 1 || j == 2 ? Vec3(0.0, 0.1, 0.0) : Vec3::Zero()));
  };
  Manifest manifest;
  manifest.spaces["kinect"].method = "fit";
  const auto take = align(
      two(points(mocap, every(10 * ms, 300), higher), points(kinect, every(10 * ms, 300), wander)),
      manifest);
  REQUIRE(take);
  CHECK(take->report.spaces.at(0).joints.size() == 3);
  CHECK(take->report.spaces.at(0).after_m < 1e-9);
}

TEST_CASE("equations (1) and (2): in every frame the root lies on the mocap's root") {
  const auto seen = [](std::size_t j, double t) {
    return Vec3(turn_about_y(-60.0) * wander(j, t) + Vec3(0.3 * std::sin(5.0 * t), -0.9, 2.5));
  };
  Manifest manifest;
  SpaceOptions& paper = manifest.spaces["kinect"];
  paper.method = "paper";
  paper.onto_root = "SpineBase";
  for (const double m : {1.0, 1.25}) {
    paper.magnification = m;
    const auto take = align(
        two(points(joints, every(10 * ms, 300), wander), points(joints, every(30 * ms, 100), seen)),
        manifest);
    REQUIRE(take);
    for (std::size_t r = 0; r < take->all.stamps.size(); ++r) {
      const Vec3 root = at(rows(*take, 0), r, 0);
      CHECK((at(rows(*take, 1), r, 0) - root).norm() < 1e-12);
      const double t = 1e-9 * static_cast<double>(to_ns(take->all.stamps[r]));
      const Vec3 hand = m * (wander(2, t) - wander(0, t)) + wander(0, t);
      CHECK((at(rows(*take, 1), r, 2) - hand).norm() < 5e-3);  // the flat ends of the splines
    }
  }
}

TEST_CASE("a given transform is applied as it is") {
  Manifest manifest;
  SpaceOptions& given = manifest.spaces["kinect"];
  given.method = "given";
  given.rotation = {std::sqrt(0.5), 0.0, std::sqrt(0.5), 0.0};  // x to -z
  given.translation = {1.0, 2.0, 3.0};
  const auto take = align(
      two(points(joints, every(30 * ms, 100), wander), points(joints, every(30 * ms, 100), wander)),
      manifest);
  REQUIRE(take);
  for (std::size_t r = 0; r < 100; ++r) {
    const Vec3 p = at(rows(*take, 0), r, 1);
    const Vec3 expected(p.z() + 1.0, p.y() + 2.0, -p.x() + 3.0);
    CHECK((at(rows(*take, 1), r, 1) - expected).norm() < 1e-12);
  }
}

TEST_CASE("the paper's table in centimetres: m = 100 and the mocap's root in metres") {
  // HFUT-MMD, equations (1) and (2) as printed: x' = m (A_rot x - A_offset), A_offset = A_rot x_k0
  // - x_d0. With m = 100 and x_d0 in metres the result is 100 times ours, in centimetres.
  const auto seen = [](std::size_t j, double t) {
    return Vec3(turn_about_y(-60.0) * wander(j, t) + Vec3(0.2, -0.9, 2.5));
  };
  Manifest manifest;
  manifest.spaces["kinect"].method = "paper";
  manifest.spaces["kinect"].onto_root = "SpineBase";
  const auto reference = points(joints, every(10 * ms, 300), wander);
  const auto kinect = points(joints, every(10 * ms, 300), seen);
  const auto take = align(two(reference, kinect), manifest);
  REQUIRE(take);
  for (std::size_t r = 0; r < 300; ++r) {
    const auto x = [&](std::size_t j) { return vec3(kinect.frames.positions, 4 * r + j); };
    const Vec3 x_d0 = vec3(reference.frames.positions, 4 * r);
    const Vec3 offset = turn_about_y(60.0) * x(0) - x_d0;
    for (std::size_t j = 0; j < 4; ++j) {
      const Vec3 printed = 100.0 * (turn_about_y(60.0) * x(j) - offset);
      CHECK((100.0 * at(rows(*take, 1), r, j) - printed).norm() < 1e-10);
    }
  }
}

TEST_CASE("magnification belongs to the paper's method") {
  Manifest manifest;
  manifest.spaces["kinect"].method = "fit";
  manifest.spaces["kinect"].magnification = 3.0;
  const auto stream = points(joints, every(10 * ms, 300), wander);
  const auto take = align(two(stream, stream), manifest);
  REQUIRE(!take);
  CHECK(to_string(take.error()) ==
        "expected magnification with method = \"paper\" only, found 'kinect' with method = "
        "\"fit\"");
}

TEST_CASE("a stream that nobody places says so, and whose space it is in") {
  const auto stream = points(joints, every(10 * ms, 300), wander);
  Manifest manifest;
  const auto take = align(two(stream, stream), manifest);
  REQUIRE(take);
  CHECK(take->header.groups[0].space == "take");
  CHECK(take->header.groups[1].space == "kinect");
  REQUIRE(take->report.findings.size() == 1);
  CHECK(take->report.findings[0].severity == Severity::note);
  CHECK(to_string(take->report.findings[0].what) == "expected a space for 'kinect', found none");

  manifest.spaces["kinect"].method = "none";
  CHECK(align(two(stream, stream), manifest)->report.findings.empty());
  manifest.spaces["kinect"].method = "fit";
  const auto moved = align(two(stream, stream), manifest);
  CHECK(moved->report.findings.empty());
  CHECK(moved->header.groups[1].space == "take");
}

TEST_CASE("a fit of what is not the same motion is a warning") {
  const auto other = [](std::size_t j, double t) { return Vec3(2.0 * wander(3 - j, 3.0 * t)); };
  Manifest manifest;
  manifest.spaces["kinect"].method = "fit";
  const auto take = align(
      two(points(joints, every(10 * ms, 300), wander), points(joints, every(10 * ms, 300), other)),
      manifest);
  REQUIRE(take);
  REQUIRE(take->report.findings.size() == 1);
  CHECK(take->report.findings[0].severity == Severity::warning);
  CHECK(take->report.spaces[0].after_m > 0.3);
}

TEST_CASE("samples in bursts are a warning, and rate_hz tells the true period") {
  std::vector<Time> stamps;  // three at once every 99 ms, as some radios deliver them
  for (std::int64_t k = 0; k < 100; ++k) {
    stamps.push_back(utc_time((k / 3) * 99 * ms + (k % 3) * ms));
  }
  const Recording recording =
      two(points(joints, every(10 * ms, 320), wander), points(joints, stamps, wander));
  const auto take = align(recording, {});
  REQUIRE(take);
  CHECK(take->report.streams[1].invalid > take->report.streams[1].samples / 2);
  REQUIRE(!take->report.findings.empty());
  CHECK(to_string(take->report.findings[0].what) ==
        "kinect: expected steps near their median of 1 ms, found a mean of 33 ms");
  Manifest manifest;
  manifest.streams.resize(1);
  manifest.streams[0].name = "kinect";
  manifest.streams[0].rate_hz = 30.0;
  const auto told = align(recording, manifest);
  REQUIRE(told);
  CHECK(told->report.streams[1].invalid == 0);
}

TEST_CASE("a stream without samples is refused with what its reader found wrong, if it did") {
  Recording recording =
      two(points(joints, every(10 * ms, 100), wander), points(joints, every(30 * ms, 0), wander));
  const auto refusal = [&recording] {
    const auto take = align(recording, {});
    return take ? "" : to_string(take.error());
  };
  CHECK(refusal() == "expected at least one sample for stream 'kinect', found none");
  recording.streams[1].files = {{"kinect.csv", "", 0}};
  CHECK(refusal() == "kinect.csv: expected at least one sample for stream 'kinect', found none");
  recording.streams[1].findings = {
      {Severity::error, Error{"k.csv", 0, "rows of body 3", "none"}, "the stream is empty", ""},
      {Severity::note, Error{"k.csv", 0, "less", "more"}, "", ""}};
  CHECK(refusal() == "k.csv: expected rows of body 3, found none");
}
