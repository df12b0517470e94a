// SPDX-License-Identifier: Apache-2.0
// Which bodies an NTU RGB+D .skeleton has, for whoever chooses one (ntu_skeleton.h reads it).
#pragma once

#include "kinalign/formats/points/ui_prmd_kinect.h"

#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

struct NtuBody {
  std::string id;
  std::uint64_t frames = 0;  // in which it is seen
};

/// The longest seen first, of equal ones the first seen. Fails where a count can't be understood; a
/// last frame that is not whole counts too. At most 1000 bodies are kept apart. `name`: the file's,
/// for messages.
Result<std::vector<NtuBody>> ntu_bodies(const TextPieces& text, const std::string& name);

}  // namespace kinalign
