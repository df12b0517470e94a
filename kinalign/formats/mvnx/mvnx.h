// SPDX-License-Identifier: Apache-2.0
// Xsens MVN's MVNX files, plain or packed by gzip. Layout: docs/formats/mvnx.md.
#pragma once

#include "kinalign/formats/reader.h"
#include "kinalign/take/manifest.h"

#include <memory>
#include <string_view>

namespace kinalign {

/// Segments as joints of a skeleton. The rest pose comes from the segments' points, else from the
/// identity or T-pose frame, else from the first frame; local positions are those of each frame.
/// Frames of type normal only; those that lack a segment or step back are left out, with a finding.
std::unique_ptr<ClipReader> make_mvnx_reader(const StreamOptions& options, std::string_view file);

/// Sensors as nodes: orientation, acceleration and angular velocity, each if the first normal frame
/// has it.
std::unique_ptr<ImuReader> make_mvnx_sensor_reader(const StreamOptions& options,
                                                   std::string_view file);

/// The element mvnx stands among the first bytes, unpacked if they are packed.
bool looks_like_mvnx(std::string_view head);

}  // namespace kinalign
