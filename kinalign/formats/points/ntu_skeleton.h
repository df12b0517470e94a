// SPDX-License-Identifier: Apache-2.0
// Reads .skeleton files of NTU RGB+D: bodies of a Kinect v2 with 25 joints, at 30 Hz, without
// stamps. Layout: docs/formats/kinect.md.
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

/// Reads one body of the file. Each frame gives one row. If the body is not in a frame, all joints
/// of the row are missing. select["body"] is the body's id; the default is the first body in the
/// file, and a finding then names the other bodies. Further options are rate_hz (default 30),
/// start_ns, metres_per_unit and up. A wrong number of frames is a finding. The lines of the file
/// only have a meaning by earlier counts, so after one wrong count the rest can't be read.
std::unique_ptr<PointReader> make_ntu_skeleton_reader(const StreamOptions& options,
                                                      std::string_view file);

bool looks_like_ntu_skeleton(std::string_view head);

/// A body in a file. Its id is a text, because NTU writes numbers of 17 digits.
struct NtuBody {
  std::string id;
  std::uint64_t frames = 0;  // number of frames with this body
};

/// Lists the bodies, so that the user can choose one. The body with the most frames comes first.
/// Bodies with equally many frames are in the order of the file. An incomplete last frame counts,
/// too. At most 1000 bodies are listed. Fails if a count is not a number. `name`: the file, for
/// messages.
Result<std::vector<NtuBody>> ntu_bodies(const TextPieces& text, const std::string& name);

}  // namespace kinalign
