// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/rehearsal/judge_recording.h"

#include "kinalign/motion/kinect_map.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace kinalign {

namespace {

// Converts a stamp to its true time; absent if the truth does not cover the stamp.
using TrueTimes = std::function<std::optional<Time>(Time stamp)>;

/// Calls `use` with each block of a stream of type `Input`. Only one block is in memory.
template <class Frames, class Input, class Use>
Result<void> each_block(const Input& input, const Use& use) {
  Pass<Frames> pass = KA_TRY(input.passes());
  Frames block;
  while (KA_TRY(pass(block))) use(block);
  return {};
}

/// Returns the stamps of all samples of a stream.
Result<std::vector<Time>> stamps_of(const RecordedStream& stream) {
  std::vector<Time> stamps;
  const auto add = [&](const auto& block) {
    stamps.insert(stamps.end(), block.stamps.begin(), block.stamps.end());
  };
  if (const auto* clip = std::get_if<ClipInput>(&stream.data)) {
    KA_TRY(each_block<ClipFrames>(*clip, add));
  } else if (const auto* points = std::get_if<PointInput>(&stream.data)) {
    KA_TRY(each_block<PointFrames>(*points, add));
  } else {
    KA_TRY(each_block<ImuSamples>(std::get<ImuInput>(stream.data), add));
  }
  return stamps;
}

/// Returns the name of the node in a stream; empty for a stream without nodes.
std::string node_of(const RecordedStream& stream) {
  const auto* imu = std::get_if<ImuInput>(&stream.data);
  return imu == nullptr || imu->node_names.empty() ? "" : imu->node_names.front();
}

/// Finds a node by its name, or by its number if it has no name.
const TrueNode* true_node(const TrueRecording& truth, const std::string& stream,
                          const std::string& node) {
  const auto found = std::find_if(truth.nodes.begin(), truth.nodes.end(), [&](const TrueNode& one) {
    return one.stream == stream && (one.node == node || std::to_string(one.id) == node);
  });
  return found == truth.nodes.end() ? nullptr : &*found;
}

/// Returns the function from a suit's stamps to true times. The stamps are not those of a clock: in
/// a live recording, a stamp is the frame number times the frame period. Each stamp therefore gives
/// a frame number, and the truth contains the time of that frame.
TrueTimes mocap_times(const TrueRecording& truth, Time first) {
  const TrueMocap& mocap = truth.mocap;
  const Time zero = truth.host ? Time{} : first;
  return [&mocap, zero](Time stamp) -> std::optional<Time> {
    const double frame = std::round(seconds(stamp - zero) * mocap.rate_hz);
    if (!(frame >= 0.0 && frame < static_cast<double>(mocap.frames))) return std::nullopt;
    return utc_time(mocap.frame_ns(static_cast<std::uint64_t>(frame)));
  };
}

/// Returns "imu waist" for a node, or "mocap" for a stream without nodes.
std::string device_name(const std::string& stream, const std::string& node) {
  return node.empty() ? stream : stream + " " + node;
}

std::string true_devices(const TrueRecording& truth) {
  std::string names = truth.mocap.stream + ", " + truth.kinect.stream;
  for (const TrueNode& node : truth.nodes) names += ", " + device_name(node.stream, node.node);
  return names;
}

/// Returns the function from the stream's stamps to true times. Fails if the truth does not contain
/// the device.
Result<TrueTimes> true_times(const RecordedStream& stream, const TrueRecording& truth, Time first) {
  if (stream.name == truth.mocap.stream) return mocap_times(truth, first);
  const TrueClock* clock = nullptr;
  if (stream.name == truth.kinect.stream) clock = &truth.kinect.clock;
  if (const TrueNode* node = true_node(truth, stream.name, node_of(stream))) clock = &node->clock;
  if (clock == nullptr) {
    return Failure(Error{"", 0, "a device that the truth has (" + true_devices(truth) + ")",
                         shown(device_name(stream.name, node_of(stream)))});
  }
  return TrueTimes([clock](Time stamp) { return true_time(*clock, stamp); });
}

// Returns the value at this share of the sorted list, 0 to 1.
double quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return 0.0;
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

/// Computes a root mean square from a sum of squares, without storing the errors.
struct Rms {
  double sum = 0.0;
  std::uint64_t count = 0;

