// SPDX-License-Identifier: Apache-2.0
// Writes streams of points, or of one inertial node, as tables in kinalign's own layouts:
// docs/formats/kinect.md and docs/formats/imu.md.
#pragma once

#include "kinalign/core/text_out.h"
#include "kinalign/motion/streams.h"

namespace kinalign {

/// Writes the layout `kinect`, with any joint names and six decimals of a metre. The caller commits
/// `out`.
Result<void> write_points(const PointStream& stream, TextOut& out);

/// Writes the layout `imu` for a stream of one node, with six decimals of each quantity's unit.
/// Invalid samples are left out. The caller commits `out`.
Result<void> write_node(const ImuStream& stream, TextOut& out);

}  // namespace kinalign
