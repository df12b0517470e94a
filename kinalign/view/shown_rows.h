// SPDX-License-Identifier: Apache-2.0
// Rows of streams as the JSON messages that Foxglove and Lichtblick show: skeletons as frame
// transforms, samples as numbers to plot. docs/formats/shown.md.
#pragma once

#include "kinalign/mcap/records.h"
#include "kinalign/motion/clip.h"
#include "kinalign/motion/streams.h"

#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// The space of all roots, y up. It is the child of `world`, which is z up as viewers expect.
inline constexpr std::string_view shown_space = "lab";

/// A sample's time on UTC, and how sure that is.
struct ShownTime {
  Time at{};
  std::optional<Duration> half_width;
};

McapSchema transforms_schema();  // foxglove.FrameTransforms
McapSchema pose_schema();        // kinalign.Pose: each joint in its parent's space
McapSchema points_schema();      // kinalign.Points
McapSchema imu_schema();         // kinalign.ImuSample

/// Row `t` of a block. Joints are frames STREAM/JOINT, each in its parent's.
std::string transforms_json(const std::string& stream, const Skeleton& skeleton,
                            const ClipFrames& frames, std::size_t t, const ShownTime& time);
/// Points have no rotation. Those of a Kinect hang on each other as its bones do, past missing
/// ones; others in the lab.
std::string transforms_json(const std::string& stream, const std::vector<std::string>& joints,
                            const PointFrames& frames, std::size_t t, const ShownTime& time);

std::string pose_json(const Skeleton& skeleton, const ClipFrames& frames, std::size_t t,
                      const ShownTime& time);
std::string points_json(const std::vector<std::string>& joints, const PointFrames& frames,
                        std::size_t t, const ShownTime& time);
/// `cell`: of row t and node s of S, t * S + s.
std::string imu_json(const ImuContent& content, const ImuSamples& samples, std::size_t cell,
                     const ShownTime& time);

}  // namespace kinalign