  void add(double square) {
    sum += square;
    ++count;
  }
  double value() const { return count == 0 ? 0.0 : std::sqrt(sum / static_cast<double>(count)); }
};

/// The true pose at any time on the axis of the stamps. Each pose overwrites the previous one.
class TruthAt {
 public:
  explicit TruthAt(const JudgedTake& judged)
      : motion_(judged.motion), zero_(utc_time(judged.truth.start_ns) + judged.shift) {}

  const GlobalPose& pose(Time t, double ahead_s = 0.0) {
    motion_.pose_at(seconds(t - zero_) + ahead_s, local_);
    forward_kinematics(motion_.skeleton, local_, global_);
    return global_;
  }
  /// Returns the angular rate of each joint's bone, rad/s.
  std::vector<double> rates(Time t) {
    constexpr double h = 2e-3;
    const std::vector<Quat> before = pose(t, -h).rotations;
    const std::vector<Quat>& behind = pose(t, h).rotations;
    std::vector<double> rates;
    for (std::size_t j = 0; j < before.size(); ++j) {
      rates.push_back(before[j].angularDistance(behind[j]) / (2.0 * h));
    }
    return rates;
  }
  /// Returns the index of the joint. If the motion has no such joint, returns the number of joints.
  std::size_t joint(const std::string& name) const {
    const auto& names = motion_.skeleton.joint_names;
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  }

