// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/pose/pose_data.h"

#include "kinalign/core/find_named.h"
#include "kinalign/learn/pose/upright_zero.h"
#include "kinalign/models/pose/pose_skeleton.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

namespace kinalign {

namespace {

using Mat3 = Eigen::Matrix3d;

// Models of poses work at 30 Hz. If a file has a multiple of this rate, accelerations are computed
// from all its frames.
constexpr double pose_rate_hz = 30.0;
constexpr double acceleration_reach_s = 4.0 / 60.0;  // similar to the band of a node at 15 Hz
constexpr double least_seconds = 1.5;
constexpr std::size_t least_upright = 60;  // frames

/// A node's place: on the line from a bone's joint to another joint, plus a lever. Nodes are worn
/// as docs/pose.md says. The lever is in the bone's space, so it turns with the bone.
struct NodePlace {
  std::string_view name, bone, towards;
  double share;
  std::array<double, 3> lever;  // m, in the bone's space
};

constexpr std::array<NodePlace, 6> node_places{{
    {"wrist_left", "lwrist", "lhand", 0.6, {}},
    {"wrist_right", "rwrist", "rhand", 0.6, {}},
    {"ankle_left", "ltibia", "lfoot", 0.35, {}},
    {"ankle_right", "rtibia", "rfoot", 0.35, {}},
    {"head", "head", "head", 0.0, {0.0, 0.08, 0.0}},
    {"waist", "root", "root", 0.0, {0.0, 0.05, -0.1}},
}};

/// A node's place with indices into pose_joints.
struct NodeJoints {
  std::size_t bone, towards;
  double share;
  Vec3 lever;
};

/// A file's skeleton. Indices are those of pose_joints.
struct FileSkeleton {
  PoseSkeleton pose;
  std::vector<std::size_t> bones;  // [pose_bones] index of the joint with the bone's name
  std::vector<NodeJoints> nodes;
  std::size_t head = 0;
};

std::vector<std::string> pose_joint_names() {
  std::vector<std::string> out;
  out.reserve(pose_joints.size());
  for (const PoseJoint& joint : pose_joints) out.emplace_back(joint.name);
  return out;
}

std::vector<int> pose_joint_parents() { return pose_body({}).skeleton.parents; }

/// The joints that carry and turn a node of that name; fails for an unknown name.
Result<NodeJoints> node_joints(const std::string& node) {
  const NodePlace* const place = find_named(node_places, node);
  if (place == nullptr) {
    std::string known;
    for (const NodePlace& one : node_places)
      known += (known.empty() ? "" : ", ") + std::string(one.name);
    return Failure(Error{"", 0, "nodes among " + known, shown(node)});
  }
  return NodeJoints{pose_joint_at(place->bone), pose_joint_at(place->towards), place->share,
                    Vec3(place->lever[0], place->lever[1], place->lever[2])};
}

Result<FileSkeleton> file_skeleton(const Windows& windows, const std::string& stream,
                                   const std::vector<std::string>& nodes) {
  const WindowsFacts::Stream* found = windows.facts.find(stream);
  if (found == nullptr || found->names.empty() || found->names.size() != found->parents.size()) {
    return Failure(Error{"", 0, "a stream \"" + stream + "\" of a skeleton", "none"});
  }
  FileSkeleton out;
  out.pose = KA_TRY(pose_skeleton(found->names, found->parents));
  for (const std::string_view bone : pose_bones) out.bones.push_back(pose_joint_at(bone));
  for (const std::string& node : nodes) out.nodes.push_back(KA_TRY(node_joints(node)));
  out.head = pose_joint_at("head");
  return out;
}

/// A stretch of the file: global rotations and positions of the joints of pose_joints, frame by
/// frame. The arrays belong to the stretch and are not copied; go_to() computes one frame. Files
/// have rotations relative to the parent, so all rotations are multiplied from the root outward.
class GlobalFrames {
 public:
  static Result<GlobalFrames> make(const FileSkeleton& skeleton, const Stretch& stretch,
                                   const std::string& stream) {
    const auto found = stretch.streams.find(stream);
    const std::size_t joints = skeleton.pose.file_joints();
    if (found != stretch.streams.end()) {
      const auto& arrays = found->second.arrays;
      const auto rotations = arrays.find("local_rotations"), positions = arrays.find("positions");
      if (rotations != arrays.end() && positions != arrays.end() &&
          rotations->second.size() == stretch.rows * joints * 4 &&
          positions->second.size() == stretch.rows * joints * 3) {
        return GlobalFrames(skeleton.pose, rotations->second, positions->second);
      }
    }
    return Failure(Error{"", 0, "positions and local_rotations of " + stream, "none"});
  }

