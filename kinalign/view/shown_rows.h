// SPDX-License-Identifier: Apache-2.0
// Rows of streams as JSON messages that Foxglove and Lichtblick show: skeletons as frame
// transforms, samples as numbers to plot. docs/formats/shown.md.
#pragma once

#include "kinalign/mcap/records.h"
#include "kinalign/motion/clip.h"
#include "kinalign/motion/streams.h"

#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// The space of all roots, y up. Its parent is `world`, which is z up as viewers expect.
inline constexpr std::string_view shown_space = "lab";

/// A sample's time on UTC, and its certainty.
/// `half_width` is half of the interval that holds the true time; absent if it is not known.
struct ShownTime {
  Time at{};
  std::optional<Duration> half_width;
};

/// Foxglove knows the first one by its name and draws it; the others are only plotted.
McapSchema transforms_schema();  // foxglove.FrameTransforms
McapSchema pose_schema();        // kinalign.Pose: each joint in its parent's space
McapSchema points_schema();      // kinalign.Points
McapSchema imu_schema();         // kinalign.ImuSample

/// The transforms of row `t` of a block. Joints are frames STREAM/JOINT, each in its parent's
/// space.
std::string transforms_json(const std::string& stream, const Skeleton& skeleton,
                            const ClipFrames& frames, std::size_t t, const ShownTime& time);
/// The same for points, which have no rotation. A Kinect's points are in the space of the next
/// joint towards the root that is not missing; other points are in the lab's.
std::string transforms_json(const std::string& stream, const std::vector<std::string>& joints,
                            const PointFrames& frames, std::size_t t, const ShownTime& time);

/// Each joint's place and rotation in its parent's space; of points, each one's state and place.
std::string joints_json(const Skeleton& skeleton, const ClipFrames& frames, std::size_t t,
                        const ShownTime& time);
std::string joints_json(const std::vector<std::string>& joints, const PointFrames& frames,
                        std::size_t t, const ShownTime& time);
/// `cell`: the index of row t and node s, t * S + s.
/// Only quantities that the stream has (`content`) are written.
std::string imu_json(const ImuContent& content, const ImuSamples& samples, std::size_t cell,
                     const ShownTime& time);

}  // namespace kinalign
