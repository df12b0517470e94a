// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/streams/xsens_pose.h"

#include "kinalign/formats/axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace kinalign {

namespace {

constexpr std::array<std::string_view, xsens_segments> names{"Pelvis",
                                                             "L5",
                                                             "L3",
                                                             "T12",
                                                             "T8",
                                                             "Neck",
                                                             "Head",
                                                             "RightShoulder",
                                                             "RightUpperArm",
                                                             "RightForeArm",
                                                             "RightHand",
                                                             "LeftShoulder",
                                                             "LeftUpperArm",
                                                             "LeftForeArm",
                                                             "LeftHand",
                                                             "RightUpperLeg",
                                                             "RightLowerLeg",
                                                             "RightFoot",
                                                             "RightToe",
                                                             "LeftUpperLeg",
                                                             "LeftLowerLeg",
                                                             "LeftFoot",
                                                             "LeftToe"};
constexpr std::array<int, xsens_segments> parents{-1, 0,  1,  2, 3,  4,  5,  4, 7,  8,  9, 4,
                                                  11, 12, 13, 0, 15, 16, 17, 0, 19, 20, 21};

/// True if all values are plausible. Larger values are not lengths or accelerations. NaN is
/// refused, too, because comparisons with NaN are false.
template <std::size_t n>
bool sound(const std::array<float, n>& values) {
  return std::all_of(values.begin(), values.end(), [](float x) { return std::abs(x) < 1e15F; });
}

std::optional<Quat> unit_quaternion(const std::array<float, 4>& q) {
  const Quat turn(q[0], q[1], q[2], q[3]);
  // The limit is a choice. Floats have an error of 1e-7. A quaternion whose norm differs from 1 by
  // more than 1 % is not a rotation.
  if (!sound(q) || std::abs(turn.norm() - 1.0) > 0.01) return std::nullopt;
  return turn.normalized();
}

/// The values as a vector in the axes of Xsens (z up).
Vec3 vector_of(const std::array<float, 3>& values) { return {values[0], values[1], values[2]}; }

/// The values as a vector in kinalign's axes (y up).
Vec3 ours(const std::array<float, 3>& values) {
  const Vec3 file = vector_of(values);
  return turned(z_up, file.data());
}

/// The pose of one sample in the world. The index is the segment id - 1.
struct Global {
  std::array<Vec3, xsens_segments> places;  // in the stream's unit of length, y up
  // Rotated so that the world and all segments are y up in the rest pose.
  std::array<Quat, xsens_segments> turns;
};

// Computes the global pose. The first 23 items must be the 23 segments, in any order.
Result<Global> global_of(const XsensPose& pose, const std::string& name) {
  const auto refused = [&name](const std::string& expected, const std::string& found) {
    return Failure(Error{name, 0, expected, found});
  };
  if (pose.segments.size() < xsens_segments) {
    return refused("23 segments in a pose", std::to_string(pose.segments.size()));
  }
  const Quat up = rotation_of(z_up);
  Global global;
  std::array<bool, xsens_segments> here{};
  for (std::size_t k = 0; k < xsens_segments; ++k) {
    const XsensSegment& s = pose.segments[k];
    if (s.id < 1 || s.id > static_cast<int>(xsens_segments) ||
        here[static_cast<std::size_t>(s.id - 1)]) {
      return refused("the segments 1 to 23, each once, first in a pose",
                     fmt::format("segment {} as item {}", s.id, k + 1));
    }
    const auto at = static_cast<std::size_t>(s.id - 1);
    const auto turn = unit_quaternion(s.rotation);
    if (!turn || !sound(s.position)) {
      return refused("a finite position and a unit quaternion",
                     fmt::format("other values for {}", names[at]));
    }
    here[at] = true;
    global.places[at] = ours(s.position);
    // Converts a rotation between z-up axes to one between y-up axes. Both sides of the rotation
    // change.
    global.turns[at] = up * *turn * up.conjugate();
  }
  return global;
}

constexpr double centimetre = 0.01;

/// The bits of a sample's shape, see xsens_shape().
constexpr std::uint32_t can_begin = 1, begins_raw = 2, all_raw = 4, none_raw = 8;

/// The segment ids of the trackers. Fails if an id is unknown or occurs twice.
Result<std::vector<std::int32_t>> ids_of(const XsensTrackers& trackers, const std::string& name) {
  std::vector<std::int32_t> ids;
  for (const XsensTracker& t : trackers.trackers) {
    const bool known = t.id >= 1 && t.id <= static_cast<int>(xsens_segments);
    if (!known || std::find(ids.begin(), ids.end(), t.id) != ids.end()) {
      return Failure(Error{name, 0, "trackers of the segments 1 to 23, each once",
                           fmt::format("segment {} as item {}", t.id, ids.size() + 1)});
    }
    ids.push_back(t.id);
  }
  if (ids.empty()) return Failure(Error{name, 0, "a tracker", "none"});
  return ids;
}

}  // namespace

