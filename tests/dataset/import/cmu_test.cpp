// SPDX-License-Identifier: Apache-2.0
// Real packs against the reference program: dataset_import_check.py.
#include "tests/folder.h"

#include "kinalign/dataset/import/cmu_clips.h"

#include <doctest/doctest.h>

using namespace kinalign;

TEST_CASE("a packed clip has its person's skeleton and stands where its differences add up to") {
  const std::string text =
      bytes_in(KINALIGN_SOURCE_DIR "/tests/data/fuzz/archive_fuzz/cmu_deflated.npz");
  const auto packed =
      PackedClips::read({"asf_00.npz", text.size(),
                         [&text](std::uint64_t at, std::span<char> to) -> Result<std::size_t> {
                           if (at >= text.size()) return std::size_t{0};
                           return text.copy(to.data(), to.size(), at);
                         }});
  REQUIRE(packed);
  REQUIRE(packed->clips().size() == 1);
  const PackedClip& clip = packed->clips().front();
  CHECK(clip.person == "02");
  CHECK(clip.take == "02_05");
  CHECK(clip.label == "walk");
  CHECK(packed->frame_seconds() == doctest::Approx(1.0 / 60).epsilon(1e-12));
  const Clip made = packed->clip(clip);
  CHECK(made.skeleton.joint_names == std::vector<std::string>{"hip", "knee"});
  CHECK(made.skeleton.end_sites.size() == 1);
  CHECK(made.frames.size() == 4);
  // All differences of this pack are 0: the root stays in place and no joint turns.
  CHECK(made.frames.local_positions[3 * 7 + 1] == -0.5);
  CHECK(made.frames.local_rotations[4 * 7] == 1.0);
}
