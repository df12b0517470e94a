// SPDX-License-Identifier: Apache-2.0
// Reads the content of an MVNX file, head and frames, in its own units and axes. Layout:
// docs/formats/mvnx.md.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/formats/mvnx/gunzip.h"
#include "kinalign/motion/arrays.h"
#include "kinalign/syntax/xml_feed.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// A landmark of a segment: a joint's place, or the tip of a limb.
struct MvnxPoint {
  std::string label;
  Vec3 place = Vec3::Zero();  // m, in the segment's space
};

struct MvnxSegment {
  std::string label;
  std::vector<MvnxPoint> points;
};

/// A joint connects a point of each of two segments: "Pelvis/jL5S1" and "L5/jL5S1".
struct MvnxJoint {
  std::string parent, parent_point, child, child_point;
};

/// Everything before the first frame. Frames refer to segments and sensors by their order here.
struct MvnxHead {
  double rate_hz = 0.0;  // 0: the file does not state it
  std::vector<MvnxSegment> segments;
  std::vector<std::string> sensors;
  std::vector<MvnxJoint> joints;
};

/// One frame. An array is empty if the frame lacks it, or if it holds anything but numbers below
/// 1e15.
struct MvnxFrame {
  std::string type;                              // "normal", "identity", "tpose", "tpose-isb"
  std::optional<double> index;                   // from 0
  std::optional<double> ms, unix_ms;             // since the recording's first frame; since 1970
  std::vector<double> orientation;               // [segments,4] w,x,y,z global_from_segment
  std::vector<double> position;                  // [segments,3] m
  std::vector<double> sensor_orientation;        // [sensors,4] global_from_sensor
  std::vector<double> sensor_acceleration;       // [sensors,3] m/s2, in the sensor's space
  std::vector<double> sensor_free_acceleration;  // [sensors,3] m/s2, global, without gravity
  std::vector<double> sensor_angular_velocity;   // [sensors,3] rad/s, in the sensor's space
};

/// Takes a file in pieces, plain or packed by gzip. Only the first subject is read.
/// Frames are handed on one at a time, because a file has many more of them than fit into memory.
class MvnxDocument final : private XmlHandler {
 public:
  using UseFrame = std::function<Result<void>(const MvnxHead&, const MvnxFrame&)>;

  /// `use` is called for each frame, also for calibration poses, in the order of the file.
  MvnxDocument(std::string_view file, UseFrame use);

  Result<void> feed(std::string_view piece);
  /// Call at the end of the file. If the file was cut after its first frame, that is a finding.
  Result<void> finish(Findings& findings);

  const std::string& file() const { return file_; }

 private:
  Result<void> begin(std::string_view name, const XmlAttributes& attributes) override;
  Result<void> end(std::string_view name, std::string_view text) override;
  Result<void> begin_in_head(std::string_view name, const XmlAttributes& attributes);
  void begin_frame(const XmlAttributes& attributes);
  Result<void> end_in_head(std::string_view name, std::string_view text);
  void end_in_frame(std::string_view name, std::string_view text);

  std::string file_;
  UseFrame use_;
  std::optional<Gunzip> gunzip_;
  XmlFeed xml_;
  // begun_: the first byte was seen. root_: the element mvnx has begun. in_frame_: between <frame>
  // and </frame>.
  bool begun_ = false, root_ = false, in_frame_ = false;
  // Subjects seen so far: everything after the first one is skipped.
  std::size_t subjects_ = 0, things_ = 0;
  std::uint64_t frames_ = 0;
  std::int64_t line_ = 0;  // line on which the frame begins
  MvnxHead head_;
  MvnxFrame frame_;
};

}  // namespace kinalign