/// The shape is 1 if the global pose can be made. The text of an error is not needed here.
std::uint32_t xsens_shape(const XsensPose& pose) { return global_of(pose, "") ? 1 : 0; }

std::uint32_t xsens_shape(const XsensTrackers& trackers) {
  const auto is_raw = [](const XsensTracker& t) { return t.raw.has_value(); };
  const auto& all = trackers.trackers;
  std::uint32_t shape = ids_of(trackers, "") ? can_begin : 0;
  if (!all.empty() && is_raw(all.front())) shape |= begins_raw;
  if (std::all_of(all.begin(), all.end(), is_raw)) shape |= all_raw;
  if (std::none_of(all.begin(), all.end(), is_raw)) shape |= none_raw;
  return shape;
}

bool XsensFits<XsensTrackers>::operator()(std::uint32_t shape) {
  // A sample can be the first of the stream only if its segments are known and all different.
  if (!raw_ && (shape & can_begin) == 0) return false;
  if (!raw_) raw_ = (shape & begins_raw) != 0;
  return (shape & (*raw_ ? all_raw : none_raw)) != 0;
}

// Chooses the unit of length. Xsens' document says centimetres, but MVN sends metres. If the pelvis
// is 0.3 to 3 units above the lowest segment, the unit is the metre. From 30 units on it is the
// centimetre. If the person lies down, the segment furthest from the pelvis decides.
void XsensPoser::begin(std::span<const double> heights, double reach) {
  const double height = heights[0] - *std::min_element(heights.begin(), heights.end());
  const bool clear = (height >= 0.3 && height < 3.0) || height >= 30.0;
  const bool metres = clear ? height < 3.0 : reach < 3.0;
  metres_per_unit_ = metres ? 1.0 : centimetre;
  findings.push_back({Severity::note,
                      Error{name_, 0, "a unit of length, which the stream does not state",
                            clear ? fmt::format("a pelvis {:.3g} above the lowest segment", height)
                                  : fmt::format("a pelvis {:.3g} above the lowest segment, and a "
                                                "segment {:.3g} from the pelvis",
                                                height, reach)},
                      metres ? "lengths are read as metres" : "lengths are read as centimetres",
                      ""});
}

