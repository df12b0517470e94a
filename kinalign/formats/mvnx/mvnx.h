// SPDX-License-Identifier: Apache-2.0
// Reads MVNX files of Xsens MVN, plain or compressed with gzip. Layout: docs/formats/mvnx.md.
#pragma once

#include "kinalign/formats/reader.h"
#include "kinalign/take/manifest.h"

#include <memory>
#include <string_view>

namespace kinalign {

/// Makes a reader of segments, which become the joints of a skeleton. The rest pose comes from the
/// points of the segments. If there are none, it comes from the identity or T-pose frame, or from
/// the first frame. Local positions are computed for each frame. Only frames of type normal are
/// read. Frames that lack a segment, or whose index does not rise, are left out with a finding.
std::unique_ptr<ClipReader> make_mvnx_reader(const StreamOptions& options, std::string_view file);

/// Makes a reader of sensors, which become inertial nodes. Orientation, acceleration and angular
/// velocity are read if the first normal frame has them.
std::unique_ptr<ImuReader> make_mvnx_sensor_reader(const StreamOptions& options,
                                                   std::string_view file);

/// True if the first bytes contain the element mvnx. Compressed bytes are decompressed first.
bool looks_like_mvnx(std::string_view head);

}  // namespace kinalign
