// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/person/built_in_motion.h"

#include "tests/motion/rotations.h"
#include "tests/seeds.h"

#include "kinalign/motion/rotation.h"
#include "kinalign/simulate/person/built_in_body.h"

#include <doctest/doctest.h>

#include <array>
#include <limits>
#include <string>

using namespace kinalign;

namespace {

constexpr std::array all_pieces{
    Piece::t_pose,    Piece::stand,       Piece::step,       Piece::walk,
    Piece::walk_turn, Piece::wave,        Piece::bend,       Piece::turn,
    Piece::squat,     Piece::raise_front, Piece::raise_side, Piece::push,
    Piece::push_both, Piece::bend_side,   Piece::twist,      Piece::deep_squat};
static_assert(all_pieces.size() == piece_names.size());

Motion motion_with(Piece piece, std::uint64_t seed, double height_m = 1.75) {
  auto motion =
      built_in_motion({.height_m = height_m,
                       .programme = {{Piece::t_pose, 2.5}, {piece, 14.0}, {Piece::stand, 1.5}},
                       .seed = seed});
  REQUIRE(motion);
  return *std::move(motion);
}

GlobalPose global_at(const Motion& motion, double t) {
  Pose pose;
  GlobalPose global;
  motion.pose_at(t, pose);
  forward_kinematics(motion.skeleton, pose, global);
  return global;
}

Quat local_at(const Motion& motion, double t, NeuronJoint joint) {
  Pose pose;
  motion.pose_at(t, pose);
  return pose.local_rotations[index(joint)];
}

/// The angle of the body about +y, measured from facing +z, rad.
double yaw_at(const Motion& motion, double t) {
  const Vec3 front = global_at(motion, t).rotations[0] * Vec3::UnitZ();
  return std::atan2(front.x(), front.z());
}

Vec3 toes_at(const Motion& motion, const GlobalPose& pose, std::size_t side) {
  const EndSite& end = motion.skeleton.end_sites[side];  // 0 right, 1 left
  const auto foot = static_cast<std::size_t>(end.parent);
  return pose.positions[foot] + pose.rotations[foot] * end.offset;
}

/// The largest n-th difference over h^n of all joints' positions.
double roughest(const Motion& motion, int order, double h) {
  double worst = 0.0;
  for (double t = 0.0; t < motion.length_s; t += 0.0101) {
    std::vector<Vec3> sum(motion.skeleton.joints(), Vec3::Zero());
    double binomial = 1.0;
    for (int k = 0; k <= order; ++k) {
      const GlobalPose pose = global_at(motion, t + k * h);
      for (std::size_t j = 0; j < sum.size(); ++j) {
        sum[j] += (k % 2 == 0 ? binomial : -binomial) * pose.positions[j];
      }
      binomial = binomial * (order - k) / (k + 1);
    }
    for (const Vec3& x : sum) worst = std::max(worst, x.norm() / std::pow(h, order));
  }
  return worst;
}

struct Extremes {
  double rate = 0.0, shank_rate = 0.0, speed = 0.0, acceleration = 0.0;
};

Extremes extremes(const Motion& motion) {
  constexpr double h = 0.003;
  Extremes worst;
  for (double t = 0.0; t < motion.length_s; t += 0.008) {
    std::array<Pose, 3> pose;
    std::array<GlobalPose, 3> global;
    for (std::size_t k = 0; k < 3; ++k) {
      motion.pose_at(t + (static_cast<double>(k) - 1.0) * h, pose[k]);
      forward_kinematics(motion.skeleton, pose[k], global[k]);
    }
    for (std::size_t j = 0; j < motion.skeleton.joints(); ++j) {
      const auto& p0 = global[0].positions[j];
      const auto& p1 = global[1].positions[j];
      const auto& p2 = global[2].positions[j];
      worst.rate =
          std::max(worst.rate,
                   angle_between(pose[0].local_rotations[j], pose[2].local_rotations[j]) / (2 * h));
      worst.speed = std::max(worst.speed, (p2 - p0).norm() / (2 * h));
      worst.acceleration = std::max(worst.acceleration, (p2 - 2 * p1 + p0).norm() / (h * h));
    }
    for (const auto shank : {NeuronJoint::left_leg, NeuronJoint::right_leg}) {
      const double turned =
          angle_between(global[0].rotations[index(shank)], global[2].rotations[index(shank)]);
      worst.shank_rate = std::max(worst.shank_rate, turned / (2 * h));
    }
  }
  return worst;
}

}  // namespace