// Appends a pose. The first pose also determines the unit of length and the skeleton.
Result<void> XsensPoser::append(const XsensPose& pose, Time stamp, ClipFrames& out) {
  const Global global = KA_TRY(global_of(pose, name_));
  if (!skeleton_) {
    std::array<double, xsens_segments> heights{};
    double reach = 0.0;
    for (std::size_t k = 0; k < xsens_segments; ++k) {
      heights[k] = global.places[k].y();
      reach = std::max(reach, (global.places[k] - global.places[0]).norm());
    }
    begin(heights, reach);
  }
  const std::size_t first = out.size() * xsens_segments;
  out.stamps.push_back(stamp);
  out.local_positions.resize(3 * (first + xsens_segments));
  out.local_rotations.resize(4 * (first + xsens_segments));
  for (std::size_t k = 0; k < xsens_segments; ++k) {
    Vec3 place = global.places[k] * metres_per_unit_;
    Quat turn = global.turns[k];
    if (parents[k] >= 0) {
      const auto p = static_cast<std::size_t>(parents[k]);
      const Quat parent = global.turns[p].conjugate();
      // A local rotation is parent^-1 * child. A local position is in the space of the parent.
      place = parent * (place - global.places[p] * metres_per_unit_);
      turn = parent * turn;
    }
    vec3(out.local_positions, first + k) = place;
    put_quat(out.local_rotations, first + k, turn.normalized());
  }
  if (skeleton_) return {};
  skeleton_.emplace();
  skeleton_->joint_names.assign(names.begin(), names.end());
  skeleton_->parents.assign(parents.begin(), parents.end());
  for (std::size_t k = 0; k < xsens_segments; ++k) {
    skeleton_->rest_offsets.push_back(vec3(out.local_positions, first + k));
  }
  return {};
}

Result<void> XsensNodes::begin(const XsensTrackers& trackers) {
  ids_ = KA_TRY(ids_of(trackers, name_));
  for (const std::int32_t id : ids_) {
    header_.node_names.emplace_back(names[static_cast<std::size_t>(id - 1)]);
  }
  const bool raw = trackers.trackers[0].raw.has_value();
  header_.content = {
      .orientation = true, .acceleration = true, .angular_velocity = raw, .gravity = raw};
  return {};
}

namespace {

/// Writes one tracker of a sample, whose values are zero and marked as invalid before.
void put(const XsensTracker& t, std::size_t at, ImuSamples& out) {
  const auto turn = unit_quaternion(t.rotation);
  const bool raw = t.raw.has_value();
  if (!turn || !sound(t.free_acceleration)) return;
  if (raw && !(sound(t.raw->acceleration) && sound(t.raw->angular_velocity))) return;
  // Only the world changes to y up. A tracker keeps its own axes, so its vectors stay unchanged.
  put_quat(out.orientation, at, rotation_of(z_up) * *turn);
  if (raw) {
    vec3(out.acceleration, at) = vector_of(t.raw->acceleration);
    vec3(out.angular_velocity, at) = vector_of(t.raw->angular_velocity);
  } else {
    // The free acceleration is in Xsens' world space. It is rotated into the sensor's space.
    vec3(out.acceleration, at) = turn->conjugate() * vector_of(t.free_acceleration);
  }
  out.valid[at] = 1;
}

}  // namespace

// Appends a sample. Trackers that are not in the first sample are ignored.
Result<void> XsensNodes::append(const XsensTrackers& trackers, Time stamp, ImuSamples& out) {
  if (ids_.empty()) KA_TRY(begin(trackers));
  const auto other_kind = [this](const XsensTracker& t) {
    return t.raw.has_value() != header_.content.angular_velocity;
  };
  if (std::any_of(trackers.trackers.begin(), trackers.trackers.end(), other_kind)) {
    return Failure(
        Error{name_, 0, "items of one size in all samples", "items of 44 and of 68 bytes"});
  }
  const std::size_t first = out.size() * ids_.size(), cells = first + ids_.size();
  out.stamps.push_back(stamp);
  out.orientation.resize(4 * cells);
  out.acceleration.resize(3 * cells);
  if (header_.content.angular_velocity) out.angular_velocity.resize(3 * cells);
  out.valid.resize(cells);
  for (const XsensTracker& t : trackers.trackers) {
    const auto known = std::find(ids_.begin(), ids_.end(), t.id);
    if (known != ids_.end()) put(t, first + static_cast<std::size_t>(known - ids_.begin()), out);
  }
  return {};
}

}  // namespace kinalign
