// SPDX-License-Identifier: Apache-2.0
// What denoise and pose open that is no take.
#pragma once

#include "apps/cli/verb.h"
#include "apps/kinalign/verbs/inputs.h"

#include <string>

namespace kinalign {

/// The streams of a manifest, of a recording (all devices of which rows can be made) or of a single
/// stream's file.
Result<Input> open_motion(const std::string& path, Call& call);

}  // namespace kinalign
