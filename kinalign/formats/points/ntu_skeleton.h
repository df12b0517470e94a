// SPDX-License-Identifier: Apache-2.0
// NTU RGB+D .skeleton: Kinect v2 bodies of 25 joints, 30 Hz, no stamps.
// Layout: docs/formats/kinect.md.
#pragma once

#include "kinalign/formats/reader.h"
#include "kinalign/take/manifest.h"

#include <memory>
#include <string_view>

namespace kinalign {

/// One body of the file, a row per frame; a frame without it is a row of missing joints. The body
/// is select["body"] (its id), by default the first that is seen; a finding names the others.
/// rate_hz (30), start_ns, metres_per_unit and up are used. A wrong count of frames is a finding.
std::unique_ptr<PointReader> make_ntu_skeleton_reader(const StreamOptions& options,
                                                      std::string_view file);

bool looks_like_ntu_skeleton(std::string_view head);

}  // namespace kinalign
