// SPDX-License-Identifier: Apache-2.0
// Resamples a Kinect's live joints to the even grid of a model, with the rules of even_frames().
#pragma once

#include "kinalign/models/even_grid.h"

#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// Keeps the rows of the last second, sorted by stamp, and makes frames of the grid from them.
/// Network delays change the order of rows, so add() sorts.
class LiveJoints {
 public:
  /// The longest time that a frame waits for the Kinect's next row.
  static constexpr Duration patience = std::chrono::milliseconds(150);
  /// A Kinect without a row for longer than this is not waited for.
  static constexpr Duration silence = std::chrono::seconds(1);

  /// `wanted`: the model's joints. Joints that a Kinect does not have are missing.
  LiveJoints(const std::vector<std::string>& wanted, double rate_hz);

  /// Adds one row of kinect_joints. Rows may arrive out of order; a row with a duplicate stamp is
  /// dropped.
  void add(const PointFrames& row, Time arrival);

  /// The stamp of the first row; absent before any row.
  const std::optional<Time>& begin() const { return begin_; }
  std::optional<Time> newest() const;
  /// True if the frame at `time` need not wait for further rows. `now`: arrival of the newest
  /// message of any device. A Kinect that has not sent anything yet is not waited for.
  bool is_ready(Time time, Time now) const;
  /// The frame at `time`. Times must rise from call to call, because rows that no later frame needs
  /// are dropped.
  JointFrames frame(Time time);

 private:
  /// Column of each wanted joint; absent: the Kinect does not have it.
  std::vector<std::optional<std::size_t>> places_;
  double rate_hz_;
  PointFrames rows_;  // rows of the last second, sorted by stamp
  std::optional<Time> begin_;
  Time arrival_ = Time::min();  // arrival of the newest row
};

}  // namespace kinalign
