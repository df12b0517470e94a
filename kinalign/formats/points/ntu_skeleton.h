// SPDX-License-Identifier: Apache-2.0
// NTU RGB+D .skeleton: Kinect v2 bodies of 25 joints, 30 Hz, no stamps.
// Layout: docs/formats/kinect.md.
#pragma once

#include "kinalign/formats/points/ui_prmd_kinect.h"
#include "kinalign/formats/reader.h"
#include "kinalign/take/manifest.h"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

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

/// The id is a text: NTU writes numbers of 17 digits.
struct NtuBody {
  std::string id;
  std::uint64_t frames = 0;  // number of frames with this body
};

/// The bodies, from which the user can choose one: the one with the most frames first; equal ones
/// in the order of the file. An incomplete last frame counts too. At most 1000 bodies are listed.
/// Fails if a count can't be understood. `name`: the file's, for messages.
Result<std::vector<NtuBody>> ntu_bodies(const TextPieces& text, const std::string& name);

}  // namespace kinalign
