// SPDX-License-Identifier: Apache-2.0
// The text that is written, block by block, from clips and from file to file.
#include "tests/folder.h"

#include "kinalign/formats/bvh/bvh.h"

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
  std::size_t largest = 0;  // size of a block
};

Copied copied(const std::string& path) {
  PosixFiles files;
  Copied out;
  auto done = copy_bvh(files, path, [&](std::string_view text) -> Result<void> {
    out.text += text;
    out.largest = std::max(out.largest, text.size());
    return {};
  });
  if (done) out.findings = *std::move(done);
  if (!done) out.error = to_string(done.error());
  return out;
}

}  // namespace

TEST_CASE("a BVH is copied in pieces, number by number") {
  const FreshFolder folder;
  std::string rows;
  constexpr int frames = 60'000;
  for (int i = 0; i < frames; ++i)
    rows += fmt::format("{} 90.50 -0.25 {:.2f} 720.5 0\n", i, 0.01 * i);
  const std::string text = head + fmt::format("MOTION\nFrames: {}\nFrame Time: 0.01\n", frames);
  const auto made = copied(folder.write("a.bvh", text + rows));
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
  CHECK(copied(folder.write("b.bvh", made.text)).text == made.text);
}

TEST_CASE("copying a BVH can be stopped in either pass") {
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
  const auto made = copied(folder.write("a.bvh", text));
  CHECK(made.error == "");
  REQUIRE(made.findings.size() == 2);
  CHECK(made.text.find("Frames: 1\n") != std::string::npos);
  CHECK(copied(folder.write("a.csv", "t,x\n1,2\n")).error ==
        (folder / "a.csv") +
            ":1: expected a BVH or a take (other files can't become a BVH), found "
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
