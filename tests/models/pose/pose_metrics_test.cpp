// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/pose_metrics.h"

#include "tests/models/pose/pose_people.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>

using namespace kinalign;

namespace {

struct Standing {
  PoseBody body = pose_body(test_offsets());
  std::vector<Turn> truth = std::vector<Turn>(6 * pose_bones.size(), Turn::Identity());
  std::vector<Turn> answer = truth;

  /// Turns a bone of the predicted pose about z in all frames.
  void turn(std::string_view bone, double degrees) {
    const auto b = static_cast<std::size_t>(std::find(pose_bones.begin(), pose_bones.end(), bone) -
                                            pose_bones.begin());
    const auto angle = static_cast<float>(degrees * std::numbers::pi / 180.0);
    for (std::size_t i = b; i < answer.size(); i += pose_bones.size()) {
      answer[i] = Eigen::AngleAxisf(angle, Eigen::Vector3f::UnitZ()).toRotationMatrix();
    }
  }
  PoseErrors errors() const {
    return pose_errors(body, answer, {truth, body.skeleton.rest_offsets}, 30.0);
  }
};

}  // namespace

TEST_CASE("the truth as an answer has no error, and its jitter is the truth's") {
  std::mt19937_64 random(1);
  Standing person;
  person.truth = person.answer = random_turns(6 * pose_bones.size(), random);
  const PoseErrors errors = person.errors();
  CHECK(errors.sip_deg == 0.0);
  CHECK(errors.angle_deg == 0.0);
  CHECK(errors.head_deg == 0.0);
  CHECK(errors.position_cm == 0.0);
  CHECK(errors.jitter_ratio() == 1.0);
  CHECK(errors.frames == 6);
}

TEST_CASE("a thigh counts for SIP and angle, a head for itself alone") {
  Standing person;
  person.turn("lfemur", 10.0);
  CHECK(person.errors().sip_deg == doctest::Approx(10.0 / 4).epsilon(1e-5));
  CHECK(person.errors().angle_deg == doctest::Approx(10.0 / 13).epsilon(1e-5));
  CHECK(person.errors().head_deg == 0.0);
  // Knee and ankle, two of 16 joints, move along a chord of 40 cm.
  const double chord = 2.0 * std::sin(5.0 * std::numbers::pi / 180.0) * 40.0;
  CHECK(person.errors().position_cm == doctest::Approx(2.0 * chord / 16).epsilon(1e-5));
  Standing other;
  other.turn("head", 30.0);
  CHECK(other.errors().head_deg == doctest::Approx(15.0).epsilon(1e-5));
  CHECK(other.errors().angle_deg == 0.0);
}

TEST_CASE("means join by their frames") {
  PoseErrors all{.sip_deg = 1.0, .frames = 1};
  all.add({.sip_deg = 4.0, .frames = 2});
  CHECK(all.sip_deg == doctest::Approx(3.0));
  CHECK(all.frames == 3);
  all.add({});
  CHECK(all.frames == 3);
}
