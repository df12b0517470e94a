// SPDX-License-Identifier: Apache-2.0
// Resamples live nodes and calibrates them by a T-pose, so that they have the orientations of their
// bones. Frames before the end of the T-pose are output together once the calibration is known.
#pragma once

#include "kinalign/models/pose/live_nodes.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

/// Start and end of a T-pose, s.
struct TPoseSeconds {
  double from = 0.0, to = 0.0;
};

struct LiveWornOptions {
  /// The T-pose, counted from the first frame. Absent: the first stretch without motion is used.
  std::optional<TPoseSeconds> t_pose{};
  std::optional<Headings> headings{};  // see CalibrationOptions
};

/// A calibration, and the frames of the grid that it was computed from.
struct LiveCalibration {
  NodeCalibration nodes;
  std::size_t first = 0, count = 0;
  double fastest_deg_s = 0.0;  // fastest rotation of a node in these frames
  bool found = false;          // true: neither a mark nor an option stated the T-pose
};

/// One frame of the grid with calibrated nodes.
struct LiveWornFrame {
  Time stamp{};
  NodeFrames nodes;  // one frame
};

/// Frames of the grid are numbered from the root's first sample on. `recent_` contains the frames
/// `forgotten_` ... `made_` - 1, so frame f has the index f - `forgotten_` in it.
class LiveWorn {
 public:
  /// After a mark, the T-pose is expected to be held for this long.
  static constexpr double held_s = 2.0;
  /// Frames before the calibration are kept for at most this long. The output begins with them.
  static constexpr double most_waiting_s = 60.0;

  /// `layout` and `body` must outlive this object.
  LiveWorn(const PoseLayout& layout, const Skeleton& body, const LiveWornOptions& options);

  /// Adds a sample of node `node` of the layout. Frames are made by advance().
  void add(std::size_t node, const NodeReadings& sample) { nodes_.add(node, sample); }
  /// States that the person holds a T-pose from `at` on. The nodes are calibrated, or calibrated
  /// again, unless the person moves or an arm hangs down in it. Call only after nodes().begin() is
  /// known.
  void mark_t_pose(Time at) { marked_ = std::max(at, time_of(forgotten_)); }

  /// Whether the other devices also have their data for a frame at that time.
  using Also = std::function<bool(Time time)>;
  /// Makes all frames that are ready and appends the calibrated ones to `out`. `now`: arrival of
  /// the newest message.
  void advance(Time now, const Also& also, std::vector<LiveWornFrame>& out);
  /// Call when no further samples come: makes the frames up to the root's last sample.
  void finish(std::vector<LiveWornFrame>& out);

  const LiveNodes& nodes() const { return nodes_; }
  /// The current calibration; absent until a T-pose was found.
  const std::optional<LiveCalibration>& calibration() const { return calibration_; }
  /// The reason why the last T-pose was refused; each reason is returned once.
  std::optional<std::string> take_refusal() { return std::exchange(refusal_, std::nullopt); }

 private:
  // make_frame() drives the rest: it appends a frame, looks for a T-pose and hands frames on.
  Time time_of(std::size_t frame) const;
  void make_frame(std::vector<LiveWornFrame>& out);
  void look_for_t_pose();
  std::optional<TPose> wanted_t_pose() const;
  std::optional<std::string> fault_of(const NodeCalibration& found) const;
  bool take_t_pose(const TPose& t_pose);
  void forget_t_pose(const TPose& t_pose);
  void hand_on(std::vector<LiveWornFrame>& out);

  const PoseLayout* layout_;
  const Skeleton* body_;
  LiveWornOptions options_;
  LiveNodes nodes_;
  std::size_t made_ = 0;       // number of frames of the grid made so far
  WornFrames recent_;          // the newest frames, for calibrations
  std::size_t forgotten_ = 0;  // number of frames of the grid dropped before recent_
  std::size_t searched_ = 0;   // index in recent_: the search for a T-pose starts here
  std::size_t tried_ = 0;      // value of made_ at the last attempt to calibrate; 0: none
  std::optional<Time> marked_;
  std::optional<LiveCalibration> calibration_;
  std::size_t handed_on_ = 0;  // number of frames of recent_ already output
  std::optional<std::string> refusal_;
};

}  // namespace kinalign