 private:
  const Motion& motion_;
  Time zero_;
  Pose local_;
  GlobalPose global_;
};

// Finds a stream. In a recording, each node has its own stream, and all have the same name.
const RecordedStream* stream_of(const JudgedTake& judged, const std::string& name,
                                const std::string& node = "") {
  for (const RecordedStream& stream : judged.recording.streams) {
    if (stream.name == name && (node.empty() || node_of(stream) == node)) return &stream;
  }
  return nullptr;
}

/// Returns the function from stamps to true times, both on the axis of the stamps. UTC of the
/// recording may differ from UTC of the truth by `shift`.
Result<TrueTimes> moved_times(const RecordedStream& stream, const JudgedTake& judged) {
  const std::vector<Time> stamps = KA_TRY(stamps_of(stream));
  const Time first = stamps.empty() ? Time{} : stamps.front();
  const TrueTimes times = KA_TRY(true_times(stream, judged.truth, first));
  return TrueTimes([times, shift = judged.shift](Time stamp) -> std::optional<Time> {
    const auto at = times(stamp);
    return at ? std::optional(*at + shift) : std::nullopt;
  });
}

/// Compares the joints in a skeleton's rows with the truth.
ValueJudgement judge_clip(const JudgedTake& judged, std::size_t g, const ClipGroup& group) {
  TruthAt truth(judged);
  Rms error;
  const std::size_t joints = group.skeleton.joints();
  const auto& rows = std::get<ClipRows>(judged.take.all.rows[g]);
  std::vector<std::size_t> places;
  for (const std::string& name : group.skeleton.joint_names) places.push_back(truth.joint(name));
  for (std::size_t t = 0; t < judged.take.all.stamps.size(); ++t) {
    if (!rows.valid.empty() && rows.valid[t] == 0) continue;
    const GlobalPose& pose = truth.pose(judged.take.all.stamps[t]);
    for (std::size_t j = 0; j < joints; ++j) {
      // If the motion does not have the joint, the joint can't be judged.
      if (places[j] >= pose.positions.size()) continue;
      error.add((pose.positions[places[j]] - vec3(rows.positions, t * joints + j)).squaredNorm());
    }
  }
  return {judged.take.header.groups[g].name,
          "",
          error.count,
          std::nullopt,
          error.value(),
          std::nullopt};
}

/// Compares the valid points in a take's rows with the truth.
Rms points_in_take(const JudgedTake& judged, std::size_t g, const KinectMap& map) {
  TruthAt truth(judged);
  std::vector<double> known(3 * kinect_joints.size());
  Rms error;
  const auto& rows = std::get<PointRows>(judged.take.all.rows[g]);
  for (std::size_t t = 0; t < judged.take.all.stamps.size(); ++t) {
    kinect_positions(map, truth.pose(judged.take.all.stamps[t]), known);
    for (std::size_t j = 0; j < kinect_joints.size(); ++j) {
      const std::size_t i = t * kinect_joints.size() + j;
      if (rows.valid[i] == 0) continue;
      error.add((vec3(known, j) - vec3(rows.positions, i)).squaredNorm());
    }
  }
  return error;
}

/// Compares the points of a stream with the truth: as sent, with the true camera position, and in
/// the take.
Result<ValueJudgement> judge_points(const JudgedTake& judged, std::size_t g) {
  const std::string& name = judged.take.header.groups[g].name;
  const KinectMap map = KA_TRY(kinect_map(judged.motion.skeleton));
  const RecordedStream* stream = stream_of(judged, name);
  if (stream == nullptr || !std::holds_alternative<PointInput>(stream->data)) {
    return Failure(Error{"", 0, "the recording's stream " + name, "none"});
  }
  const TrueTimes times = KA_TRY(moved_times(*stream, judged));
  const RigidTransform& camera = judged.truth.kinect.world_from_kinect;
  TruthAt truth(judged);
  std::vector<double> known(3 * kinect_joints.size());
  Rms before, alone;
  const auto add = [&](const PointFrames& block) {
    for (std::size_t i = 0; i < block.state.size(); ++i) {
      const std::size_t t = i / kinect_joints.size(), j = i % kinect_joints.size();
      const auto at = times(block.stamps[t]);
      if (at && j == 0) kinect_positions(map, truth.pose(*at), known);
      if (!at || block.state[i] == Tracking::missing) continue;
      const Vec3 seen = vec3(block.positions, i), real = vec3(known, j);
      before.add((real - seen).squaredNorm());
      // With the true time and the true camera position, only the sensor's own error is left.
      alone.add((real - camera * seen).squaredNorm());
    }
  };
  KA_TRY(each_block<PointFrames>(std::get<PointInput>(stream->data), add));
  const Rms after = points_in_take(judged, g, map);
  return ValueJudgement{name, "", after.count, before.value(), after.value(), alone.value()};
}

/// Compares one node with the truth: its column in the take, and its stream.
Result<ValueJudgement> judge_node(const JudgedTake& judged, std::size_t g, std::size_t column,
                                  std::size_t columns, const TrueNode& node) {
  const TakeGroup& group = judged.take.header.groups[g];
  const std::string& name = std::get<ImuGroup>(group.kind).node_names[column];
  const auto& rows = std::get<ImuRows>(judged.take.all.rows[g]);
  TruthAt truth(judged);
  const std::size_t joint = truth.joint(node.joint);
  if (joint == judged.motion.skeleton.joints()) {
    return Failure(Error{"", 0, "a joint of the motion that " + name + " is worn on", node.joint});
  }
  // The chip's filter delays the rate, so the true value is taken earlier by this delay.
  const Duration delay{std::llround(node.sensor_delay_ms * 1e6)};
  const auto off = [&](Time t, const Vec3& rate) {
    const double by = rate.norm() - truth.rates(t - delay).at(joint);
    return by * by;
  };
  Rms after, alone;
  for (std::size_t t = 0; t < judged.take.all.stamps.size(); ++t) {
    const std::size_t i = t * columns + column;
    if (rows.valid[i] != 0)
      after.add(off(judged.take.all.stamps[t], vec3(rows.angular_velocity, i)));
  }
  // The stream without alignment is compared in the same way.
  const RecordedStream* stream = stream_of(judged, group.name, name);
  if (stream == nullptr) return Failure(Error{"", 0, "the recording's node " + name, "none"});
  const TrueTimes times = KA_TRY(moved_times(*stream, judged));
  KA_TRY(each_block<ImuSamples>(std::get<ImuInput>(stream->data), [&](const ImuSamples& block) {
    for (std::size_t t = 0; t < block.size(); ++t) {
      const auto at = times(block.stamps[t]);
      if (at && block.valid[t] != 0) alone.add(off(*at, vec3(block.angular_velocity, t)));
    }
  }));
  return ValueJudgement{group.name, name, after.count, std::nullopt, after.value(), alone.value()};
}

// If a group has no angular rates, it is not judged.
Result<std::vector<ValueJudgement>> judge_nodes(const JudgedTake& judged, std::size_t g) {
  const TakeGroup& group = judged.take.header.groups[g];
  const auto& imu = std::get<ImuGroup>(group.kind);
  std::vector<ValueJudgement> nodes;
  for (std::size_t n = 0; n < imu.node_names.size() && imu.content.angular_velocity; ++n) {
    const TrueNode* node = true_node(judged.truth, group.name, imu.node_names[n]);
    if (node == nullptr) continue;
    nodes.push_back(KA_TRY(judge_node(judged, g, n, imu.node_names.size(), *node)));
  }
  return nodes;
}

}  // namespace