TEST_CASE("no acceleration jumps, nor does its slope, in any piece or between two") {
  for (const Piece piece : all_pieces) {
    CAPTURE(to_string(piece));
    const Motion motion = motion_with(piece, 11);
    // If the third derivative jumped, fourth differences would be twice as large at half the step.
    CHECK(roughest(motion, 4, 0.003) < 1.3 * roughest(motion, 4, 0.006));
  }
}

TEST_CASE("joints move as fast as people's do and no faster") {
  for (const Piece piece : all_pieces) {
    CAPTURE(to_string(piece));
    const Extremes worst = extremes(motion_with(piece, 5));
    CHECK(worst.rate < 9.0);           // rad/s, 515 deg/s
    CHECK(worst.shank_rate < 7.0);     // rad/s
    CHECK(worst.speed < 5.0);          // m/s
    CHECK(worst.acceleration < 70.0);  // m/s2
  }
  const Extremes walk = extremes(motion_with(Piece::walk, 5));
  CHECK(walk.shank_rate > 3.5);  // 200 deg/s
  CHECK(walk.speed > 2.0);       // speed of a swinging foot, m/s
}

TEST_CASE("a foot that is down does not slide, and none is below the floor") {
  for (const Piece piece : all_pieces) {
    for (const std::uint64_t seed : {1U, 2U}) {
      CAPTURE(to_string(piece));
      const Motion motion = motion_with(piece, seed, 1.6 + 0.1 * static_cast<double>(seed));
      for (std::size_t side = 0; side < 2; ++side) {
        Vec3 stood = Vec3::Zero();
        bool down = false;
        for (double t = 0.0; t < motion.length_s; t += 0.01) {
          const Vec3 toes = toes_at(motion, global_at(motion, t), side);
          CHECK(toes.y() > -1e-9);
          const bool now = toes.y() < 1e-4;
          if (now && !down) stood = toes;
          // A foot that is lifted by less than 0.1 mm may have moved by some millimetres already.
          if (now) CHECK((toes - stood).norm() < 0.01);
          down = now;
        }
      }
    }
  }
}

TEST_CASE("while one walks, one foot or both are on the floor, and they take turns") {
  const Motion motion = motion_with(Piece::walk_turn, 3);
  std::array<int, 2> swings{0, 0};
  std::array<bool, 2> was_up{false, false};
  for (double t = 0.0; t < motion.length_s; t += 0.01) {
    const GlobalPose pose = global_at(motion, t);
    std::array<bool, 2> up{};
    for (std::size_t side = 0; side < 2; ++side) {
      up[side] = toes_at(motion, pose, side).y() > 0.005;
      if (up[side] && !was_up[side]) ++swings[side];
    }
    CHECK_FALSE((up[0] && up[1]));
    was_up = up;
  }
  CHECK(swings[0] >= 8);
  CHECK(std::abs(swings[0] - swings[1]) <= 1);
}

TEST_CASE("a walker leans over the foot that stands, and swings the arm of the other side") {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {  // left and right foot first
    CAPTURE(seed);
    const Motion motion = motion_with(Piece::walk, seed);
    double over = 0.0, opposite = 0.0;
    for (double t = 3.5; t < 12.0; t += 0.01) {
      const GlobalPose pose = global_at(motion, t);
      const Vec3 left =
          pose.rotations[0].conjugate() * (toes_at(motion, pose, 1) - toes_at(motion, pose, 0));
      const auto ahead = [&](NeuronJoint joint) {
        return (pose.rotations[0].conjugate() * (pose.positions[index(joint)] - pose.positions[0]))
            .z();
      };
      opposite += left.z() * (ahead(NeuronJoint::left_hand) - ahead(NeuronJoint::right_hand));
      const double lifted = toes_at(motion, pose, 1).y() - toes_at(motion, pose, 0).y();
      const Vec3 middle = 0.5 * (pose.positions[index(NeuronJoint::left_foot)] +
                                 pose.positions[index(NeuronJoint::right_foot)]);
      const Vec3 aside = pose.rotations[0].conjugate() * (pose.positions[0] - middle);
      over += lifted * aside.x();  // to the right, so the yaw is below 0 while the left foot is up
    }
    CHECK(over < 0.0);
    CHECK(opposite < 0.0);
  }
}

