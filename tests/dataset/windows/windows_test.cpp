// SPDX-License-Identifier: Apache-2.0
// Rows of a window compared with those of the take. NumPy reads the file itself in
// tests/apps/dataset_windows_check.py.
#include "tests/folder.h"
#include "tests/formats/take/take_samples.h"

#include "kinalign/dataset/windows/window_rows.h"
#include "kinalign/motion/arrays.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

/// A take on the disk. Its rotations have length 1, and cells of the Kinect that are not valid hold
/// zeros.
struct Stored {
  explicit Stored(std::size_t frames) : take(sample_take(frames)) {
    for (std::size_t i = 0; i < frames; ++i) {
      const auto step = static_cast<std::int64_t>(i) * 10'000'000;
      take.all.stamps[i] = utc_time(1'700'000'000'000'000'000 + step);
    }
    auto& clip = std::get<ClipRows>(take.all.rows[0]);
    for (std::size_t i = 0; i < clip.local_rotations.size() / 4; ++i) {
      put_quat(clip.local_rotations, i, quat(clip.local_rotations, i).normalized());
    }
    auto& points = std::get<PointRows>(take.all.rows[1]);
    for (std::size_t i = 0; i < points.valid.size(); ++i) {
      if (points.valid[i] == 0) vec3(points.positions, i).setZero();
    }
    auto writer = *TakeWriter::create(files, path, Overwrite::no, take.header);
    REQUIRE(writer.append(take.all));
    REQUIRE(writer.finish(take.report));
  }

  TakeSlab window(const WindowGrid& grid, std::size_t which) {
    TakeReader reader = *TakeReader::open(files, path);
    const auto places = place_windows(*reader.stamps(), grid).places;
    TakeSlab raw, out;
    REQUIRE(read_window(reader, places.at(which), grid, raw, out));
    return out;
  }

  FreshFolder folder;
  PosixFiles files;
  std::string path = folder / "t.h5";
  Take take;
};

const PointRows& kinect(const TakeSlab& slab) { return std::get<PointRows>(slab.rows[1]); }

template <class Value>
std::vector<Value> part(const std::vector<Value>& all, std::size_t from, std::size_t count) {
  const auto begin = all.begin() + static_cast<std::ptrdiff_t>(from);
  return {begin, begin + static_cast<std::ptrdiff_t>(count)};
}

}  // namespace

TEST_CASE("windows: at the take's own rate rows are the take's") {
  Stored stored(50);
  const TakeSlab window = stored.window({20, 10, 0.0}, 2);
  CHECK(window.stamps == part(stored.take.all.stamps, 20, 20));
  CHECK(kinect(window).positions == part(kinect(stored.take.all).positions, 20 * 6, 20 * 6));
  CHECK(kinect(window).state == part(kinect(stored.take.all).state, 20 * 2, 20 * 2));
  CHECK(kinect(window).distance.time_interval_ns ==
        part(kinect(stored.take.all).distance.time_interval_ns, 20, 20));
}

TEST_CASE("windows: half the rate has each second row, bit for bit") {
  Stored stored(50);
  const TakeSlab window = stored.window({10, 10, 50.0}, 1);
  for (std::size_t i = 0; i < 10; ++i) {
    CHECK(window.stamps[i] == stored.take.all.stamps[20 + 2 * i]);
    CHECK(part(kinect(window).positions, 6 * i, 6) ==
          part(kinect(stored.take.all).positions, 6 * (20 + 2 * i), 6));
  }
}

TEST_CASE(
    "windows: between two rows vectors lie on the line, rotations on the arc, and both count") {
  Stored stored(50);
  const TakeSlab window = stored.window({10, 10, 200.0}, 0);  // each second row is half-way
  const auto& all = stored.take.all;
  for (std::size_t i = 1; i < 10; i += 2) {
    const std::size_t before = i / 2;
    for (std::size_t j = 0; j < 2; ++j) {
      const std::size_t a = 2 * before + j, b = a + 2, at = 2 * i + j;
      const bool valid = kinect(all).valid[a] == 1 && kinect(all).valid[b] == 1;
      CHECK(kinect(window).valid[at] == (valid ? 1 : 0));
      CHECK(kinect(window).state[at] == std::min(kinect(all).state[a], kinect(all).state[b]));
      const Vec3 middle = 0.5 * (vec3(kinect(all).positions, a) + vec3(kinect(all).positions, b));
      const Vec3 wanted = valid ? middle : Vec3::Zero();
      CHECK((vec3(kinect(window).positions, at) - wanted).norm() < 1e-6);
    }
    const auto& from = kinect(all).distance.nearest_raw_ns;
    CHECK(kinect(window).distance.nearest_raw_ns[i] == std::max(from[before], from[before + 1]));
    const auto& turned = std::get<ClipRows>(all.rows[0]).local_rotations;
    const Quat a = quat(turned, 3 * before), b = quat(turned, 3 * (before + 1));
    const Quat half = quat(std::get<ClipRows>(window.rows[0]).local_rotations, 3 * i);
    CHECK(half.norm() == doctest::Approx(1.0).epsilon(1e-6));
    CHECK(half.angularDistance(a) == doctest::Approx(0.5 * a.angularDistance(b)).epsilon(1e-4));
  }
}

TEST_CASE("windows: a short one repeats its last row, which is not valid there") {
  Stored stored(12);
  const TakeSlab window = stored.window({20, 10, 0.0}, 0);
  REQUIRE(window.stamps.size() == 20);
  CHECK(window.stamps.back() == stored.take.all.stamps.back());
  const auto& clip = std::get<ClipRows>(window.rows[0]);
  CHECK(part(clip.valid, 0, 12) == std::vector<std::uint8_t>(12, 1));
  CHECK(part(clip.valid, 12, 8) == std::vector<std::uint8_t>(8, 0));
  CHECK(part(kinect(window).positions, 19 * 6, 6) == part(kinect(window).positions, 11 * 6, 6));
  CHECK(part(kinect(window).valid, 24, 16) == std::vector<std::uint8_t>(16, 0));
  CHECK(valid_share(window, 0, 12) == 1.0);
}

TEST_CASE("a take's reader gives any window, and refuses one that reaches beyond the end") {
  Stored stored(50);
  TakeReader reader = *TakeReader::open(stored.files, stored.path);
  TakeSlab slab;
  CHECK(reader.read(30, 20, slab));
  CHECK(slab.stamps == part(stored.take.all.stamps, 30, 20));
  CHECK(reader.read(50, 0, slab));
  CHECK(to_string(reader.read(31, 20, slab).error()) ==
        stored.path + ": expected rows 31 to 51, found 50 rows");
  // next() continues where it was.
  REQUIRE(*reader.next(slab));
  CHECK(slab.first == 0);
}
