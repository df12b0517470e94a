// SPDX-License-Identifier: Apache-2.0
// Streams of points and of a node as tables in our own layouts: docs/formats/kinect.md, imu.md.
#pragma once

#include "kinalign/core/text_out.h"
#include "kinalign/motion/streams.h"

namespace kinalign {

/// The layout `kinect`, whatever the joints are called; micrometres. The caller commits.
Result<void> write_points(const PointStream& stream, TextOut& out);

/// The layout `imu`, of a stream of one node; its quantities to a millionth of their unit. Samples
/// that are not valid are left out. The caller commits.
Result<void> write_node(const ImuStream& stream, TextOut& out);

}  // namespace kinalign