// Stamps without a true time are not counted.
Result<TimeJudgement> judge_time(const RecordedStream& stream, const TrueRecording& truth,
                                 Duration shift) {
  const std::vector<Time> stamps = KA_TRY(stamps_of(stream));
  const TrueTimes times =
      KA_TRY(true_times(stream, truth, stamps.empty() ? Time{} : stamps.front()));
  TimeJudgement judgement;
  judgement.stream = stream.name;
  judgement.node = node_of(stream);
  std::vector<double> errors;
  for (const Time stamp : stamps) {
    const auto at = times(stamp);
    if (!at) continue;
    errors.push_back(std::abs(seconds(take_time(stream.clock, stamp) - (*at + shift))));
    // The interval is checked only if the clock states one.
    const auto width = half_width(stream.clock, stamp);
    if (!width) continue;
    ++judgement.certified;
    judgement.half_width_s = std::max(judgement.half_width_s.value_or(0.0), seconds(*width));
    if (errors.back() > seconds(*width)) ++judgement.outside;
  }
  std::sort(errors.begin(), errors.end());
  judgement.samples = errors.size();
  judgement.median_s = quantile(errors, 0.5);
  judgement.most_s = quantile(errors, 0.95);
  judgement.worst_s = quantile(errors, 1.0);
  return judgement;
}

// Mean squares are added, weighted by rows, because means of roots would be wrong.
ValueJudgement together(std::span<const ValueJudgement> nodes) {
  ValueJudgement all{nodes.front().stream, "all nodes", 0, std::nullopt, 0.0, 0.0};
  for (const ValueJudgement& node : nodes) {
    const auto rows = static_cast<double>(node.count);
    all.count += node.count;
    all.after += rows * node.after * node.after;
    all.alone = *all.alone + rows * node.alone.value_or(0.0) * node.alone.value_or(0.0);
  }
  const double rows = std::max(1.0, static_cast<double>(all.count));
  all.after = std::sqrt(all.after / rows);
  all.alone = std::sqrt(*all.alone / rows);
  return all;
}

// Groups whose devices are not in the truth are omitted.
Result<std::vector<ValueJudgement>> judge_values(const JudgedTake& judged) {
  std::vector<ValueJudgement> out;
  const auto& groups = judged.take.header.groups;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (const auto* clip = std::get_if<ClipGroup>(&groups[g].kind)) {
      if (groups[g].name == judged.truth.mocap.stream) out.push_back(judge_clip(judged, g, *clip));
    } else if (std::holds_alternative<PointGroup>(groups[g].kind)) {
      if (groups[g].name == judged.truth.kinect.stream)
        out.push_back(KA_TRY(judge_points(judged, g)));
    } else {
      const auto nodes = KA_TRY(judge_nodes(judged, g));
      out.insert(out.end(), nodes.begin(), nodes.end());
      if (nodes.size() > 1) out.push_back(together(nodes));
    }
  }
  return out;
}

}  // namespace kinalign
