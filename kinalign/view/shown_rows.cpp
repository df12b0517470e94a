// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/shown_rows.h"

#include "kinalign/motion/arrays.h"
#include "kinalign/motion/kinect_joints.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <numbers>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view time_properties =
    R"({"type": "object", "properties": {"sec": {"type": "integer"}, "nsec": {"type": "integer"}}})";

McapSchema schema(std::string name, const std::string& properties) {
  return {0, std::move(name), "jsonschema",
          R"({"type": "object", "properties": {"timestamp": )" + std::string(time_properties) +
              R"(, "interval_ns": {"type": "integer"}, )" + properties + "}}"};
}

Json time_json(Time at) {
  const std::int64_t ns = to_ns(at);
  constexpr std::int64_t second = 1'000'000'000;
  // Division rounds towards zero, but `nsec` must not be negative.
  const std::int64_t sec = ns / second - (ns % second < 0 ? 1 : 0);
  return {{"sec", sec}, {"nsec", ns - sec * second}};
}

Json vector_json(const Vec3& v) { return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}}; }
Json rotation_json(const Quat& q) {
  return {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}};
}

/// Names in files may contain bytes that are not UTF-8. They are replaced, so that the conversion
/// continues.
std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// A transform as viewers define it: position and rotation of `child` in the space of `parent`.
struct Frame {
  std::string parent, child;
  Vec3 place = Vec3::Zero();
  Quat turn = Quat::Identity();
};

Json frame_json(const Frame& frame, const Json& time) {
  return {{"timestamp", time},
          {"parent_frame_id", frame.parent},
          {"child_frame_id", frame.child},
          {"translation", vector_json(frame.place)},
          {"rotation", rotation_json(frame.turn)}};
}

/// Returns the transforms of one moment as one message. The first transform rotates from `world` to
/// `lab`.
std::string frames_json(const std::vector<Frame>& frames, const ShownTime& time) {
  const Json at = time_json(time.at);
  // A quarter turn about x: y in `lab` becomes z in `world`.
  const double half = std::numbers::sqrt2 / 2.0;
  Json list = {
      frame_json({"world", std::string(shown_space), Vec3::Zero(), {half, half, 0, 0}}, at)};
  for (const Frame& frame : frames) list.push_back(frame_json(frame, at));
  return text_of({{"transforms", std::move(list)}});
}

/// A message begins with its time, for programs that don't read log times.
Json begun_json(const ShownTime& time) {
  Json json{{"timestamp", time_json(time.at)}};
  if (time.half_width) json["interval_ns"] = time.half_width->count();
  return json;
}

/// Returns the nearest ancestor of a Kinect's joint that is not missing; absent if there is none.
/// In kinect_parents the root is its own parent, which ends the loop.
std::optional<std::size_t> ancestor(const PointFrames& frames, std::size_t row, std::size_t joint) {
  while (kinect_parents[joint] != joint) {
    joint = kinect_parents[joint];
    if (frames.state[row + joint] != Tracking::missing) return joint;
  }
  return std::nullopt;
}

}  // namespace

/// Returns the JSON schema of foxglove.FrameTransforms.
McapSchema transforms_schema() {
  return {0, "foxglove.FrameTransforms", "jsonschema",
          R"({"type": "object", "properties": {"transforms": {"type": "array", "items": )"
          R"({"type": "object", "properties": {"timestamp": )" +
              std::string(time_properties) +
              R"(, "parent_frame_id": {"type": "string"}, "child_frame_id": {"type": "string"}, )"
              R"("translation": {"type": "object", "properties": {"x": {"type": "number"}, )"
              R"("y": {"type": "number"}, "z": {"type": "number"}}}, "rotation": )"
              R"({"type": "object", "properties": {"x": {"type": "number"}, "y": )"
              R"({"type": "number"}, "z": {"type": "number"}, "w": {"type": "number"}}}}}}}})"};
}

