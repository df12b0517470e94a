// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/fuse/fuse_data.h"

#include "kinalign/models/pairs.h"
#include "kinalign/motion/index_of.h"
#include "kinalign/simulate/kinect/kinect_camera.h"
#include "kinalign/simulate/random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace kinalign {

namespace {

constexpr double kinect_hz = 30.0;
// Limits for the place of a simulated Kinect in front of a person, within its working range.
constexpr double nearest_m = 2.2, farthest_m = 3.2, camera_height_m = 0.9;
constexpr double most_yaw_deg = 45.0;
constexpr std::int64_t tick_100ns = 333'333;  // Kinect time between frames

/// For each of the Kinect's 25 joints the body's joint. Hand tips and thumbs use the fingers.
std::array<std::size_t, kinect_joint_count> body_joints_of_kinect(const PoseBody& body) {
  const auto& names = body.skeleton.joint_names;
  std::array<std::size_t, kinect_joint_count> out{};
  for (std::size_t k = 0; k < kinect_joint_count; ++k) {
    const auto joint =
        std::find_if(fuse_joints.begin(), fuse_joints.end(),
                     [&](const FuseJoint& one) { return one.kinect == kinect_joints[k]; });
    // The simulator needs all 25 joints, although fusion does not use tips and thumbs.
    std::string_view name = kinect_joints[k].ends_with("Left") ? "lfingers" : "rfingers";
    if (joint != fuse_joints.end()) name = joint->body;
    out[k] = *index_of(names, name);
  }
  return out;
}

/// The true positions of the 25 joints in each frame [T,25,3] m, in the world.
std::vector<double> true_joints(const PoseBody& body, const PoseSequence& sequence) {
  const auto which = body_joints_of_kinect(body);
  const std::size_t joints = body.skeleton.joints(), frames = sequence.frames();
  const auto places = bone_positions(body, sequence.rest_offsets, sequence.rotations);
  const auto roots = true_roots(sequence);
  std::vector<double> out;
  out.reserve(frames * 3 * kinect_joint_count);
  for (std::size_t t = 0; t < frames; ++t) {
    const Eigen::Quaterniond root = roots[t].cast<double>();
    for (const std::size_t j : which) {
      const Eigen::Map<const Eigen::Vector3f> about_root(&places[3 * (t * joints + j)]);
      // bone_positions() knows neither place nor heading, so positions are moved from the root's
      // space into the world here.
      const Vec3 place = sequence.places[t] + root * about_root.cast<double>();
      out.insert(out.end(), {place.x(), place.y(), place.z()});
    }
  }
  return out;
}

/// A camera at a random place in front of the person. It looks horizontally at the middle of the
/// sequence.
RigidTransform camera_of(const PoseSequence& sequence, const RandomStream& random) {
  Vec3 middle = Vec3::Zero(), front = Vec3::Zero();
  const auto roots = true_roots(sequence);
  for (std::size_t t = 0; t < sequence.frames(); ++t) {
    middle += sequence.places[t] / static_cast<double>(sequence.frames());
    // +z of the root is the person's front; the sum is the mean direction over the sequence.
    front += roots[t].cast<double>() * Vec3::UnitZ();
  }
  front.y() = 0.0;
  if (front.norm() < 1e-3) front = Vec3::UnitZ();
  const double yaw = (2.0 * random.uniform(0, 0) - 1.0) * most_yaw_deg * std::numbers::pi / 180.0;
  const double distance = nearest_m + random.uniform(0, 1) * (farthest_m - nearest_m);
  const Vec3 to_camera = Eigen::AngleAxisd(yaw, Vec3::UnitY()) * front.normalized();
  Eigen::Matrix3d axes;
  // The space of a Kinect has z out of the camera and y up. `axes` rotates this space into the
  // world.
  axes.col(2) = -to_camera;
  axes.col(1) = Vec3::UnitY();
  axes.col(0) = axes.col(1).cross(axes.col(2));
  Vec3 place = middle + distance * to_camera;
  place.y() = camera_height_m;
  return {Quat(axes), place};
}

/// Selects the joints that fusion uses from all 25, and brings them into the world.
JointFrames seen_in_world(const PointFrames& measured, const RigidTransform& world_from_kinect) {
  JointFrames out{.joints = fuse_joints.size(), .positions = {}, .seen = {}};
  for (std::size_t t = 0; t < measured.size(); ++t) {
    for (const FuseJoint& joint : fuse_joints) {
      const auto k = static_cast<std::size_t>(
          std::find(kinect_joints.begin(), kinect_joints.end(), joint.kinect) -
          kinect_joints.begin());
      // The simulated Kinect has 25 joints, fusion uses 21.
      const std::size_t at = t * kinect_joint_count + k;
      const bool there = measured.state[at] != Tracking::missing;
      const Vec3 place =
          there ? world_from_kinect * Vec3(vec3(measured.positions, at)) : Vec3::Zero();
      for (const double value : place) out.positions.push_back(static_cast<float>(value));
      out.seen.push_back(static_cast<std::uint8_t>(measured.state[at]));
    }
  }
  return out;
}

}  // namespace

