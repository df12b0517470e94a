// SPDX-License-Identifier: Apache-2.0
// A Kinect's joints while they come, put onto the even grid of a model as even_frames() does it.
#pragma once

#include "kinalign/models/even_grid.h"

#include <optional>
#include <string>
#include <vector>

namespace kinalign {

class LiveJoints {
 public:
  /// How long a frame waits for the Kinect's next frame.
  static constexpr Duration patience = std::chrono::milliseconds(150);
  /// A Kinect that is silent for longer is not waited for.
  static constexpr Duration silence = std::chrono::seconds(1);

  /// `wanted`: the model's joints; those that a Kinect has not are missing.
  LiveJoints(const std::vector<std::string>& wanted, double rate_hz);

  /// One row of kinect_joints. Rows may overtake each other; one of a stamp that is there already
  /// is left out.
  void add(const PointFrames& row, Time arrival);

  /// The first stamp; absent before it.
  const std::optional<Time>& begin() const { return begin_; }
  std::optional<Time> newest() const;
  /// Whether the frame at `time` need not wait for further rows. `now`: arrival of the newest
  /// message of any device. A Kinect that has not come yet is not waited for.
  bool is_ready(Time time, Time now) const;
  /// The frame at `time`. Times rise from call to call: what no later frame needs is forgotten.
  JointFrames frame(Time time);

 private:
  std::vector<std::optional<std::size_t>> places_;  // of the wanted joints
  double rate_hz_;
  PointFrames rows_;  // of the last second, rising
  std::optional<Time> begin_;
  Time arrival_ = Time::min();  // of the newest row
};

}  // namespace kinalign
