// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/fuse/fuse_model.h"

#include "kinalign/models/body_frame.h"
#include "kinalign/models/pose/pose_model.h"
#include "kinalign/motion/median.h"

#include <algorithm>
#include <array>
#include <utility>

namespace kinalign {

namespace {

constexpr std::size_t smoothed_kinect_frames = 11;
constexpr std::size_t least_tracked_joints = 8;  // of 21; needed to find a position

/// True if the Kinect sees at least one joint in any frame.
bool is_placed(const FuseInput& input) {
  return std::any_of(input.kinect.seen.begin(), input.kinect.seen.end(),
                     [](std::uint8_t seen) { return seen != 0; });
}

}  // namespace

// The network outputs the rotations of root and bones in the space of the frame. The bones are then
// expressed relative to the root, as PoseBody needs them.
FusedFrame fused_frame(const FuseSpace& space, std::span<const float> answers,
                       std::span<Turn> rotations) {
  const Turn root = turn_of_answer(&answers[6 * rotations.size()]);
  for (std::size_t b = 0; b < rotations.size(); ++b) {
    rotations[b] = root.transpose() * turn_of_answer(&answers[6 * b]);
  }
  const Eigen::Map<const Eigen::Vector3f> way(&answers[6 * (rotations.size() + 1)]);
  FusedFrame out;
  out.root = (space.turn * Eigen::Quaternionf(root)).normalized();
  out.place = space.place + space.turn * (fuse_place_unit_m * way);
  return out;
}

Result<Fuser> Fuser::make(FuseModel model) {
  Network network = KA_TRY(network_of_body(model, model.layout.channels(), model.layout.answers()));
  return Fuser(std::move(model), std::move(network));
}

Fuser::Fuser(FuseModel model, Network network)
    : model_(std::move(model)), network_(std::move(network)) {
  const auto& names = model_.body.skeleton.joint_names;
  for (std::size_t j = 0; j < names.size(); ++j) {
    const auto kinect = kinect_joint_at(model_.layout.joints, names[j]);
    if (kinect) same_joints_.push_back({*kinect, j});
  }
}

FusedPose Fuser::pose_of(const FuseAnswers& output) const {
  const std::size_t bones = model_.layout.nodes.bones.size(), width = model_.layout.answers();
  FusedPose out;
  out.rotations.resize((output.end - output.first) * bones);
  for (std::size_t t = output.first; t < output.end; ++t) {
    const FusedFrame frame =
        fused_frame(output.spaces[t], output.answers.subspan(t * width, width),
                    std::span(out.rotations).subspan((t - output.first) * bones, bones));
    out.root.push_back(frame.root);
    out.place.push_back(frame.place);
  }
  return out;
}

std::vector<float> Fuser::run(FuseFeatures& features) {
  standardise(model_.input_mean, model_.input_scale, features.input);
  std::vector<float> out;
  network_.run(features.input, features.space.size(), workspace_, out);
  return out;
}

FusedPose Fuser::answer(const FuseInput& input) {
  FuseFeatures features = fuse_features(model_.layout, input);
  const std::vector<float> answers = run(features);
  return pose_of({features.space, answers, 0, input.frames()});
}

// The network gets only the Kinect's data here, because the nodes' headings are not known yet.
std::vector<HeadingState> Fuser::headings(const FuseInput& given) {
  FuseInput input = given;
  unexchange(model_.layout, input);
  FuseInput kinect = input;
  std::fill(kinect.nodes.valid.begin(), kinect.nodes.valid.end(), std::uint8_t{0});
  const FusedPose seen = answer(kinect);
  const HeadingFilter filter(model_.layout, model_.body);
  return node_headings(filter, input.nodes,
                       directions_of_pose(filter, input.kinect, seen.rotations, seen.root));
}

// Steps 3 and 5 to 9 of docs/fuse.md; headings() is step 4.
FusedPose Fuser::solve(const FuseInput& input, const std::vector<HeadingState>& headings) {
  FuseInput own = input;
  unexchange(model_.layout, own);
  own.nodes = with_headings(std::move(own.nodes), headings);
  FuseFeatures features = fuse_features(model_.layout, own);
  const std::vector<float> answers = run(features);
  return measured_pose_of({features.space, answers, 0, own.frames()}, own);
}

FusedPose Fuser::measured_pose_of(const FuseAnswers& output, const FuseInput& input) const {
  FusedPose out = pose_of(output);
  turn_to_measured(input, output.first, out);
  place_at_seen(input, output.first, out);
  if (!model_.smoothing) return out;
  // Rotations are smoothed over five frames, positions over nine (Smoothing{}).
  smooth_turns(model_.layout.nodes.bones.size(), out.rotations);
  std::vector<Turn> roots;
  for (const Eigen::Quaternionf& root : out.root) roots.emplace_back(root.toRotationMatrix());
  smooth_turns(1, roots);
  for (std::size_t t = 0; t < roots.size(); ++t) out.root[t] = Eigen::Quaternionf(roots[t]);
  std::vector<float> places;
  for (const Eigen::Vector3f& place : out.place) {
    places.insert(places.end(), {place.x(), place.y(), place.z()});
  }
  smooth(Smoothing{}, 3, places);
  for (std::size_t t = 0; t < out.place.size(); ++t) {
    out.place[t] = Eigen::Map<const Eigen::Vector3f>(&places[3 * t]);
  }
  return out;
}

/// Moves the body of each frame onto the joints that the Kinect tracks, by the median of the
/// joints' differences. The network has learnt the root's position from other skeletons, whose hips
/// lie elsewhere. A frame with few tracked joints keeps the network's position.
void Fuser::place_at_seen(const FuseInput& input, std::size_t first, FusedPose& pose) const {
  const std::size_t joints = model_.body.skeleton.joints();
  const auto about_root =
      bone_positions(model_.body, model_.body.skeleton.rest_offsets, pose.rotations);
  for (std::size_t t = 0; t < pose.place.size(); ++t) {
    std::array<std::vector<float>, 3> ways;
    for (const auto& [kinect, body] : same_joints_) {
      const std::size_t at = (first + t) * input.kinect.joints + kinect;
      if (input.kinect.seen[at] != 2) continue;
      const Eigen::Map<const Eigen::Vector3f> seen(&input.kinect.positions[3 * at]);
      const Eigen::Map<const Eigen::Vector3f> own(&about_root[3 * (t * joints + body)]);
      const Eigen::Vector3f way = seen - pose.place[t] - pose.root[t] * Eigen::Vector3f(own);
      for (std::size_t k = 0; k < 3; ++k) ways[k].push_back(way[static_cast<Eigen::Index>(k)]);
    }
    if (ways[0].size() < least_tracked_joints) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      pose.place[t][static_cast<Eigen::Index>(k)] += upper_median(std::move(ways[k]));
    }
  }
}

