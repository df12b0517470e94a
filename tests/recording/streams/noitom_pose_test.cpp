// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/streams/noitom_pose.h"

#include "tests/protocols/noitom/noitom_cases.h"
#include "tests/recording/recorded_lab.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace kinalign;

namespace {

BvhHierarchy hierarchy_of(const std::string& text) {
  Findings findings;
  std::size_t rows = 0;
  auto hierarchy = parse_bvh_hierarchy(text, "walk.bvh", rows, findings);
  REQUIRE(hierarchy);
  return *hierarchy;
}

}  // namespace

TEST_CASE("noitom: a frame is the pose that its row in a BVH is") {
  for (const bool displacement : {false, true}) {
    for (const bool reference : {false, true}) {
      const auto frame = noitom_frame(NoitomForm::new_header, displacement, reference);
      std::string text = noitom_chain("Spine3", displacement);
      text.replace(text.find("Frames: 0"), 9, "Frames: 1");
      for (const float value : frame.row()) text += std::to_string(value) + " ";
      const auto file = read_bvh(text + "\n", "walk.bvh", {});
      REQUIRE(file);

      NoitomPoser poser(hierarchy_of(noitom_chain("Spine3", displacement)), {}, "walk.bvh");
      ClipFrames frames;
      REQUIRE(poser.append(frame, utc_time(77), frames));
      CHECK(frames.stamps == std::vector{utc_time(77)});
      CHECK(frames.local_positions == file->clip.frames.local_positions);
      CHECK(frames.local_rotations == file->clip.frames.local_rotations);
    }
  }
}

TEST_CASE("noitom: the root's place is in metres and its turn by the header's order") {
  auto frame = noitom_frame(NoitomForm::new_header, false, false);
  std::fill(frame.values.begin(), frame.values.end(), 0.0F);
  frame.values[1] = 93.25F;
  frame.values[3] = 90.0F;  // about y
  NoitomPoser poser(hierarchy_of(noitom_chain("Spine3", false)), {}, "walk.bvh");
  ClipFrames frames;
  REQUIRE(poser.append(frame, utc_time(0), frames));
  CHECK(frames.local_positions[1] == doctest::Approx(0.9325));
  CHECK(frames.local_rotations[2] == doctest::Approx(std::sqrt(0.5)));
}

TEST_CASE("noitom: frames that the header does not fit are refused with both hierarchies named") {
  NoitomPoser poser(hierarchy_of(noitom_chain("Neck", false)), {}, "walk.bvh");
  ClipFrames frames;
  const auto refused =
      poser.append(noitom_frame(NoitomForm::new_header, true, false), utc_time(0), frames);
  REQUIRE(!refused);
  CHECK(to_string(refused.error()) ==
        "walk.bvh: expected a header with the 354 channels of the frames that arrive; the stream "
        "does not say which of Noitom's two 59-joint hierarchies it follows, legacy (Axis Neuron: "
        "joint 10 is Spine3) or Studio (Axis Studio: joint 10 is Neck), found 59 joints with 180 "
        "channels, the Studio one");
  CHECK(frames.size() == 0);
}

TEST_CASE("noitom: a frame with a value that is no number is refused and leaves nothing") {
  NoitomPoser poser(hierarchy_of(noitom_chain("Neck", false)), {}, "walk.bvh");
  ClipFrames frames;
  auto frame = noitom_frame(NoitomForm::new_header, false, false);
  for (const float odd : {std::nanf(""), INFINITY, 1e16F}) {
    frame.values[3] = odd;
    CHECK(!poser.append(frame, utc_time(0), frames));
  }
  CHECK(frames.size() == 0);
}

TEST_CASE("noitom: a header of another skeleton is read with a warning") {
  CHECK(NoitomPoser(hierarchy_of(noitom_chain("Spine3", false)), {}, "w").findings().empty());
  CHECK(NoitomPoser(hierarchy_of(noitom_chain("Neck", false)), {}, "w").findings().empty());
  const NoitomPoser other(hierarchy_of(noitom_chain("j10", false)), {}, "w");
  REQUIRE(other.findings().size() == 1);
  CHECK(to_string(other.findings()[0].what) ==
        "w: expected the header of Axis Neuron or Axis Studio, found 59 joints in another order");
}
