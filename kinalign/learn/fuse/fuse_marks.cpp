// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/fuse/fuse_marks.h"

#include "kinalign/evaluate/sequence.h"
#include "kinalign/learn/pose/pose_task.h"
#include "kinalign/models/pose/pose_metrics.h"
#include "kinalign/motion/mahony.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace kinalign {

namespace {

// The seed is fixed, so that all methods are measured with the same errors.
constexpr std::uint64_t fuse_marks_seed = 7;
constexpr std::array<double, 4> hidden_s{0.5, 1.0, 2.0, 5.0};
constexpr double between_s = 2.0;   // pause between two hidden limbs
constexpr float invented_m = 0.2F;  // a joint that the Kinect puts farther off counts as hidden
constexpr double heading_seconds = 60.0;

enum class JointGroup : std::uint8_t { trunk, arms, legs };

/// A joint that is scored: its index in the body, and in the Kinect's joints if the Kinect has it.
/// Joints that a Kinect lacks are scored too, but belong to no group of seen joints.
struct ScoredJoint {
  std::size_t body = 0;
  std::optional<std::size_t> kinect;
  JointGroup group = JointGroup::trunk;
};

// Names of limbs begin with l or r; the rest of the name is the bone's.
JointGroup group_of(std::string_view name) {
  static constexpr std::array<std::string_view, 2> legs{"tibia", "foot"};
  static constexpr std::array<std::string_view, 3> arms{"radius", "wrist", "hand"};
  const auto of = [&](std::string_view part) { return name.substr(1) == part; };
  if (std::any_of(legs.begin(), legs.end(), of)) return JointGroup::legs;
  return std::any_of(arms.begin(), arms.end(), of) ? JointGroup::arms : JointGroup::trunk;
}

/// The joints that are scored, each with the Kinect's joint for it, if there is one.
std::vector<ScoredJoint> scored_joints(const FuseLayout& layout, const PoseBody& body) {
  std::vector<ScoredJoint> out;
  for (std::size_t j = 0; j < body.skeleton.joints(); ++j) {
    const std::string& name = body.skeleton.joint_names[j];
    if (!is_scored_joint(name)) continue;
    out.push_back({j, kinect_joint_at(layout.joints, name), group_of(name)});
  }
  return out;
}

/// Hides one limb after another for 0.5 to 5 s, with pauses of 2 s.
void hide_limbs(const FuseLayout& layout, JointFrames& kinect) {
  const double rate_hz = layout.nodes.rate_hz;
  double at_s = 1.0;
  for (std::size_t k = 0; at_s * rate_hz < static_cast<double>(kinect.frames()); ++k) {
    // The sequences of limbs and of lengths are shifted relative to each other after each round, so
    // each limb is hidden for each length in turn.
    const double length_s = hidden_s[(k / kinect_limb_joints.size() + k) % hidden_s.size()];
    lose_limb(kinect, layout.joints, k % kinect_limb_joints.size(),
              static_cast<std::size_t>(at_s * rate_hz),
              static_cast<std::size_t>((at_s + length_s) * rate_hz));
    at_s += length_s + between_s;
  }
}

/// The rotation about the vertical from the predicted headings to the true ones. The mean angle is
/// found from sines and cosines, because angles wrap.
Eigen::Quaternionf heading_turn(const std::vector<Eigen::Quaternionf>& predicted,
                                const std::vector<Eigen::Quaternionf>& roots) {
  double sine = 0.0, cosine = 0.0;
  for (std::size_t t = 0; t < predicted.size(); ++t) {
    const double yaw =
        heading_of(roots[t].cast<double>()) - heading_of(predicted[t].cast<double>());
    sine += std::sin(yaw);
    cosine += std::cos(yaw);
  }
  return Eigen::Quaternionf(
      Eigen::AngleAxisf(static_cast<float>(std::atan2(sine, cosine)), Eigen::Vector3f::UnitY()));
}

/// Sums the errors of a method's poses. Distances are relative to the root, in directions of the
/// world. A joint that the Kinect lacks counts only in all_cm.
class FuseScore {
 public:
  FuseScore(Devices devices, const FuseLayout& layout, const PoseBody& body)
      : devices_(devices), body_(body), joints_(scored_joints(layout, body)) {}