  std::size_t frames() const { return rotations_->size() / (4 * skeleton_->file_joints()); }

  /// Selects frame `t`.
  void go_to(std::size_t t) {
    const std::size_t joints = skeleton_->file_joints();
    file_rotations_.resize(joints);
    for (std::size_t j = 0; j < joints; ++j) {
      const float* q = &(*rotations_)[4 * (t * joints + j)];
      const Mat3 local =
          Eigen::Quaternionf(q[0], q[1], q[2], q[3]).cast<double>().normalized().toRotationMatrix();
      const int parent = skeleton_->file_parents[j];
      file_rotations_[j] =
          parent < 0 ? local : Mat3(file_rotations_[static_cast<std::size_t>(parent)] * local);
    }
    // Several joints of the body may turn with one joint of the file (a suit has fewer).
    all_rotations_.clear();
    for (const JointSource& one : skeleton_->joints) {
      all_rotations_.push_back(file_rotations_[one.turner]);
    }
    frame_ = t;
  }

  /// The global rotations of pose_joints, relative to the rest pose of the file.
  const std::vector<Mat3>& rotations() const { return all_rotations_; }

  Vec3 position(std::size_t joint) const {
    const JointSource& one = skeleton_->joints[joint];
    const Vec3 from = file_position(one.from);
    return from + one.share * (file_position(one.to) - from) +
           file_rotations_[one.turner] * one.along;
  }

 private:
  GlobalFrames(const PoseSkeleton& skeleton, const std::vector<float>& rotations,
               const std::vector<float>& positions)
      : skeleton_(&skeleton), rotations_(&rotations), positions_(&positions) {}

  Vec3 file_position(std::size_t joint) const {
    const float* p = &(*positions_)[3 * (frame_ * skeleton_->file_joints() + joint)];
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
  }

  const PoseSkeleton* skeleton_;
  const std::vector<float>* rotations_;
  const std::vector<float>* positions_;
  std::size_t frame_ = 0;
  std::vector<Mat3> file_rotations_, all_rotations_;
};

/// Nodes without errors, at the file's rate.
struct NodeMotion {
  std::vector<Mat3> orientation;  // [T,N] of each node in each frame
  std::vector<Vec3> position;     // [T,N] m
};

/// Angular velocity in the rotated space, rad/s, from two frames `step_s` apart. Exact up to the
/// third order of the angle.
Vec3 angular_velocity(const Mat3& from, const Mat3& to, double step_s) {
  // The antisymmetric part of a small rotation is its angle about each axis.
  const Mat3 turn = from.transpose() * to;
  return Vec3(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1)) /
         (2.0 * step_s);
}

void append(std::vector<float>& out, const Vec3& vector) {
  for (const double value : vector) out.push_back(static_cast<float>(value));
}

/// Makes sequences at 30 Hz from the frames of a file. All frames of the file are used once,
/// because accelerations need positions at the file's rate. Only every `stride_`-th frame is kept.
class SequenceMaker {
 public:
  SequenceMaker(const FileSkeleton& skeleton, double file_rate_hz)
      : skeleton_(skeleton),
        step_s_(1.0 / file_rate_hz),
        stride_(static_cast<std::size_t>(std::lround(file_rate_hz / pose_rate_hz))),
        reach_(static_cast<std::size_t>(std::lround(file_rate_hz * acceleration_reach_s))) {}

  /// Frames near both ends are dropped, because the acceleration needs frames on both sides.
  PoseSequence make(GlobalFrames frames, const std::vector<Mat3>& turns) const {
    PoseSequence out;
    out.nodes.nodes = skeleton_.nodes.size();
    out.first_row = reach_;
    out.rows_a_frame = stride_;
    NodeMotion motion;
    std::vector<Mat3> rotations;
    for (std::size_t t = 0; t < frames.frames(); ++t) {
      frames.go_to(t);
      rotations = frames.rotations();
      // The person's rotations get their common zero (upright_zero.h) before nodes and truth are
      // made.
      for (std::size_t j = 0; j < rotations.size(); ++j) rotations[j] = rotations[j] * turns[j];
      add_nodes(frames, rotations, motion);
      if (!is_kept(t, frames.frames())) continue;
      add_truth(rotations, out);
      out.places.push_back(frames.position(0));
    }
    for (std::size_t t = reach_; t + reach_ < frames.frames(); t += stride_) {
      for (std::size_t n = 0; n < out.nodes.nodes; ++n) add_sample(motion, t, n, out.nodes);
    }
    return out;
  }

 private:
  bool is_kept(std::size_t t, std::size_t frames) const {
    return t >= reach_ && t + reach_ < frames && (t - reach_) % stride_ == 0;
  }

