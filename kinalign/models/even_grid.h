// SPDX-License-Identifier: Apache-2.0
// Joints of a device, with its stamps, on the even grid that a model works on.
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

/// From the first stamp to the last one, of the device that has them.
EvenSpan span_of(Time first, Time last, double rate_hz);

struct EvenGrid {
  double rate_hz = 30.0;
  double gap_s = 0.2;              // between samples that are joined by a line
  std::optional<EvenSpan> span{};  // the frames; else those from the first sample to the last one
};

struct EvenFrames {
  JointFrames body;
  Time start{};  // stamp of the first frame
  double rate_hz = 0.0;
  std::size_t far = 0;  // joints that are missing, since they lie too far from the root
  std::optional<double>
      jump_s{};  // from the start: where the root first moves faster than a person
};

/// The joints `places` [J] of points, absent: none, on the frames of the grid's span, as
/// even_frames() puts them there. Two samples at least; nothing is checked.
JointFrames joints_on_grid(const std::vector<std::optional<std::size_t>>& places,
                           const PointFrames& points, const EvenGrid& grid);

/// `wanted`: the model's input joints, by name among `names` (kinect_names()); one that is not
/// there is missing in every frame. Between two samples a joint lies on the line between both, and
/// is seen as well as the worse of them; farther than the gap from a sample it is missing. Fails
/// where there are no samples, where stamps fall, where root or hips are not there, where the usual
/// step is more than twice or less than a quarter of the grid's, where the body is no person's
/// size, and where its head is below its root. A joint more than 1.6 m from the root is missing.
Result<EvenFrames> even_frames(const std::vector<std::string>& wanted,
                               const std::vector<std::string>& names, const PointFrames& points,
                               const EvenGrid& grid);

}  // namespace kinalign