  /// `kinect`: the Kinect's joints before any device was removed.
  void add(const PoseSequence& truth, const JointFrames& kinect, const FusedPose& answer) {
    const auto roots = true_roots(truth);
    const auto predicted = bone_positions(body_, truth.rest_offsets, answer.rotations);
    const auto real = bone_positions(body_, truth.rest_offsets, truth.rotations);
    // From nodes alone the heading can't be found, so its error is removed. With a Kinect the error
    // counts.
    const Eigen::Quaternionf turn = devices_ == Devices::nodes ? heading_turn(answer.root, roots)
                                                               : Eigen::Quaternionf::Identity();
    const std::size_t joints = body_.skeleton.joints();
    for (std::size_t t = 0; t < truth.frames(); ++t) {
      place_.add(100.0 * (answer.place[t].cast<double>() - truth.places[t]).norm());
      const Eigen::Quaternionf root = turn * answer.root[t];
      for (const ScoredJoint& joint : joints_) {
        const auto at = [&](const std::vector<float>& places) {
          return Eigen::Vector3f(
              Eigen::Map<const Eigen::Vector3f>(&places[3 * (t * joints + joint.body)]));
        };
        const Eigen::Vector3f place = roots[t] * at(real);
        const double off_cm = 100.0 * static_cast<double>((root * at(predicted) - place).norm());
        all_.add(off_cm);
        if (!joint.kinect) continue;
        const Eigen::Vector3f in_world = place + truth.places[t].cast<float>();
        if (is_hidden(kinect, t, *joint.kinect, in_world)) {
          hidden_.add(off_cm);
        } else {
          seen_[static_cast<std::size_t>(joint.group)].add(off_cm);
        }
      }
    }
    // SIP comes from the metrics of poses; it is relative to the root and needs no heading.
    errors_.add(pose_errors(body_, answer.rotations, {truth.rotations, truth.rest_offsets}, 30.0));
    frames_ += truth.frames();
  }

  void add(const FuseScore& more) {
    all_.add(more.all_);
    place_.add(more.place_);
    hidden_.add(more.hidden_);
    for (std::size_t group = 0; group < seen_.size(); ++group) seen_[group].add(more.seen_[group]);
    errors_.add(more.errors_);
    frames_ += more.frames_;
  }

  FuseErrors errors() const {
    return {.all_cm = all_.value_or(0.0),
            .hidden_cm = hidden_.value_or(0.0),
            .seen_trunk_cm = seen_[0].value_or(0.0),
            .seen_arms_cm = seen_[1].value_or(0.0),
            .seen_legs_cm = seen_[2].value_or(0.0),
            .place_cm = place_.value_or(0.0),
            .sip_deg = errors_.sip_deg,
            .frames = frames_,
            .hidden = hidden_.count()};
  }

 private:
  /// True if the joint is not tracked, or is tracked but too far from the truth.
  static bool is_hidden(const JointFrames& kinect, std::size_t t, std::size_t j,
                        const Eigen::Vector3f& true_place) {
    const std::size_t at = t * kinect.joints + j;
    if (kinect.seen[at] != 2) return true;
    const Eigen::Map<const Eigen::Vector3f> measured(&kinect.positions[3 * at]);
    return (measured - true_place).norm() > invented_m;
  }

  Devices devices_;
  const PoseBody& body_;
  std::vector<ScoredJoint> joints_;
  Mean all_, hidden_, place_;
  std::array<Mean, 3> seen_;
  PoseErrors errors_;
  std::size_t frames_ = 0;
};

/// Marks the data of all other devices as missing. Only states and flags change, so the arrays keep
/// their shapes.
FuseInput without_others(FuseInput input, Devices devices) {
  if (devices == Devices::kinect) lose_nodes(input.nodes);
  if (devices == Devices::nodes) lose_kinect(input.kinect);
  return input;
}

/// The sequences of a person one after another. Each node's errors are constant over the session.
/// The headings can be estimated only over tens of seconds, which is longer than a sequence.
struct Session {
  FuseInput input;
  std::vector<std::size_t> sequences;
};

void append_rows(const auto& from, auto& to) { to.insert(to.end(), from.begin(), from.end()); }

/// Joins the test sequences of each person and adds node errors.
std::map<std::string, Session> sessions_of(const FuseData& data, const NodeErrors& errors) {
  std::map<std::string, Session> out;
  for (std::size_t i = 0; i < data.pose.tested.size(); ++i) {
    const PoseSequence& one = data.pose.tested[i];
    Session& session = out[one.subject];
    session.sequences.push_back(i);
    FuseInput& input = session.input;
    input.nodes.nodes = one.nodes.nodes;
    append_rows(one.nodes.orientation, input.nodes.orientation);
    append_rows(one.nodes.acceleration, input.nodes.acceleration);
    append_rows(one.nodes.angular_velocity, input.nodes.angular_velocity);
    append_rows(one.nodes.valid, input.nodes.valid);
    input.kinect.joints = data.tested[i].front().joints;
    append_rows(data.tested[i].front().positions, input.kinect.positions);
    append_rows(data.tested[i].front().seen, input.kinect.seen);
  }
  std::uint64_t person = 0;
  for (auto& [name, session] : out) {
    session.input.nodes =
        with_errors(std::move(session.input.nodes), errors, {fuse_marks_seed, ++person});
  }
  return out;
}

/// The errors that a calibration leaves, with all nodes present. Only hide_limbs() causes losses.
NodeErrors session_errors(double yaw_deg) {
  NodeErrors out;
  out.yaw_deg = yaw_deg;
  out.lost_share = 0.0;
  return out;
}

/// The rotation about the vertical from a node's orientation to that of its bone, rad; mean over
/// frames.
double heading_error(const NodeFrames& clean, const NodeFrames& measured, std::size_t n) {
  double sum = 0.0, count = 0.0;
  for (std::size_t t = 0; t < measured.frames(); ++t) {
    const auto a = orientation_at(clean, t, n), b = orientation_at(measured, t, n);
    if (!a || !b) continue;
    const Eigen::Quaternionf turn = *a * b->conjugate();
    const double yaw =
        2.0 * std::atan2(static_cast<double>(turn.y()), static_cast<double>(turn.w()));
    sum += std::remainder(yaw, 2.0 * std::numbers::pi);
    count += 1.0;
  }
  return count > 0.0 ? sum / count : 0.0;
}

double size_deg(double radians) { return std::abs(radians) * 180.0 / std::numbers::pi; }

}  // namespace

