// SPDX-License-Identifier: Apache-2.0
// Rows of streams as JSON messages for Foxglove and Lichtblick: skeletons as frame transforms,
// samples as numbers for plots. The layout is in docs/formats/shown.md.
#pragma once

#include "kinalign/mcap/records.h"
#include "kinalign/motion/clip.h"
#include "kinalign/motion/streams.h"

#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// The space of all root joints, y up. Its parent is `world`, in which z is up, as viewers expect.
inline constexpr std::string_view shown_space = "lab";

/// A sample's time in UTC. `half_width` is half of the interval that contains the true time; absent
/// if not known.
struct ShownTime {
  Time at{};
  std::optional<Duration> half_width;
};

/// Foxglove recognises the first schema by its name and draws it. The others are only for plots.
McapSchema transforms_schema();  // foxglove.FrameTransforms
McapSchema pose_schema();        // kinalign.Pose: each joint in the space of its parent
McapSchema points_schema();      // kinalign.Points
McapSchema imu_schema();         // kinalign.ImuSample

/// Returns the transforms of row `t` of a block. Joints are frames named STREAM/JOINT, each in the
/// space of its parent.
std::string transforms_json(const std::string& stream, const Skeleton& skeleton,
                            const ClipFrames& frames, std::size_t t, const ShownTime& time);
/// Returns the transforms of points, which have no rotation. A Kinect's point is in the space of
/// the nearest joint towards the root that is not missing. Other points are in the space `lab`.
std::string transforms_json(const std::string& stream, const std::vector<std::string>& joints,
                            const PointFrames& frames, std::size_t t, const ShownTime& time);

/// Returns each joint's position and rotation in its parent's space, or each point's state and
/// position.
std::string joints_json(const Skeleton& skeleton, const ClipFrames& frames, std::size_t t,
                        const ShownTime& time);
std::string joints_json(const std::vector<std::string>& joints, const PointFrames& frames,
                        std::size_t t, const ShownTime& time);
/// Returns a sample of a node. `cell`: index of row t and node s, t * S + s. Only the quantities in
/// `content` are written.
std::string imu_json(const ImuContent& content, const ImuSamples& samples, std::size_t cell,
                     const ShownTime& time);

}  // namespace kinalign
