// SPDX-License-Identifier: Apache-2.0
// Nodes on their bones while their samples come: onto the grid, and calibrated by a T-pose. Frames
// before the end of the T-pose are handed on at once then.
#pragma once

#include "kinalign/models/pose/live_nodes.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

/// From and to, s.
struct TPoseSeconds {
  double from = 0.0, to = 0.0;
};

struct LiveWornOptions {
  std::optional<TPoseSeconds> t_pose{};  // after the first frame; absent: the first still stretch
  std::optional<Headings> headings{};    // as CalibrationOptions has them
};

/// A calibration, and the frames of the grid that it is taken from.
struct LiveCalibration {
  NodeCalibration nodes;
  std::size_t first = 0, count = 0;
  double fastest_deg_s = 0.0;  // turn of a node in them
};

/// A frame of the grid with its nodes on their bones.
struct LiveWornFrame {
  Time stamp{};
  NodeFrames nodes;  // one frame
};

class LiveWorn {
 public:
  /// A T-pose that a mark names is held for so long behind it.
  static constexpr double held_s = 2.0;
  /// Frames before the calibration are kept for so long. The answer begins with them.
  static constexpr double most_waiting_s = 60.0;

  /// Both must live longer.
  LiveWorn(const PoseLayout& layout, const Skeleton& body, const LiveWornOptions& options);

  /// `node`: of the layout. Frames are made by advance().
  void add(std::size_t node, const NodeReadings& sample) { nodes_.add(node, sample); }
  /// A T-pose is held from `at` on: the nodes are calibrated by it, also anew, unless the person
  /// moves or an arm hangs in it. Not before begin() of nodes() is there.
  void mark_t_pose(Time at) { marked_ = std::max(at, time_of(forgotten_)); }

  /// Whether another device, too, has what a frame at that time needs.
  using Also = std::function<bool(Time time)>;
  /// Makes the frames that are ready. `now`: arrival of the newest message. Calibrated ones are
  /// appended to `out`.
  void advance(Time now, const Also& also, std::vector<LiveWornFrame>& out);
  /// Nothing more comes: the same up to the root's last sample.
  void finish(std::vector<LiveWornFrame>& out);

  const LiveNodes& nodes() const { return nodes_; }
  /// The present one; absent while a T-pose is waited for.
  const std::optional<LiveCalibration>& calibration() const { return calibration_; }
  /// Why the last T-pose was none, once.
  std::optional<std::string> take_refusal() { return std::exchange(refusal_, std::nullopt); }

 private:
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
  std::size_t made_ = 0;       // frames of the grid
  WornFrames recent_;          // the newest frames, for calibrations
  std::size_t forgotten_ = 0;  // frames of the grid before recent_
  std::size_t searched_ = 0;   // of recent_: no T-pose is looked for before that frame
  std::size_t tried_ = 0;      // frames of the grid when a calibration was tried last
  std::optional<Time> marked_;
  std::optional<LiveCalibration> calibration_;
  std::size_t handed_on_ = 0;  // frames of recent_
  std::optional<std::string> refusal_;
};

}  // namespace kinalign