/// Runs the method once per person and device choice, and scores each sequence.
Result<std::vector<FuseMark>> fuse_marks(const Fusion& fusion, const FuseLayout& layout,
                                         const FuseData& data,
                                         const std::vector<Devices>& devices) {
  if (data.pose.tested.empty()) return Failure(Error{"", 0, "people of a test part", "none"});
  FuseData hidden = data;
  for (auto& one : hidden.tested) hide_limbs(layout, one.front());
  std::vector<FuseMark> out;
  for (const Devices these : devices) {
    FuseMark& mark = out.emplace_back(FuseMark{.devices = these});
    FuseScore all(these, layout, data.pose.body);
    for (auto& [name, session] : sessions_of(hidden, session_errors(10.0))) {
      const FuseInput seen = session.input;
      session.input = without_others(std::move(session.input), these);
      const FusedPose pose = fusion(session.input);
      FuseScore score(these, layout, data.pose.body);
      const std::size_t bones = layout.nodes.bones.size();
      std::size_t begin = 0;
      for (const std::size_t i : session.sequences) {
        const PoseSequence& truth = data.pose.tested[i];
        const auto at = static_cast<std::ptrdiff_t>(begin);
        const auto end = at + static_cast<std::ptrdiff_t>(truth.frames());
        const auto width = static_cast<std::ptrdiff_t>(bones);
        const FusedPose part{
            {pose.rotations.begin() + at * width, pose.rotations.begin() + end * width},
            {pose.root.begin() + at, pose.root.begin() + end},
            {pose.place.begin() + at, pose.place.begin() + end}};
        score.add(truth, hidden.tested[i].front(), part);
        begin += truth.frames();
      }
      all.add(score);
      mark.people.emplace(name, score.errors());
    }
    // This mean is over all frames of all people, so long sessions count more.
    mark.all = all.errors();
  }
  return out;
}

std::vector<HeadingMark> heading_marks(const HeadingsOf& headings, const FuseLayout& layout,
                                       const FuseData& data) {
  NodeErrors errors = session_errors(20.0);
  const auto after = static_cast<std::size_t>(heading_seconds * layout.nodes.rate_hz);
  std::vector<HeadingMark> out;
  for (const std::string& node : layout.nodes.nodes) out.push_back({.node = node});
  // crop_of() needs the sides, although this function mirrors nothing.
  const Sides sides(data.pose.body, layout.nodes.nodes, layout.joints);
  const auto truths = sessions_of(data, no_node_errors());
  for (const auto& [name, session] : sessions_of(data, errors)) {
    // A session shorter than 60 s can't show the error after 60 s.
    if (session.input.frames() <= after) continue;
    const Crop first{.begin = 0, .count = after};
    const FuseInput shown{crop_of(session.input.nodes, first, sides),
                          crop_of(session.input.kinect, first, sides)};
    const auto found = headings(shown);
    // The heading estimated for the last frame is applied to all frames, because it uses all 60 s.
    std::vector<HeadingState> last;
    for (std::size_t t = 0; t < after; ++t) {
      last.insert(last.end(), found.end() - static_cast<std::ptrdiff_t>(out.size()), found.end());
    }
    const NodeFrames after_it = with_headings(shown.nodes, last);
    for (std::size_t n = 0; n < out.size(); ++n) {
      const NodeFrames& clean = truths.at(name).input.nodes;
      const double left = size_deg(heading_error(clean, after_it, n));
      out[n].before_deg += size_deg(heading_error(clean, shown.nodes, n));
      out[n].after_deg += left;
      out[n].worst_deg = std::max(out[n].worst_deg, left);
      out[n].people.emplace(name, left);
    }
  }
  for (HeadingMark& mark : out) {
    const double people = static_cast<double>(std::max<std::size_t>(mark.people.size(), 1));
    mark.before_deg /= people;
    mark.after_deg /= people;
  }
  return out;
}

}  // namespace kinalign