TEST_CASE("bones keep their length: joints have no positions of their own") {
  const Motion motion = motion_with(Piece::walk_turn, 8);
  Pose pose;
  for (double t = 0.0; t < motion.length_s; t += 0.37) {
    motion.pose_at(t, pose);
    for (std::size_t j = 1; j < 59; ++j) {
      CHECK(pose.local_positions[j] == motion.skeleton.rest_offsets[j]);
    }
  }
}

TEST_CASE("knees bend backwards and elbows forwards, as people's do") {
  for (const Piece piece : all_pieces) {
    CAPTURE(to_string(piece));
    const Motion motion = motion_with(piece, 21);
    for (double t = 0.0; t < motion.length_s; t += 0.02) {
      for (const auto knee : {NeuronJoint::left_leg, NeuronJoint::right_leg}) {
        const Vec3 bent = rotation_vector(local_at(motion, t, knee));
        CHECK(bent.x() > 0.05);  // rad: the knee is never quite straight
        CHECK(bent.x() < 2.3);   // 130 degrees
        CHECK(std::hypot(bent.y(), bent.z()) < 1e-9);
      }
      const Vec3 left = rotation_vector(local_at(motion, t, NeuronJoint::left_fore_arm));
      const Vec3 right = rotation_vector(local_at(motion, t, NeuronJoint::right_fore_arm));
      for (const double bent : {-left.y(), right.y()}) {
        CHECK(bent >= 0.0);
        CHECK(bent < 2.6);
      }
      const Vec3 foot = rotation_vector(local_at(motion, t, NeuronJoint::left_foot));
      CHECK(foot.norm() < 0.9);
    }
  }
}

TEST_CASE("T-pose comes first: arms out, upright, legs nearly straight, facing +z") {
  for (const auto seed : fresh_seeds(10)) {
    CAPTURE(seed);
    const auto motion = built_in_motion({.length_s = 10.0, .seed = seed});
    REQUIRE(motion);
    for (double t = 0.0; t < 2.0; t += 0.25) {
      Pose pose;
      motion->pose_at(t, pose);
      for (std::size_t j = 0; j < 59; ++j) {
        const bool leg = j >= 1 && j <= 6;
        CHECK(angle_between(pose.local_rotations[j], Quat::Identity()) < (leg ? 0.25 : 0.15));
      }
      const GlobalPose global = global_at(*motion, t);
      for (const auto hand : {NeuronJoint::left_hand, NeuronJoint::right_hand}) {
        const Vec3 out =
            global.positions[index(hand)] - global.positions[index(NeuronJoint::spine3)];
        CHECK(std::abs(out.x()) > 0.6);
        CHECK(std::abs(out.z()) < 0.08);
      }
    }
  }
}

TEST_CASE("each piece moves as its name states") {
  const auto highest = [](const Motion& motion, NeuronJoint joint) {
    double most = -1.0;
    for (double t = 4.0; t < 16.0; t += 0.05) {
      most = std::max(most, global_at(motion, t).positions[index(joint)].y());
    }
    return most;
  };
  const auto lowest = [](const Motion& motion, NeuronJoint joint) {
    double least = 9.0;
    for (double t = 4.0; t < 16.0; t += 0.05) {
      least = std::min(least, global_at(motion, t).positions[index(joint)].y());
    }
    return least;
  };
  const Motion stand = motion_with(Piece::stand, 4), wave = motion_with(Piece::wave, 4);
  CHECK(highest(stand, NeuronJoint::left_hand) < 1.0);
  CHECK(std::max(highest(wave, NeuronJoint::left_hand), highest(wave, NeuronJoint::right_hand)) >
        1.5);
  CHECK(lowest(motion_with(Piece::bend, 4), NeuronJoint::head) <
        lowest(stand, NeuronJoint::head) - 0.25);
  CHECK(lowest(motion_with(Piece::squat, 4), NeuronJoint::hips) <
        lowest(stand, NeuronJoint::hips) - 0.2);
  CHECK(highest(motion_with(Piece::step, 4), NeuronJoint::left_foot) > 0.15);
  CHECK(highest(stand, NeuronJoint::left_foot) < 0.09);
}

