// SPDX-License-Identifier: Apache-2.0
// Writes streams of points and of a node as tables in our own layouts: docs/formats/kinect.md,
// imu.md.
#pragma once

#include "kinalign/core/text_out.h"
#include "kinalign/motion/streams.h"

namespace kinalign {

/// Writes the layout `kinect`, with any joint names, to six decimals of a metre. The caller
/// commits.
Result<void> write_points(const PointStream& stream, TextOut& out);

/// Writes the layout `imu`, for a stream of one node, to six decimals of each quantity's unit.
/// Invalid samples are left out. The caller commits.
Result<void> write_node(const ImuStream& stream, TextOut& out);

}  // namespace kinalign
