// SPDX-License-Identifier: Apache-2.0
// From file to file in pieces.
#include "kinalign/formats/bvh/copy.h"

#include "tests/folder.h"

#include "kinalign/formats/bvh/write.h"
#include "kinalign/formats/take/take_hdf5.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

using namespace kinalign;

namespace {

const std::string head =
    "HIERARCHY\nROOT Hips\n{\n\tOFFSET 0 90.5 0\n"
    "\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n}\n";

struct Copied {
  std::string text, error;
  Findings findings;
  std::size_t largest = 0;  // piece
};

using Copy = std::function<Result<Findings>(FileSystem&, const std::string&, const TextSink&)>;

Copied copied(const std::string& path, const Copy& copy) {
  PosixFiles files;
  Copied out;
  auto done = copy(files, path, [&](std::string_view text) -> Result<void> {
    out.text += text;
    out.largest = std::max(out.largest, text.size());
    return {};
  });
  if (done) out.findings = *std::move(done);
  if (!done) out.error = to_string(done.error());
  return out;
}

const Copy copy = [](FileSystem& files, const std::string& from, const TextSink& sink) {
  return copy_bvh(files, from, sink);
};

/// Two joints; the second moves. Row i is valid where `valid[i]`; steps of `steps` ns.
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

TEST_CASE("a BVH is copied in pieces, number by number") {
  const FreshFolder folder;
  std::string rows;
  constexpr int frames = 60'000;
  for (int i = 0; i < frames; ++i)
    rows += fmt::format("{} 90.50 -0.25 {:.2f} 720.5 0\n", i, 0.01 * i);
  const std::string text = head + fmt::format("MOTION\nFrames: {}\nFrame Time: 0.01\n", frames);
  const auto made = copied(folder.write("a.bvh", text + rows), copy);
  CHECK(made.error == "");
  CHECK(made.findings.empty());
  CHECK(made.largest < (std::size_t{512} << 10));
  CHECK(made.text.size() > made.largest);
  const auto first = read_bvh(text + rows, "a", {});
  const auto second = read_bvh(made.text, "b", {});
  REQUIRE((first && second));
  CHECK(first->values == second->values);
  CHECK(second->decimals == 2);
  CHECK(second->findings.empty());
  CHECK(copied(folder.write("b.bvh", made.text), copy).text == made.text);
}

TEST_CASE("copying a BVH stops when it is told to, in either pass") {
  const FreshFolder folder;
  const std::string path = folder.write("a.bvh", head + "MOTION\nFrames: 0\nFrame Time: 0.01\n");
  PosixFiles files;
  for (const std::string_view pass : {"reading", "writing"}) {
    const auto stop = [&](std::string_view what, std::uint64_t, std::uint64_t) {
      return what != pass;
    };
    const auto sink = [](std::string_view) -> Result<void> { return {}; };
    const auto done = copy_bvh(files, path, sink, stop);
    REQUIRE_FALSE(done);
    CHECK(to_string(done.error()) == to_string(interruption(path)));
  }
}

TEST_CASE("a BVH that lost its end is copied with the frames that are there, and says so") {
  const FreshFolder folder;
  const std::string text = head + "MOTION\nFrames: 3\nFrame Time: 0.01\n1 2 3 4 5 6\n1 2 3\n";
  const auto made = copied(folder.write("a.bvh", text), copy);
  CHECK(made.error == "");
  REQUIRE(made.findings.size() == 2);
  CHECK(made.text.find("Frames: 1\n") != std::string::npos);
  CHECK(copied(folder.write("a.csv", "t,x\n1,2\n"), copy).error ==
        (folder / "a.csv") +
            ":1: expected a BVH or a take, which alone can become a BVH, found "
            "'t,x'");
}

TEST_CASE("a BVH writer wants the frames it was promised") {
  BvhHierarchy hierarchy;
  const auto read = read_bvh(head + "MOTION\nFrames: 0\nFrame Time: 0.01\n", "a", {});
  REQUIRE(read);
  BvhWriter writer(read->hierarchy, 2, 3, [](std::string_view) -> Result<void> { return {}; });
  REQUIRE(writer.append(std::vector<double>(6)));
  CHECK(to_string(writer.finish().error()) == "expected 2 frames to write, found 1");
}

TEST_CASE("of a take, rows that are not valid hold the last valid pose, with a finding") {
  const FreshFolder folder;
  std::vector<std::uint8_t> valid(9000, 1);  // more than two slabs
  for (const std::size_t gap : {0, 1, 4095, 4096, 8999}) valid[gap] = 0;
  const auto made = copied(written(folder, take_of(valid, {10'000'000})), take_to_bvh);
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
  CHECK(made.findings[1].what.found == "5 of 9000 that are not");
}

TEST_CASE("of a take whose rows are all invalid no BVH is made") {
  const FreshFolder folder;
  const std::string path = written(folder, take_of({0, 0}, {10}));
  CHECK(copied(path, take_to_bvh).error == path + ": expected a valid row of mocap, found none");
}

TEST_CASE("of a take that holds no skeleton's stream, or places beyond measure, no BVH is made") {
  const FreshFolder folder;
  Take points = take_of({1, 1}, {10'000'000});
  points.header.groups = {{"kinect", PointGroup{{"Head"}}, false, false, {}}};
  points.all.rows = {
      PointRows{std::vector<double>(6, 1.0), {Tracking::tracked, Tracking::tracked}, {1, 1}, {}}};
  CHECK(copied(written(folder, points), take_to_bvh).error ==
        (folder / "take.h5") + ": expected a take with a skeleton's stream, found none");
  Take far = take_of({1, 1}, {10'000'000});
  std::get<ClipRows>(far.all.rows[0]).local_positions[7] = -1e12;
  CHECK(copied(written(folder, far), take_to_bvh).error ==
        (folder / "take.h5") + ": expected positions below 1e12 m, found larger ones");
}

TEST_CASE("of several skeletons the first is written, and the note says what holds them all") {
  const FreshFolder folder;
  const auto made = copied(written(folder, take_of({1, 1, 1}, {10'000'000})), take_to_bvh);
  REQUIRE(made.findings.size() == 1);
  CHECK(made.findings[0].severity == Severity::note);
  CHECK(to_string(made.findings[0].what) ==
        (folder / "take.h5") + ": expected one skeleton's stream, found mocap, suit");
  CHECK(made.findings[0].meaning == "mocap was written");
  CHECK(made.findings[0].repair == "convert to .npz holds them all");
}

TEST_CASE("stamps that no fixed step has are a finding") {
  const FreshFolder folder;
  const auto made =
      copied(written(folder, take_of({1, 1, 1, 1, 1}, {30'000'000, 36'000'000})), take_to_bvh);
  REQUIRE(made.findings.size() == 2);
  CHECK(made.findings[1].what.found == "steps of 30 to 36 ms");
  CHECK(made.findings[1].meaning == "the frame time is their mean, 33 ms");
}

TEST_CASE("joints that do not stand nested are written nested") {
  Clip clip;
  clip.skeleton = {{"a", "b", "c", "d"},
                   {-1, 0, 0, 1},
                   {Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0)},
                   {{3, Vec3(0, 0, 1)}}};
  clip.frames.stamps = {Time{}};
  for (const Vec3& at : clip.skeleton.rest_offsets) {
    for (int k = 0; k < 3; ++k) clip.frames.local_positions.push_back(at[k]);
  }
  for (int j = 0; j < 4; ++j) {
    const double half = 0.05 * j;
    for (const double part : {std::cos(half), std::sin(half), 0.0, 0.0}) {
      clip.frames.local_rotations.push_back(part);
    }
  }
  std::string text;
  REQUIRE(write_bvh(bvh_from_clip(clip, 0.01), [&text](std::string_view piece) -> Result<void> {
    text += piece;
    return {};
  }));
  const auto back = read_bvh(text, "back.bvh", {});
  REQUIRE_MESSAGE(back, text);
  const Skeleton& skeleton = back->clip.skeleton;
  CHECK(skeleton.joint_names == std::vector<std::string>{"a", "b", "d", "c"});
  CHECK(skeleton.parents == std::vector<int>{-1, 0, 1, 0});
  CHECK(skeleton.end_sites[0].parent == 2);
  CHECK(quat(back->clip.frames.local_rotations, 2).x() == doctest::Approx(std::sin(0.15)));
}
