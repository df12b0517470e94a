// SPDX-License-Identifier: Apache-2.0
// Reads Xsens MVN's MVNX files, plain or packed by gzip. Layout: docs/formats/mvnx.md.
#pragma once

#include "kinalign/formats/reader.h"
#include "kinalign/take/manifest.h"

#include <memory>
#include <string_view>

namespace kinalign {

/// Reads segments as the joints of a skeleton. The rest pose comes from the segments' points, or
/// from the identity or T-pose frame, or from the first frame. Local positions are those of each
/// frame. Only frames of type normal are read. Frames that lack a segment or whose index does not
/// rise are left out, with a finding.
std::unique_ptr<ClipReader> make_mvnx_reader(const StreamOptions& options, std::string_view file);

/// Reads sensors as nodes: orientation, acceleration and angular velocity, each if the first normal
/// frame has it.
std::unique_ptr<ImuReader> make_mvnx_sensor_reader(const StreamOptions& options,
                                                   std::string_view file);

/// True if the first bytes, unpacked if necessary, hold the element mvnx.
bool looks_like_mvnx(std::string_view head);

}  // namespace kinalign