/// Turns the pose towards the measurements. `first`: the row of `input` at which the pose begins.
void Fuser::turn_to_measured(const FuseInput& input, std::size_t first, FusedPose& pose) const {
  // Smoothing needs all joints, so gaps are filled first. The states of the input are then
  // restored, so that no bone follows a filled gap.
  JointFrames smoothed = input.kinect;
  fill_missing(smoothed, false);
  smooth(Smoothing{.window = smoothed_kinect_frames}, 3 * smoothed.joints, smoothed.positions);
  smoothed.seen = input.kinect.seen;
  const auto carried = carried_bones(model_.layout, model_.body);
  const auto seen = seen_bones(model_.body, model_.layout.joints);
  const std::size_t bones = model_.layout.nodes.bones.size();
  for (std::size_t t = 0; t < pose.root.size(); ++t) {
    const std::span<Turn> rotations = std::span(pose.rotations).subspan(t * bones, bones);
    turn_to_nodes(carried, input.nodes, first + t, pose.root[t], rotations);
    turn_to_seen(seen, smoothed, first + t, pose.root[t], rotations);
  }
}

Clip Fuser::clip(const FuseInput& input, const std::vector<HeadingState>& headings, Time start) {
  const FusedPose pose = solve(input, headings);
  Clip out{model_.body.skeleton,
           clip_frames(model_.body, pose.rotations, pose.root, model_.layout.nodes.rate_hz, start)};
  if (!is_placed(input)) return out;
  const std::size_t joints = model_.body.skeleton.joints();
  for (std::size_t t = 0; t < pose.place.size(); ++t) {
    vec3(out.frames.local_positions, t * joints) = pose.place[t].cast<double>();
  }
  return out;
}

}  // namespace kinalign
