// SPDX-License-Identifier: Apache-2.0
// NTU RGB+D .skeleton: Kinect v2 bodies of 25 joints, 30 Hz, no stamps.
// Layout: docs/formats/kinect.md.
#pragma once

#include "kinalign/formats/reader.h"
#include "kinalign/take/manifest.h"

#include <memory>
#include <string_view>

namespace kinalign {

/// Reads one body of the file, a row per frame. A frame without the body is a row of missing
/// joints. The body is select["body"] (its id), by default the first one in the file; a finding
/// names the others. Uses the options rate_hz (default 30), start_ns, metres_per_unit and up. A
/// wrong count of frames is a finding.
/// The file is a list of counts and lines without marks, so one wrong count makes the rest
/// unreadable.
std::unique_ptr<PointReader> make_ntu_skeleton_reader(const StreamOptions& options,
                                                      std::string_view file);

bool looks_like_ntu_skeleton(std::string_view head);

}  // namespace kinalign
