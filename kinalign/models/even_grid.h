// SPDX-License-Identifier: Apache-2.0
// Resamples the joints of a device, with irregular stamps, to the even grid that a model needs.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/models/joint_frames.h"
#include "kinalign/motion/streams.h"

#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// Frame t is at start + t / rate.
struct EvenSpan {
  Time start{};
  std::size_t frames = 0;
};

/// The span from a device's first stamp to its last stamp, which may lie up to half a step before
/// the last frame.
EvenSpan span_of(Time first, Time last, double rate_hz);

struct EvenGrid {
  double rate_hz = 30.0;
  double gap_s = 0.2;  // a frame farther than this from both samples around it is missing
  /// The frames to fill; if absent, from the first to the last sample.
  std::optional<EvenSpan> span{};
};

/// The body on the grid, and two faults that do not prevent cleaning but deserve a warning.
struct EvenFrames {
  JointFrames body;
  Time start{};  // stamp of the first frame
  double rate_hz = 0.0;
  /// Number of joint positions set to missing because they lie too far from the root.
  std::size_t far = 0;
  std::optional<double> jump_s{};  // s after the start: the first frame at which the root is faster
                                   // than a person can be
};

/// Resamples the joints `places` [J] of `points` to the frames of grid.span, by the rules of
/// even_frames(). If a place is absent, that joint is missing in every frame. Needs at least two
/// samples; the input is not checked.
JointFrames joints_on_grid(const std::vector<std::optional<std::size_t>>& places,
                           const PointFrames& points, const EvenGrid& grid);

/// Resamples the joints `wanted`, the model's inputs, found by name among `names` (kinect_names()).
/// A wanted joint without that name is missing in every frame. Positions are interpolated linearly;
/// the state is the worse one of the two samples. If the model has a head and a root, a joint more
/// than 1.6 m from the root is missing, too.
///
/// Fails if there are fewer than two samples, if stamps fall, or if the root or the first
/// left/right pair of body_joints() is absent. Fails if the median period of the samples is more
/// than 2 times or less than 1/4 of the grid's period, or if the grid has 10,000,000 frames or
/// more. Also fails if the body is smaller than 0.4 m or larger than 2.6 m, or if the head is more
/// than 0.2 m below the root in nine of ten frames.
Result<EvenFrames> even_frames(const std::vector<std::string>& wanted,
                               const std::vector<std::string>& names, const PointFrames& points,
                               const EvenGrid& grid);

}  // namespace kinalign
