// SPDX-License-Identifier: Apache-2.0
// Reads head and frames of an MVNX file, in the file's own units and axes. Layout:
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

/// A landmark of a segment: the position of a joint, or the tip of a limb.
struct MvnxPoint {
  std::string label;
  Vec3 place = Vec3::Zero();  // m, in the segment's space
};

struct MvnxSegment {
  std::string label;
  std::vector<MvnxPoint> points;
};

/// A joint connects a point of one segment with a point of another: "Pelvis/jL5S1" and "L5/jL5S1".
struct MvnxJoint {
  std::string parent, parent_point, child, child_point;
};

/// Everything before the first frame. Arrays in frames have the order of these segments and
/// sensors.
struct MvnxHead {
  double rate_hz = 0.0;  // 0: not stated in the file
  std::vector<MvnxSegment> segments;
  std::vector<std::string> sensors;
  std::vector<MvnxJoint> joints;
};

/// One frame. An array is empty if the frame does not have it, or if it contains anything but
/// numbers below 1e15.
struct MvnxFrame {
  std::string type;                              // "normal", "identity", "tpose", "tpose-isb"
  std::optional<double> index;                   // counted from 0
  std::optional<double> ms, unix_ms;             // ms since the first frame; ms since 1970
  std::vector<double> orientation;               // [segments,4] w,x,y,z global_from_segment
  std::vector<double> position;                  // [segments,3] m
  std::vector<double> sensor_orientation;        // [sensors,4] global_from_sensor
  std::vector<double> sensor_acceleration;       // [sensors,3] m/s2, in the sensor's space
  std::vector<double> sensor_free_acceleration;  // [sensors,3] m/s2, global, without gravity
  std::vector<double> sensor_angular_velocity;   // [sensors,3] rad/s, in the sensor's space
};

/// Takes a file in pieces, plain or compressed with gzip. Only the first subject is read. Frames
/// are passed on one at a time, because all frames of a file may not fit into memory.
class MvnxDocument final : private XmlHandler {
 public:
  using UseFrame = std::function<Result<void>(const MvnxHead&, const MvnxFrame&)>;

  /// `use` is called for each frame in the order of the file, including calibration poses.
  MvnxDocument(std::string_view file, UseFrame use);

  Result<void> feed(std::string_view piece);
  /// Call this at the end of the file. If the file is cut off after its first frame, this is a
  /// finding.
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
  // begun_: after the first byte. root_: after the start of the element mvnx. in_frame_: between
  // <frame> and </frame>.
  bool begun_ = false, root_ = false, in_frame_ = false;
  // The number of subjects so far. Everything after the first subject is skipped.
  std::size_t subjects_ = 0, things_ = 0;
  std::uint64_t frames_ = 0;
  std::int64_t line_ = 0;  // line on which the current frame begins
  MvnxHead head_;
  MvnxFrame frame_;
};

}  // namespace kinalign
