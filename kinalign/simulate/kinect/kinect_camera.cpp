// SPDX-License-Identifier: Apache-2.0
// Applies the steps of the model in their order. Each step has its own file.
#include "kinalign/simulate/kinect/kinect_camera.h"

#include "kinalign/simulate/kinect/kinect_bias.h"
#include "kinalign/simulate/kinect/kinect_coloured.h"
#include "kinalign/simulate/kinect/kinect_exchange.h"
#include "kinalign/simulate/kinect/kinect_occlusion.h"
#include "kinalign/simulate/kinect/kinect_white.h"

#include <cmath>

namespace kinalign {

namespace {

/// Returns the visibility of a joint. If legs are below the image, the tracker guesses their
/// positions. Other joints outside the image are missing.
Unseen seen_at(const Vec3& place, KinectPart part, const KinectView& view) {
  const double z = place.z();
  if (!(z >= view.nearest && z <= view.farthest)) return Unseen::out_of_view;
  if (std::abs(place.x()) > view.slope_x * z) return Unseen::out_of_view;
  if (std::abs(place.y()) <= view.slope_y * z) return Unseen::no;
  return part == KinectPart::leg && place.y() < 0.0 ? Unseen::below_image : Unseen::out_of_view;
}

/// Returns the visibility of each joint [T,25].
std::vector<Unseen> unseen_joints(const KinectScene& scene, const KinectOptions& options) {
  std::vector<Unseen> unseen(scene.known.size(), Unseen::no);
  for (std::size_t i = 0; i < unseen.size(); ++i) {
    if (scene.known[i] == 0) {
      unseen[i] = Unseen::out_of_view;
    } else if (options.parts.view) {
      const KinectPart part = kinect_limbs[i % kinect_joint_count].part;
      unseen[i] = seen_at(vec3(scene.truth, i), part, options.view);
    }
  }
  return unseen;
}

// No body is reported without its trunk. One unseen joint of these three is tolerated.
bool body_is_there(std::span<const Unseen> unseen) {
  int out = 0;
  for (const KinectJoint j : {spine_base, spine_mid, spine_shoulder}) {
    if (unseen[j] != Unseen::no) ++out;
  }
  return out < 2;
}

/// Sets missing joints to zero. If the trunk is not seen, all joints are missing.
void leave_out(std::span<const Unseen> unseen, PointFrames& frames) {
  for (std::size_t t = 0; t < frames.size(); ++t) {
    const std::size_t first = t * kinect_joint_count;
    const bool there = body_is_there(unseen.subspan(first, kinect_joint_count));
    for (std::size_t i = first; i < first + kinect_joint_count; ++i) {
      if (there && unseen[i] != Unseen::out_of_view) continue;
      frames.state[i] = Tracking::missing;
      vec3(frames.positions, i).setZero();
    }
  }
}

}  // namespace

PointFrames simulate_kinect(const KinectJointsAt& joints_at, std::span<const KinectTick> ticks,
                            const KinectOptions& options, const KinectIds& ids) {
  // The order matters. Bone lengths are corrected before white noise is added. Hidden joints are
  // guessed from positions that contain all other errors. Sides are exchanged last, because only
  // the labels are wrong then, not the positions.
  const KinectScene scene = kinect_scene(joints_at, ticks, options);
  const KinectParts& parts = options.parts;
  PointFrames frames{{}, scene.truth, std::vector<Tracking>(scene.known.size(), Tracking::tracked)};
  for (const KinectTick& tick : ticks) frames.stamps.push_back(utc_time(100 * tick.device));
  if (parts.bias) add_kinect_bias(scene, ids, frames.positions);
  if (parts.coloured) add_coloured_noise(scene, ids, frames.positions);
  if (parts.twitches) add_twitches(scene, ids, frames.positions);
  if (parts.soft_bones) hold_bones(scene, frames.positions);
  if (parts.white) add_white_noise(scene, ids, frames.positions);
  const std::vector<Unseen> unseen = unseen_joints(scene, options);
  if (parts.occlusion || parts.view) guess_hidden(scene, options, ids, unseen, frames);
  leave_out(unseen, frames);
  if (parts.exchange) exchange_sides(scene, ids, frames);
  return frames;
}

}  // namespace kinalign
