// SPDX-License-Identifier: Apache-2.0
#include "tools/kinect_table/rehearse.h"

#include "kinalign/motion/rigid_fit.h"

#include <algorithm>
#include <span>

namespace kinalign {

namespace {

constexpr std::int64_t pause = 150;  // frames between repetitions
constexpr double frame_s = 1.0 / 30.0;
// Height of the camera, m, an estimate: the data do not state it. They call their origin the
// camera, but it is the floor, because feet stand at 0.
constexpr double camera_height = 1.0;

/// Makes 25 joints in a world turned to the camera from 18 joints in the data's space (z towards
/// the camera).
void all_joints(std::span<const double> known, std::span<double> joints) {
  for (std::size_t m = 0; m < mapped_joints; ++m) {
    const Vec3 p = vec3(known, m);
    vec3(joints, mapped[m]) = Vec3(-p.x(), p.y(), -p.z());
  }
  vec3(joints, neck) = 0.5 * (vec3(joints, spine_shoulder) + vec3(joints, head));
  const auto hand = [&](KinectJoint wrist, KinectJoint palm, KinectJoint tip, KinectJoint thumb) {
    const Vec3 along = vec3(joints, wrist) - vec3(joints, kinect_limbs[wrist].parent);
    const Vec3 way = along / std::max(along.norm(), 1e-6);
    vec3(joints, palm) = vec3(joints, wrist) + 0.08 * way;
    vec3(joints, tip) = vec3(joints, wrist) + 0.16 * way;
    vec3(joints, thumb) = vec3(joints, wrist) + 0.09 * way + Vec3(0.0, 0.0, -0.05);
  };
  hand(wrist_left, hand_left, hand_tip_left, thumb_left);
  hand(wrist_right, hand_right, hand_tip_right, thumb_right);
}

struct Place {
  const Repetition* piece;
  std::size_t frame;
};

void put_simulated(const PointFrames& frames, std::size_t t, Repetition& piece, std::size_t frame) {
  for (std::size_t m = 0; m < mapped_joints; ++m) {
    const Vec3 p = vec3(frames.positions, t * kinect_joint_count + mapped[m]);
    vec3(piece.kinect, frame * mapped_joints + m) = Vec3(-p.x(), p.y() + camera_height, -p.z());
    if (frames.state[t * kinect_joint_count + mapped[m]] == Tracking::missing) {
      piece.valid[frame * mapped_joints + m] = 0;
    }
  }
}

/// Moves the truth of a take onto its joints by one rigid transform for all repetitions together.
void move_truth(std::span<Repetition> take) {
  PairMoments moments;
  for (const Repetition& piece : take) {
    for (std::size_t i = 0; i < piece.valid.size(); ++i) {
      if (piece.valid[i] != 0) moments.add(vec3(piece.truth, i), vec3(piece.kinect, i));
    }
  }
  const auto fit = fit_rigid(moments);
  if (!fit) return;
  for (Repetition& piece : take) {
    for (std::size_t i = 0; i < piece.valid.size(); ++i) {
      vec3(piece.truth, i) = *fit * Vec3(vec3(piece.truth, i));
    }
  }
}

void rehearse_take(std::span<Repetition> take, const KinectOptions& options, const KinectIds& ids) {
  std::vector<KinectTick> ticks;
  std::vector<Place> places;
  std::int64_t number = 0;
  for (const Repetition& piece : take) {
    for (std::size_t t = 0; t < piece.frames; ++t, ++number) {
      ticks.push_back({number, static_cast<double>(number) * frame_s, 333'333 * number});
      places.push_back({&piece, t});
    }
    number += pause;
  }
  std::size_t next = 0;  // joints are asked for in the order of ticks
  const KinectJointsAt joints_at = [&](double, std::span<double> joints) {
    const Place& place = places[next++];
    all_joints({&place.piece->truth[place.frame * 3 * mapped_joints], 3 * mapped_joints}, joints);
  };
  const PointFrames frames = simulate_kinect(joints_at, ticks, options, ids);
  std::size_t row = 0;
  for (Repetition& piece : take) {
    for (std::size_t t = 0; t < piece.frames; ++t, ++row) put_simulated(frames, row, piece, t);
  }
  move_truth(take);
}

}  // namespace

std::vector<Repetition> rehearsed(const std::vector<Repetition>& pieces, const KinectParts& parts,
                                  std::uint64_t seed) {
  std::vector<Repetition> out = pieces;
  KinectOptions options;
  options.parts = parts;
  options.world_from_kinect.translation = Vec3(0.0, camera_height, 0.0);
  for (const TakeRange& range : takes(pieces)) {
    const Repetition& first = pieces[range.begin];
    rehearse_take({&out[range.begin], range.end - range.begin}, options,
                  {.seed = seed, .person = first.person, .take = first.movement, .camera = 0});
  }
  return out;
}

}  // namespace kinalign
