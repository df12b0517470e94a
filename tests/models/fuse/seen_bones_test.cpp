// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/fuse/seen_bones.h"

#include "tests/models/fuse/fuse_people.h"

#include <doctest/doctest.h>

#include <numbers>

using namespace kinalign;

namespace {

constexpr std::size_t at_frame = 12;

struct TurnedPose {
  FusePerson person = fuse_person(20);
  std::vector<SeenBone> bones = seen_bones(pose_body(test_offsets()), fuse_joint_names());
  // For one frame; each bone is turned away from the truth about an axis across it.
  std::vector<Turn> turns;

  explicit TurnedPose(float degrees) {
    const auto first =
        person.truth.rotations.begin() + static_cast<std::ptrdiff_t>(at_frame * pose_bones.size());
    turns.assign(first, first + static_cast<std::ptrdiff_t>(pose_bones.size()));
    for (const SeenBone& bone : bones) {
      const Eigen::Vector3f across = bone.axis.unitOrthogonal();
      const float angle = degrees * std::numbers::pi_v<float> / 180.0F;
      turns[bone.bone] = turns[bone.bone] * Turn(Eigen::AngleAxisf(angle, across));
    }
  }

  void turn() {
    turn_to_seen(bones, person.input.kinect, at_frame, person.truth.root[at_frame], turns);
  }

  /// The bone's angle from its true direction, degrees.
  float off(const SeenBone& bone) const {
    const Turn& truth = person.truth.rotations[at_frame * pose_bones.size() + bone.bone];
    const float cosine = (turns[bone.bone] * bone.axis).dot(truth * bone.axis);
    return std::acos(std::clamp(cosine, -1.0F, 1.0F)) * 180.0F / std::numbers::pi_v<float>;
  }
};

/// Whether a bone's direction is seen by itself. The seen directions of the trunk and the neck
/// are those of several bones together.
bool is_limb(const SeenBone& bone) {
  const std::string_view name = pose_bones[bone.bone];
  return name != "lowerback" && name != "thorax" && name != "upperneck";
}

}  // namespace

TEST_CASE("a bone that the Kinect tracks goes half the way to where it is seen") {
  for (const float degrees : {5.0F, 20.0F}) {
    TurnedPose pose(degrees);
    pose.turn();
    for (const SeenBone& bone : pose.bones) {
      if (is_limb(bone)) CHECK(pose.off(bone) == doctest::Approx(0.5F * degrees).epsilon(0.05));
    }
  }
}

TEST_CASE("a bone that is seen far away hardly moves, and one that is inferred stays") {
  TurnedPose far(120.0F);
  far.turn();
  for (const SeenBone& bone : far.bones) {
    if (is_limb(bone)) CHECK(far.off(bone) > 118.0F);
  }
  TurnedPose guessed(20.0F);
  std::fill(guessed.person.input.kinect.seen.begin(), guessed.person.input.kinect.seen.end(), 1);
  const std::vector<Turn> before = guessed.turns;
  guessed.turn();
  CHECK(guessed.turns == before);
}

TEST_CASE("turning towards what is seen keeps rotations") {
  TurnedPose pose(30.0F);
  pose.turn();
  for (const Turn& turn : pose.turns) {
    CHECK((turn * turn.transpose() - Turn::Identity()).norm() < 1e-5F);
    CHECK(turn.determinant() == doctest::Approx(1.0F));
  }
}
