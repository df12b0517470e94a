// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/pose/pose_data.h"

#include "tests/models/pose/pose_people.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace kinalign;

namespace {

constexpr double turn_rate = 1.5;  // rad/s

/// A person in a T-pose who turns about the vertical, 2 s at 60 Hz.
Windows turning_person(const std::string& part = "train") {
  const PoseBody body = pose_body(test_offsets());
  const std::size_t joints = body.skeleton.joints(), rows = 120;
  Windows out;
  out.facts.rate_hz = 60.0;
  out.facts.parts = {"train", "validation", "test"};
  out.facts.takes = {{"turn", "07", "turn"}};
  out.facts.streams = {{"mocap", "skeleton", body.skeleton.joint_names, body.skeleton.parents}};
  Stretch stretch{.take = 0, .part = 0, .rows = rows, .streams = {}};
  stretch.part = part == "train" ? 0 : part == "validation" ? 1 : 2;
  auto& arrays = stretch.streams["mocap"].arrays;
  for (std::size_t t = 0; t < rows; ++t) {
    const double angle = turn_rate * static_cast<double>(t) / 60.0;
    const Quat root(Eigen::AngleAxisd(angle, Vec3::UnitY()));
    std::vector<Vec3> places{Vec3(0.0, 0.9, 0.0)};
    for (std::size_t j = 0; j < joints; ++j) {
      if (j > 0) {
        places.push_back(places[static_cast<std::size_t>(body.skeleton.parents[j])] +
                         root * body.skeleton.rest_offsets[j]);
      }
      const Quat local = j == 0 ? root : Quat::Identity();
      for (const double value : {local.w(), local.x(), local.y(), local.z()}) {
        arrays["local_rotations"].push_back(static_cast<float>(value));
      }
      for (const double value : places[j]) arrays["positions"].push_back(static_cast<float>(value));
    }
  }
  out.stretches.push_back(stretch);
  for (const Vec3& offset : body.skeleton.rest_offsets) {
    for (const double value : offset) {
      out.rest_offsets["mocap"].push_back(static_cast<float>(value));
    }
  }
  return out;
}

std::string refusal(const Windows& windows, const std::vector<std::string>& nodes) {
  const auto data = pose_data(windows, "mocap", nodes);
  return data ? "none" : to_string(data.error());
}

}  // namespace

TEST_CASE("nodes on a turning person show the turn and its centripetal acceleration") {
  const auto data = pose_data(turning_person(), "mocap", usual_pose_nodes());
  REQUIRE(data);
  REQUIRE(data->learnt.size() == 1);
  const PoseSequence& one = data->learnt[0];
  CHECK(one.subject == "07");
  CHECK(one.frames() == 56);  // 120 rows without four at each end, every second one
  for (const Turn& turn : one.rotations) CHECK((turn - Turn::Identity()).norm() < 1e-5F);
  // Wrist nodes are 0.67 m off the axis: clavicle, arm, forearm and 0.6 of its lower part.
  const double radius = 0.02 + 0.16 + 0.28 + 0.13 + 0.6 * 0.13;
  // Second differences over 8/60 s keep sin^2(x)/x^2 of the motion, x = turn_rate 2/60.
  const double x = turn_rate * 2.0 / 60.0, passed = std::pow(std::sin(x) / x, 2);
  const double expected = turn_rate * turn_rate * radius * passed;
  for (std::size_t t = 0; t < one.frames(); ++t) {
    const Eigen::Map<const Eigen::Vector3f> a(&one.nodes.acceleration[15 * t]);
    CHECK(static_cast<double>(a.norm()) == doctest::Approx(expected).epsilon(1e-3));
    for (std::size_t n = 0; n < 5; ++n) {
      const Eigen::Map<const Eigen::Vector3f> w(&one.nodes.angular_velocity[15 * t + 3 * n]);
      CHECK((w - Eigen::Vector3f(0, static_cast<float>(turn_rate), 0)).norm() < 1e-3F);
    }
  }
}

TEST_CASE("parts of the split keep apart") {
  CHECK(refusal(turning_person("test"), usual_pose_nodes()) ==
        "expected stretches of 1.5 s to learn from, of people who stand upright, found none");
  Windows both = turning_person();
  both.stretches.push_back(turning_person("validation").stretches[0]);
  both.stretches.push_back(turning_person("test").stretches[0]);
  const auto data = pose_data(both, "mocap", usual_pose_nodes());
  REQUIRE(data);
  CHECK(data->judged.size() == 1);
  CHECK(data->tested.size() == 1);
}

TEST_CASE("what does not fit is refused by name") {
  CHECK(refusal(turning_person(), {"wrist_left", "knee", "waist"}) ==
        "expected nodes among wrist_left, wrist_right, ankle_left, ankle_right, head, waist, "
        "found knee");
  CHECK(refusal(turning_person(), {"waist", "wrist_left", "wrist_right"}) ==
        "expected the node waist as the last one, found wrist_right");
  Windows other = turning_person();
  other.facts.streams[0].names[7] = "foot";
  CHECK(refusal(other, usual_pose_nodes()) ==
        "expected a skeleton with the joints of a suit (LeftUpLeg) or of CMU (lfemur), found no "
        "joint rfoot");
  other = turning_person();
  other.facts.rate_hz = 50.0;
  CHECK(refusal(other, usual_pose_nodes()).starts_with("expected a multiple of 30 Hz"));
  other = turning_person();
  other.stretches[0].streams["mocap"].arrays.erase("local_rotations");
  CHECK(refusal(other, usual_pose_nodes()) ==
        "expected positions and local_rotations of mocap, found none");
}

TEST_CASE("a person who never stands upright is left out") {
  Windows lying = turning_person();
  auto& arrays = lying.stretches[0].streams["mocap"].arrays;
  for (std::size_t at = 0; at < arrays["positions"].size(); at += 3) {
    std::swap(arrays["positions"][at], arrays["positions"][at + 1]);
  }
  Windows both = turning_person();
  lying.stretches[0].take = 1;
  both.stretches.push_back(lying.stretches[0]);
  both.facts.takes.push_back({"lie", "golf", "lie"});
  auto& offsets = both.rest_offsets["mocap"];
  offsets.insert(offsets.end(), offsets.begin(), offsets.begin() + 81);
  const auto data = pose_data(both, "mocap", usual_pose_nodes());
  REQUIRE(data);
  CHECK(data->learnt.size() == 1);
  CHECK(data->left_out == std::vector<std::string>{"golf"});
}
