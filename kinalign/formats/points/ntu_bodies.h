// SPDX-License-Identifier: Apache-2.0
// Lists the bodies of an NTU RGB+D .skeleton, from which the user can choose one (ntu_skeleton.h
// reads it).
#pragma once

#include "kinalign/formats/points/ui_prmd_kinect.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// The id is a text: NTU writes numbers of 17 digits.
struct NtuBody {
  std::string id;
  std::uint64_t frames = 0;  // number of frames with this body
};

/// The bodies, the one with the most frames first; equal ones in the order of the file. An
/// incomplete last frame counts too. At most 1000 bodies are listed. Fails if a count can't be
/// understood. `name`: the file's, for messages.
Result<std::vector<NtuBody>> ntu_bodies(const TextPieces& text, const std::string& name);

}  // namespace kinalign