  void add_nodes(const GlobalFrames& frames, const std::vector<Mat3>& rotations,
                 NodeMotion& motion) const {
    for (const NodeJoints& node : skeleton_.nodes) {
      const Vec3 begin = frames.position(node.bone), end = frames.position(node.towards);
      motion.position.push_back(begin + node.share * (end - begin) +
                                rotations[node.bone] * node.lever);
      motion.orientation.push_back(rotations[node.bone]);
    }
  }

  void add_truth(const std::vector<Mat3>& rotations, PoseSequence& out) const {
    for (const std::size_t bone : skeleton_.bones) {
      // Rotations are relative to the root, because a network must not learn the person's heading.
      out.rotations.emplace_back((rotations[0].transpose() * rotations[bone]).cast<float>());
    }
  }

  /// Appends the sample of node n in frame t. Its acceleration is the second difference over
  /// `reach_` frames to each side.
  void add_sample(const NodeMotion& motion, std::size_t t, std::size_t n, NodeFrames& out) const {
    const std::size_t count = skeleton_.nodes.size();
    const auto at = [&](std::size_t frame) { return frame * count + n; };
    const Quat q(motion.orientation[at(t)]);
    for (const double value : {q.w(), q.x(), q.y(), q.z()}) {
      out.orientation.push_back(static_cast<float>(value));
    }
    const double reach_s = static_cast<double>(reach_) * step_s_;
    append(out.acceleration, (motion.position[at(t - reach_)] - 2.0 * motion.position[at(t)] +
                              motion.position[at(t + reach_)]) /
                                 (reach_s * reach_s));
    append(out.angular_velocity,
           angular_velocity(motion.orientation[at(t)], motion.orientation[at(t + 1)], step_s_));
    out.valid.push_back(1);
  }

