// SPDX-License-Identifier: Apache-2.0
// Signs of rotations in a take: from row to row they never jump, whatever the devices wrote.
#include "kinalign/align/rotation_signs.h"

#include "tests/align/streams.h"
#include "tests/align/two_streams.h"

#include "kinalign/align/align.h"

#include <doctest/doctest.h>

using namespace kinalign;
using namespace kinalign::test;

namespace {

/// About three turns a second round a leaning axis; each odd sample has the other sign.
Quat turning(std::size_t column, double t) {
  const Vec3 axis = Vec3(1.0, static_cast<double>(column), 0.5).normalized();
  return Quat(Eigen::AngleAxisd(20.0 * t, axis));
}
void flip_odd(std::vector<double>& rotations, std::size_t columns) {
  for (std::size_t i = 0; i < rotations.size() / 4; ++i) {
    if (i / columns % 2 == 1) put_quat(rotations, i, Quat(-quat(rotations, i).coeffs()));
  }
}

/// Neighbouring valid rows of a column, with or without gaps between them.
struct Neighbouring {
  std::size_t pairs = 0, gaps = 0;
  double least_dot = 1.0;
};
Neighbouring neighbouring(const std::vector<double>& rotations, std::size_t columns,
                          const std::vector<std::uint8_t>& valid) {
  Neighbouring out;
  for (std::size_t c = 0; c < columns; ++c) {
    std::optional<std::size_t> last;
    for (std::size_t i = c; i < rotations.size() / 4; i += columns) {
      const bool by_row = valid.size() < rotations.size() / 4;
      if (!valid.empty() && valid[by_row ? i / columns : i] == 0) continue;
      if (last) {
        ++out.pairs;
        out.gaps += i - *last > columns ? 1 : 0;
        out.least_dot = std::min(out.least_dot, quat(rotations, i).dot(quat(rotations, *last)));
      }
      last = i;
    }
  }
  return out;
}

Take aligned(Recording recording) {
  const auto take = align(recording, {});
  REQUIRE_MESSAGE(take, (take ? "" : to_string(take.error())));
  return *take;
}

Clip turning_clip(const std::vector<Time>& stamps) {
  Clip clip;
  clip.skeleton = {{"Hips", "Leg"}, {-1, 0}, {Vec3::Zero(), Vec3(0, -0.5, 0)}, {}};
  clip.frames.stamps = stamps;
  for (const Time stamp : stamps) {
    for (std::size_t j = 0; j < 2; ++j) {
      for (const double x : {0.0, -0.5, 0.0}) clip.frames.local_positions.push_back(x);
      const Quat q = turning(j, 1e-9 * static_cast<double>(to_ns(stamp)));
      for (const double part : {q.w(), q.x(), q.y(), q.z()}) {
        clip.frames.local_rotations.push_back(part);
      }
    }
  }
  flip_odd(clip.frames.local_rotations, 2);
  return clip;
}

/// Stamps without those of one second in the middle.
std::vector<Time> with_a_gap(std::int64_t step_ns, std::size_t count) {
  std::vector<Time> stamps = every(step_ns, count);
  const std::int64_t middle = step_ns * static_cast<std::int64_t>(count) / 2;
  std::erase_if(stamps, [middle](Time t) { return std::abs(to_ns(t) - middle) < 500 * ms; });
  return stamps;
}

}  // namespace

TEST_CASE("nodes' orientations keep their sign from row to row, over gaps and slabs") {
  ImuStream imu = nodes({"waist", "wrist"}, with_a_gap(20 * ms, 1500), turning);
  flip_odd(imu.samples.orientation, 2);
  Recording recording;
  recording.streams = {recorded("optical", points({"a"}, every(10 * ms, 3000), wander)),
                       recorded("imu", imu)};
  const Take take = aligned(recording);
  const auto& rows = std::get<ImuRows>(take.all.rows[1]);
  const Neighbouring found = neighbouring(rows.orientation, 2, rows.valid);
  CHECK(found.pairs > 5000);
  CHECK(found.gaps == 2);
  CHECK(found.least_dot >= 0.0);
  for (std::size_t r = 0; r < take.all.stamps.size(); ++r) {
    if (rows.valid[2 * r] == 0) continue;
    const double t = 1e-9 * static_cast<double>(to_ns(take.all.stamps[r]));
    REQUIRE(quat(rows.orientation, 2 * r).angularDistance(turning(0, t)) < 0.01);
  }
}

TEST_CASE("skeletons' rotations keep their sign, as the reference and resampled") {
  Recording recording;
  recording.streams = {recorded("optical", points({"a"}, every(10 * ms, 3000), wander)),
                       recorded("mocap", turning_clip(with_a_gap(20 * ms, 1500)))};
  const Take resampled = aligned(recording);
  const auto& rows = std::get<ClipRows>(resampled.all.rows[1]);
  const Neighbouring found = neighbouring(rows.local_rotations, 2, rows.valid);
  CHECK(found.pairs > 5000);
  CHECK(found.gaps == 2);
  CHECK(found.least_dot >= 0.0);

  recording.streams = {recorded("mocap", turning_clip(every(10 * ms, 3000)))};
  const Take own = aligned(recording);
  const auto& own_rows = std::get<ClipRows>(own.all.rows[0]);
  const Neighbouring of_reference = neighbouring(own_rows.local_rotations, 2, own_rows.valid);
  CHECK(of_reference.pairs == 2 * 2999);
  CHECK(of_reference.least_dot >= 0.0);
}

TEST_CASE("rows that are not valid stay zero and turn none") {
  std::vector<double> rotations{0, 1, 0, 0, 0, 0, 0, 0, 0, -1, 0, 0};
  RotationSigns signs(1);
  signs.align(rotations, std::vector<std::uint8_t>{1, 0, 1});
  CHECK(rotations == std::vector<double>{0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0});
  std::vector<double> next{0, -1, 0, 0};
  signs.align(next, {});
  CHECK(next == std::vector<double>{0, 1, 0, 0});
}