std::vector<Eigen::Quaternionf> true_roots(const PoseSequence& sequence) {
  std::vector<Eigen::Quaternionf> out;
  const std::size_t nodes = sequence.nodes.nodes;
  for (std::size_t t = 0; t < sequence.frames(); ++t) {
    const float* q = &sequence.nodes.orientation[4 * (t * nodes + nodes - 1)];
    out.emplace_back(q[0], q[1], q[2], q[3]);
  }
  return out;
}

/// Simulates one take of a Kinect at 30 Hz, one tick for each frame.
JointFrames simulated_kinect(const PoseBody& body, const PoseSequence& sequence,
                             std::uint64_t person, std::uint64_t seed, std::uint64_t take) {
  const auto joints = true_joints(body, sequence);
  const std::size_t frames = sequence.frames(), width = 3 * kinect_joint_count;
  KinectOptions options;
  options.world_from_kinect = camera_of(sequence, {seed, take});
  std::vector<KinectTick> ticks;
  for (std::size_t t = 0; t < frames; ++t) {
    const auto number = static_cast<std::int64_t>(t);
    ticks.push_back({number, static_cast<double>(t) / kinect_hz, number * tick_100ns});
  }
  const auto joints_at = [&](double seconds, std::span<double> out) {
    // The simulated camera also asks for times between frames; it gets the nearest frame.
    const double at =
        std::clamp(std::round(seconds * kinect_hz), 0.0, static_cast<double>(frames - 1));
    const auto from =
        joints.begin() + static_cast<std::ptrdiff_t>(at) * static_cast<std::ptrdiff_t>(width);
    std::copy(from, from + static_cast<std::ptrdiff_t>(width), out.begin());
  };
  const PointFrames measured =
      simulate_kinect(joints_at, ticks, options, {.seed = seed, .person = person, .take = take});
  return seen_in_world(measured, options.world_from_kinect);
}

namespace {

/// Simulates Kinects for all parts of the split. A person has the same number in all parts, so the
/// noise of that person is the same. `take_` counts all draws, so each draw has its own camera and
/// further random errors.
class SimulatedKinects {
 public:
  SimulatedKinects(const PoseBody& body, std::uint64_t seed) : body_(body), seed_(seed) {}

  std::vector<std::vector<JointFrames>> before(const std::vector<PoseSequence>& sequences,
                                               std::size_t draws) {
    std::vector<std::vector<JointFrames>> out;
    for (const PoseSequence& one : sequences) {
      const std::uint64_t person =
          people_.try_emplace(one.subject, people_.size() + 1).first->second;
      auto& own = out.emplace_back();
      for (std::size_t k = 0; k < draws; ++k) {
        own.push_back(simulated_kinect(body_, one, person, seed_, ++take_));
      }
    }
    return out;
  }

 private:
  const PoseBody& body_;
  std::uint64_t seed_;
  std::map<std::string, std::uint64_t> people_;
  std::uint64_t take_ = 0;
};

/// The file's own Kinect stream, at the frames of each sequence.
Result<std::vector<std::vector<JointFrames>>> own_kinect(
    const Windows& windows, const std::string& stream, const std::vector<PoseSequence>& sequences) {
  const auto names = fuse_joint_names();
  std::vector<std::vector<JointFrames>> out;
  for (const PoseSequence& one : sequences) {
    const JointFrames all =
        KA_TRY(kinect_frames(windows, windows.stretches[one.stretch], stream, names));
    JointFrames& own = out.emplace_back().emplace_back();
    own.joints = names.size();
    for (std::size_t t = 0; t < one.frames(); ++t) {
      // The sequence has fewer frames than its stretch, because its rate is lower and both ends are
      // cut off.
      const std::size_t row = one.first_row + t * one.rows_a_frame;
      const auto at = static_cast<std::ptrdiff_t>(row * names.size());
      const auto end = at + static_cast<std::ptrdiff_t>(names.size());
      own.positions.insert(own.positions.end(), all.positions.begin() + 3 * at,
                           all.positions.begin() + 3 * end);
      own.seen.insert(own.seen.end(), all.seen.begin() + at, all.seen.begin() + end);
    }
  }
  return out;
}

}  // namespace

// People, nodes and truth come from pose_data(). The Kinect is added for the same frames.
Result<FuseData> fuse_data(const Windows& windows, const std::string& stream,
                           const std::vector<std::string>& nodes, const FuseDataOptions& options) {
  FuseData out;
  out.pose = KA_TRY(pose_data(windows, stream, nodes));
  if (!options.kinect.empty()) {
    out.learnt = KA_TRY(own_kinect(windows, options.kinect, out.pose.learnt));
    out.judged = KA_TRY(own_kinect(windows, options.kinect, out.pose.judged));
    out.tested = KA_TRY(own_kinect(windows, options.kinect, out.pose.tested));
    return out;
  }
  SimulatedKinects kinects(out.pose.body, options.seed);
  out.learnt = kinects.before(out.pose.learnt, options.draws);
  out.judged = kinects.before(out.pose.judged, 1);
  out.tested = kinects.before(out.pose.tested, 1);
  return out;
}

}  // namespace kinalign