  const FileSkeleton& skeleton_;
  double step_s_;
  std::size_t stride_, reach_;
};

/// True if all joints were measured. Second differences over interpolated joints would be wrong.
bool is_all_valid(const Stretch& stretch, const std::string& stream) {
  const auto& arrays = stretch.streams.at(stream).arrays;
  const auto valid = arrays.find("valid");
  return valid == arrays.end() ||
         std::all_of(valid->second.begin(), valid->second.end(), [](float v) { return v > 0.0F; });
}

/// The rest offsets of the person of a stretch.
Result<std::vector<Vec3>> own_offsets(const Windows& windows, const std::string& stream,
                                      const Stretch& stretch, std::size_t joints) {
  const auto found = windows.rest_offsets.find(stream);
  const std::size_t at = stretch.take * joints * 3;
  if (found == windows.rest_offsets.end() || found->second.size() < at + 3 * joints) {
    return Failure(Error{"", 0, stream + "_rest_offsets of each take", "fewer"});
  }
  std::vector<Vec3> out;
  for (std::size_t j = 0; j < joints; ++j) {
    const float* offset = &found->second[at + 3 * j];
    out.emplace_back(offset[0], offset[1], offset[2]);
  }
  return out;
}

/// The mean body of the people in `sequences`; each person counts once.
std::vector<Vec3> mean_offsets(const std::vector<PoseSequence>& sequences) {
  std::map<std::string, const PoseSequence*> people;
  for (const PoseSequence& one : sequences) people.emplace(one.subject, &one);
  std::vector<Vec3> out(pose_joints.size(), Vec3::Zero());
  for (const auto& [subject, one] : people) {
    for (std::size_t j = 0; j < out.size(); ++j) out[j] += one->rest_offsets[j];
  }
  for (Vec3& offset : out) offset /= static_cast<double>(people.size());
  return out;
}

/// The take's facts (name, person, action) for a stretch.
WindowsFacts::Take take_of(const Windows& windows, const Stretch& stretch) {
  const auto& takes = windows.facts.takes;
  return stretch.take < takes.size() ? takes[stretch.take] : WindowsFacts::Take{};
}

/// The list for the stretch's part of the split. A file without a split has one part, which is used
/// for training.
std::vector<PoseSequence>& part_of(const Windows& windows, const Stretch& stretch, PoseData& out) {
  const auto& parts = windows.facts.parts;
  const std::string name = stretch.part < parts.size() ? parts[stretch.part] : "";
  if (parts.size() == 1 || name == "train") return out.learnt;
  return name == "validation" ? out.judged : out.tested;
}

/// The frames of each person who stands upright, from all parts. They give the zero of the person's
/// rotations.
Result<std::map<std::string, UprightFrames>> upright_frames(const Windows& windows,
                                                            const FileSkeleton& skeleton,
                                                            const std::string& stream) {
  std::map<std::string, UprightFrames> out;
  const std::vector<std::string> names = pose_joint_names();
  for (const Stretch& stretch : windows.stretches) {
    GlobalFrames frames = KA_TRY(GlobalFrames::make(skeleton, stretch, stream));
    const auto person = out.try_emplace(take_of(windows, stretch).subject, names).first;
    for (std::size_t t = 0; t < frames.frames(); ++t) {
      frames.go_to(t);
      person->second.add(frames.rotations(), frames.position(skeleton.head) - frames.position(0));
    }
  }
  return out;
}

/// The change of each joint's zero: from the upright stand for the trunk, from CMU's rest pose for
/// limbs.
std::vector<Mat3> all_turns(const UprightFrames& person, const PoseSkeleton& skeleton,
                            const std::vector<Vec3>& offsets) {
  std::vector<Mat3> out = person.turns();
  const std::vector<Mat3> limbs = limb_turns(skeleton, offsets);
  for (std::size_t j = 0; j < out.size(); ++j) out[j] = out[j] * limbs[j];
  return out;
}

/// Fills the parts of `out` with all stretches that are long enough and valid.
Result<void> add_sequences(const Windows& windows, const std::string& stream,
                           const FileSkeleton& skeleton,
                           const std::map<std::string, UprightFrames>& upright, PoseData& out) {
  const double rate_hz = windows.facts.rate_hz;
  const SequenceMaker maker(skeleton, rate_hz);
  const std::vector<int> parents = pose_joint_parents();
  for (const Stretch& stretch : windows.stretches) {
    const std::string subject = take_of(windows, stretch).subject;
    const UprightFrames& person = upright.at(subject);
    if (person.count() < least_upright || !is_all_valid(stretch, stream) ||
        static_cast<double>(stretch.rows) < least_seconds * rate_hz) {
      continue;
    }
    const auto in_file = KA_TRY(own_offsets(windows, stream, stretch, skeleton.pose.file_joints()));
    const std::vector<Vec3> own = pose_offsets(skeleton.pose, in_file);
    const std::vector<Mat3> turns = all_turns(person, skeleton.pose, own);
    PoseSequence one = maker.make(KA_TRY(GlobalFrames::make(skeleton, stretch, stream)), turns);
    one.subject = subject;
    // fuse_data() finds the Kinect's rows of the same stretch by this index.
    one.stretch = static_cast<std::size_t>(&stretch - windows.stretches.data());
    one.action = take_of(windows, stretch).action;
    // The zeros of the rotations have changed, so the rest offsets must turn with them.
    one.rest_offsets = turned_offsets(parents, own, turns);
    part_of(windows, stretch, out).push_back(std::move(one));
  }
  return {};
}

Result<void> check_nodes(const std::vector<std::string>& nodes) {
  PoseLayout layout;
  layout.nodes = nodes;
  // validate() needs at least one bone, but only the nodes are checked here.
  layout.bones = {"any"};
  KA_TRY(validate(layout));
  if (nodes.back() != "waist")
    return Failure(Error{"", 0, "the node waist as the last one", nodes.back()});
  return {};
}

}  // namespace

std::vector<std::string> known_pose_nodes() {
  std::vector<std::string> out;
  out.reserve(node_places.size());
  for (const NodePlace& one : node_places) out.emplace_back(one.name);
  return out;
}

std::vector<std::string> usual_pose_nodes() {
  return {"wrist_left", "wrist_right", "ankle_left", "ankle_right", "waist"};
}

Result<PoseData> pose_data(const Windows& windows, const std::string& stream,
                           const std::vector<std::string>& nodes) {
  KA_TRY(check_nodes(nodes));
  const FileSkeleton skeleton = KA_TRY(file_skeleton(windows, stream, nodes));
  const double rate_hz = windows.facts.rate_hz, times = rate_hz / pose_rate_hz;
  if (times < 0.99 || std::abs(times - std::round(times)) > 0.01 * times) {
    return Failure(Error{"", 0, "a multiple of 30 Hz", std::to_string(rate_hz) + " Hz"});
  }
  // This is a first pass over all stretches: a person's zero must be known before sequences are
  // made.
  const auto upright = KA_TRY(upright_frames(windows, skeleton, stream));
  PoseData out;
  out.nodes = nodes;
  for (const auto& [subject, frames] : upright) {
    if (frames.count() < least_upright) out.left_out.push_back(subject);
  }
  KA_TRY(add_sequences(windows, stream, skeleton, upright, out));
  if (out.learnt.empty()) {
    return Failure(
        Error{"", 0, "stretches of 1.5 s to learn from, of people who stand upright", "none"});
  }
  out.body = pose_body(mean_offsets(out.learnt));
  return out;
}

}  // namespace kinalign