TEST_CASE("slow pieces move as their names state") {
  struct Reached {
    double high = -1.0, low_head = 9.0, low_hips = 9.0, wide = 0.0, ahead = 0.0, yaw = 0.0;
  };
  const auto reached = [](Piece piece, const std::vector<NeuronJoint>& hands) {
    const auto motion = built_in_motion(
        {.programme = {{Piece::t_pose, 2.5}, {piece, 30.0}, {Piece::stand, 1.5}}, .seed = 4});
    REQUIRE(motion);
    Reached out;
    for (double t = 2.5; t < 32.5; t += 0.05) {
      const GlobalPose pose = global_at(*motion, t);
      const auto at = [&](NeuronJoint joint) { return pose.positions[index(joint)]; };
      // All hands that are to reach it do so at the same time.
      double high = 9.0, wide = 9.0, ahead = 9.0;
      for (const NeuronJoint hand : hands) {
        high = std::min(high, at(hand).y());
        wide = std::min(wide, std::abs((at(hand) - at(NeuronJoint::hips)).x()));
        ahead = std::min(ahead, (at(hand) - at(NeuronJoint::spine3)).z());
      }
      out.high = std::max(out.high, high);
      out.wide = std::max(out.wide, wide);
      out.ahead = std::max(out.ahead, ahead);
      out.low_head = std::min(out.low_head, at(NeuronJoint::head).y());
      out.low_hips = std::min(out.low_hips, at(NeuronJoint::hips).y());
      const Vec3 nose = pose.rotations[index(NeuronJoint::head)] * Vec3::UnitZ();
      out.yaw = std::max(out.yaw, std::abs(std::atan2(nose.x(), nose.z())));
    }
    return out;
  };
  const std::vector both{NeuronJoint::left_hand, NeuronJoint::right_hand};
  const Reached stand = reached(Piece::stand, both);
  const Reached front = reached(Piece::raise_front, both), side = reached(Piece::raise_side, both);
  CHECK(front.high > 1.6);  // m: over the head of a person of 1.75 m
  CHECK(side.high > 1.6);
  CHECK(front.ahead > 0.45);
  CHECK(side.ahead < 0.2);
  CHECK(side.wide > 0.6);
  CHECK(reached(Piece::push_both, both).ahead > 0.4);
  CHECK(reached(Piece::push, both).ahead < 0.2);  // one hand at a time
  for (const NeuronJoint hand : both) CHECK(reached(Piece::push, {hand}).ahead > 0.4);
  CHECK(reached(Piece::bend_side, both).low_head < stand.low_head - 0.05);
  for (const NeuronJoint hand : both) CHECK(reached(Piece::bend_side, {hand}).high > 1.5);
  CHECK(reached(Piece::twist, both).yaw > 1.0);  // rad
  CHECK(stand.yaw < 0.6);                        // glances
  const Reached squat = reached(Piece::squat, both), deep = reached(Piece::deep_squat, both);
  CHECK(deep.low_hips < squat.low_hips - 0.05);
}

TEST_CASE("another seed of the same person has that person's bones, but moves differently") {
  const auto motion_of = [](std::uint64_t seed) {
    auto motion =
        built_in_motion({.programme = {{Piece::raise_front, 20.0}}, .seed = seed, .person = 7});
    REQUIRE(motion);
    return *std::move(motion);
  };
  const Motion one = motion_of(1), other = motion_of(2), own = motion_of(7);
  CHECK(one.skeleton.rest_offsets == other.skeleton.rest_offsets);
  double apart = 0.0;
  for (double t = 0.0; t < 20.0; t += 0.1) {
    apart = std::max(apart,
                     (global_at(one, t).positions[16] - global_at(other, t).positions[16]).norm());
  }
  CHECK(apart > 0.1);
  const auto plain = built_in_motion({.programme = {{Piece::raise_front, 20.0}}, .seed = 7});
  REQUIRE(plain);
  CHECK(global_at(own, 9.3).positions == global_at(*plain, 9.3).positions);
}