McapSchema pose_schema() { return schema("kinalign.Pose", R"("joints": {"type": "object"})"); }
McapSchema points_schema() { return schema("kinalign.Points", R"("joints": {"type": "object"})"); }
McapSchema imu_schema() {
  return schema("kinalign.ImuSample",
                R"("valid": {"type": "boolean"}, "orientation": {"type": "object"}, )"
                R"("acceleration": {"type": "object"}, "angular_velocity": {"type": "object"})");
}

std::string transforms_json(const std::string& stream, const Skeleton& skeleton,
                            const ClipFrames& frames, std::size_t t, const ShownTime& time) {
  std::vector<Frame> out;
  for (std::size_t j = 0; j < skeleton.joints(); ++j) {
    const std::size_t at = t * skeleton.joints() + j;
    const int parent = skeleton.parents[j];
    // A root's position is in the lab, where the device saw it.
    out.push_back({parent < 0
                       ? std::string(shown_space)
                       : stream + "/" + skeleton.joint_names[static_cast<std::size_t>(parent)],
                   stream + "/" + skeleton.joint_names[j], vec3(frames.local_positions, at),
                   quat(frames.local_rotations, at)});
  }
  return frames_json(out, time);
}

std::string transforms_json(const std::string& stream, const std::vector<std::string>& joints,
                            const PointFrames& frames, std::size_t t, const ShownTime& time) {
  const std::size_t row = t * joints.size();
  // Bones of other points are not known, so each point is in the lab's space.
  const bool kinect =
      std::equal(joints.begin(), joints.end(), kinect_joints.begin(), kinect_joints.end());
  std::vector<Frame> out;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (frames.state[row + j] == Tracking::missing) continue;
    const auto parent = kinect ? ancestor(frames, row, j) : std::nullopt;
    const Vec3 place = vec3(frames.positions, row + j);
    // Points have no rotation, so the position in the parent's space is the difference of
    // positions.
    const Vec3 from = parent ? Vec3(vec3(frames.positions, row + *parent)) : Vec3(Vec3::Zero());
    out.push_back({parent ? stream + "/" + joints[*parent] : std::string(shown_space),
                   stream + "/" + joints[j], place - from, Quat::Identity()});
  }
  return frames_json(out, time);
}

/// Returns a pose: each joint's position and rotation in its parent's space.
std::string joints_json(const Skeleton& skeleton, const ClipFrames& frames, std::size_t t,
                        const ShownTime& time) {
  Json json = begun_json(time), joints = Json::object();
  for (std::size_t j = 0; j < skeleton.joints(); ++j) {
    const std::size_t at = t * skeleton.joints() + j;
    joints[skeleton.joint_names[j]] = {
        {"position", vector_json(vec3(frames.local_positions, at))},
        {"rotation", rotation_json(quat(frames.local_rotations, at))}};
  }
  json["joints"] = std::move(joints);
  return text_of(json);
}

/// Returns points with their states. A missing point has no position.
std::string joints_json(const std::vector<std::string>& joints, const PointFrames& frames,
                        std::size_t t, const ShownTime& time) {
  constexpr std::array<std::string_view, 3> states{"missing", "inferred", "tracked"};
  Json json = begun_json(time), shown = Json::object();
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const std::size_t at = t * joints.size() + j;
    Json one = {{"state", states[static_cast<std::size_t>(frames.state[at])]}};
    if (frames.state[at] != Tracking::missing) {
      one["position"] = vector_json(vec3(frames.positions, at));
    }
    shown[joints[j]] = std::move(one);
  }
  json["joints"] = std::move(shown);
  return text_of(json);
}

std::string imu_json(const ImuContent& content, const ImuSamples& samples, std::size_t cell,
                     const ShownTime& time) {
  Json json = begun_json(time);
  json["valid"] = samples.valid[cell] != 0;
  // An invalid sample has no values, but its time is written.
  if (samples.valid[cell] == 0) return text_of(json);
  if (content.orientation) json["orientation"] = rotation_json(quat(samples.orientation, cell));
  if (content.acceleration) json["acceleration"] = vector_json(vec3(samples.acceleration, cell));
  if (content.angular_velocity) {
    json["angular_velocity"] = vector_json(vec3(samples.angular_velocity, cell));
  }
  return text_of(json);
}

}  // namespace kinalign
