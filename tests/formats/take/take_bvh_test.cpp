// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/take/take_bvh.h"

#include "tests/folder.h"

#include "kinalign/formats/take/take_hdf5.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

struct Converted {
  std::string text, error;
  Findings findings;
};

Converted converted(const std::string& path) {
  PosixFiles files;
  Converted out;
  auto done = take_to_bvh(files, path, [&](std::string_view text) -> Result<void> {
    out.text += text;
    return {};
  });
  if (done) out.findings = *std::move(done);
  if (!done) out.error = to_string(done.error());
  return out;
}

/// Two joints, of which the second moves. Row i is valid if `valid[i]` is set; steps of `steps` ns.
Take take_of(const std::vector<std::uint8_t>& valid, const std::vector<std::int64_t>& steps) {
  Take take;
  take.header.frames = valid.size();
  const Skeleton skeleton{{"a", "b"}, {-1, 0}, {Vec3(0, 1, 0), Vec3(0, 0.5, 0)}, {}};
  take.header.groups = {{"mocap", ClipGroup{skeleton}, true, false, {}},
                        {"suit", ClipGroup{skeleton}, true, false, {}}};
  take.header.parameters.align.store_double = true;
  ClipRows rows;
  std::int64_t at = 0;
  for (std::size_t t = 0; t < valid.size(); ++t) {
    const double x = valid[t] != 0 ? static_cast<double>(t) : 0.0;
    const double w = valid[t] != 0 ? 1.0 : 0.0;
    take.all.stamps.push_back(utc_time(at));
    at += steps[t % steps.size()];
    for (const double value : {x, w, 0.0, 0.0, 0.5 * w + 0.01 * x, 0.0}) {
      rows.local_positions.push_back(value);
    }
    for (int j = 0; j < 2; ++j) {
      for (const double value : {w, 0.0, 0.0, 0.0}) rows.local_rotations.push_back(value);
    }
    rows.distance.nearest_raw_ns.push_back(0);
  }
  rows.positions = rows.local_positions;
  rows.valid = valid;
  take.all.rows = {rows, rows};
  return take;
}

std::string written(const FreshFolder& folder, const Take& take) {
  PosixFiles files;
  auto writer = TakeWriter::create(files, folder / "take.h5", Overwrite::yes, take.header);
  REQUIRE(writer);
  REQUIRE(writer->append(take.all));
  REQUIRE(writer->finish(take.report));
  return folder / "take.h5";
}

}  // namespace

TEST_CASE("invalid rows of a take have the last valid pose, with a finding") {
  const FreshFolder folder;
  std::vector<std::uint8_t> valid(9000, 1);  // more than two slabs
  for (const std::size_t gap : {0, 1, 4095, 4096, 8999}) valid[gap] = 0;
  const auto made = converted(written(folder, take_of(valid, {10'000'000})));
  CHECK(made.error == "");
  const auto back = read_bvh(made.text, "back.bvh", {});
  REQUIRE(back);
  CHECK(back->clip.frames.size() == 9000);
  CHECK(back->hierarchy.frame_seconds == 0.01);
  const auto x = [&](std::size_t t) { return back->clip.frames.local_positions[t * 6]; };
  CHECK(x(0) == doctest::Approx(2));
  CHECK(x(1) == doctest::Approx(2));
  CHECK(x(4096) == doctest::Approx(4094));
  CHECK(x(4097) == doctest::Approx(4097));
  CHECK(x(8999) == doctest::Approx(8998));
  REQUIRE(made.findings.size() == 2);
  CHECK(made.findings[0].severity == Severity::note);
  CHECK(made.findings[0].what.found == "mocap, suit");
  CHECK(made.findings[0].meaning == "mocap was written");
  CHECK(made.findings[1].what.expected == "valid rows of mocap");
  CHECK(made.findings[1].what.found == "5 of 9000 rows that are not valid");
}

TEST_CASE("a take without valid rows gives no BVH") {
  const FreshFolder folder;
  const std::string path = written(folder, take_of({0, 0}, {10}));
  CHECK(converted(path).error == path + ": expected a valid row of mocap, found none");
}

TEST_CASE("a take without a skeleton, or with huge positions, gives no BVH") {
  const FreshFolder folder;
  Take points = take_of({1, 1}, {10'000'000});
  points.header.groups = {{"kinect", PointGroup{{"Head"}}, false, false, {}}};
  points.all.rows = {
      PointRows{std::vector<double>(6, 1.0), {Tracking::tracked, Tracking::tracked}, {1, 1}, {}}};
  CHECK(converted(written(folder, points)).error ==
        (folder / "take.h5") + ": expected a take with a skeleton, found none");
  Take far = take_of({1, 1}, {10'000'000});
  std::get<ClipRows>(far.all.rows[0]).local_positions[7] = -1e12;
  CHECK(converted(written(folder, far)).error ==
        (folder / "take.h5") + ": expected positions below 1e12 m, found larger positions");
}

TEST_CASE("the first of several skeletons is written, and a note names the format for all") {
  const FreshFolder folder;
  const auto made = converted(written(folder, take_of({1, 1, 1}, {10'000'000})));
  REQUIRE(made.findings.size() == 1);
  CHECK(made.findings[0].severity == Severity::note);
  CHECK(to_string(made.findings[0].what) ==
        (folder / "take.h5") + ": expected one skeleton, found mocap, suit");
  CHECK(made.findings[0].meaning == "mocap was written");
  CHECK(made.findings[0].repair == "convert to .npz to keep all of them");
}

TEST_CASE("stamps that no fixed step has are a finding") {
  const FreshFolder folder;
  const auto made = converted(written(folder, take_of({1, 1, 1, 1, 1}, {30'000'000, 36'000'000})));
  REQUIRE(made.findings.size() == 2);
  CHECK(made.findings[1].what.found == "steps of 30 to 36 ms");
  CHECK(made.findings[1].meaning == "the frame time is the mean step, 33 ms");
}