TEST_CASE("walking goes to and fro, walk_turn everywhere, turn about oneself; all come home") {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    CAPTURE(seed);
    const auto far = [&](Piece piece) {
      const Motion motion = motion_with(piece, seed);
      double most = 0.0;
      std::array<bool, 8> faced{};
      for (double t = 3.0; t < 16.0; t += 0.05) {
        const Vec3 hips = global_at(motion, t).positions[0];
        most = std::max(most, std::hypot(hips.x(), hips.z()));
        const double eighth = (yaw_at(motion, t) + std::numbers::pi) / (2 * std::numbers::pi) * 8.0;
        faced[static_cast<std::size_t>(eighth) % 8] = true;
      }
      const Vec3 end = global_at(motion, motion.length_s).positions[0];
      CHECK(std::hypot(end.x(), end.z()) < 0.2);
      CHECK(std::abs(yaw_at(motion, motion.length_s)) < 0.15);
      return std::pair(most, std::count(faced.begin(), faced.end(), true));
    };
    const auto [walked, walk_ways] = far(Piece::walk);
    CHECK(walked > 0.5);
    CHECK(walked < 1.3);
    CHECK(walk_ways >= 4);
    const auto [about, about_ways] = far(Piece::walk_turn);
    CHECK(about > 0.3);
    CHECK(about < 1.4);
    CHECK(about_ways >= 6);
    const auto [turned, turn_ways] = far(Piece::turn);
    CHECK(turned < 0.1);
    CHECK(turn_ways >= 4);
  }
}

TEST_CASE("the same seed is the same person, another one is another") {
  const Motion one = motion_with(Piece::walk, 1), again = motion_with(Piece::walk, 1);
  const Motion other = motion_with(Piece::walk, 2);
  CHECK(global_at(one, 9.3).positions == global_at(again, 9.3).positions);
  CHECK((global_at(one, 9.3).positions[16] - global_at(other, 9.3).positions[16]).norm() > 0.01);
}

TEST_CASE("a later repetition is not the earlier one again") {
  const auto motion = built_in_motion(
      {.programme = {{Piece::t_pose, 3.0}, {Piece::squat, 7.0}, {Piece::squat, 7.0}}, .seed = 6});
  REQUIRE(motion);
  double most = 0.0;
  for (double t = 3.0; t < 10.0; t += 0.1) {
    const double apart =
        global_at(*motion, t).positions[0].y() - global_at(*motion, t + 7.0).positions[0].y();
    most = std::max(most, std::abs(apart));
  }
  CHECK(most > 0.01);
}

TEST_CASE("any height and length, at any rate") {
  for (const double height : {0.9, 1.2, 2.1}) {
    const auto motion = built_in_motion({.height_m = height, .length_s = 75.5, .seed = 2});
    REQUIRE(motion);
    CHECK(motion->length_s == 75.5);
    for (double t = 0.0; t < 75.5; t += 0.05) {
      const GlobalPose pose = global_at(*motion, t);
      CHECK(pose.positions[0].y() < 0.5316 * height);  // 0.9302 of 1.75
      CHECK(pose.positions[0].y() > 0.28 * height);
    }
  }
}

TEST_CASE("what is no person or no time is refused") {
  const auto message = [](const BuiltInOptions& options) {
    const auto motion = built_in_motion(options);
    REQUIRE_FALSE(motion);
    return to_string(motion.error());
  };
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  CHECK(message({.height_m = 3.0}) == "expected a height of 0.5 to 2.5 m, found 3 m");
  CHECK(message({.height_m = none}) == "expected a height of 0.5 to 2.5 m, found nan m");
  const std::string lengths =
      "expected pieces of 0 s or more, together at most 1000000 s, found others";
  CHECK(message({.length_s = none}) == lengths);
  CHECK(message({.length_s = 2e6}) == lengths);
  CHECK(message({.programme = {{Piece::walk, 20.0}, {Piece::wave, -5.0}}}) == lengths);
}
