// SPDX-License-Identifier: Apache-2.0
// Refuses options of a manifest that have no effect, because the user expects an effect.
#pragma once

#include "kinalign/take/manifest.h"
#include "kinalign/take/recording.h"

#include <span>
#include <string_view>

namespace kinalign {

/// Returns the names of the options that have no effect for this kind of stream.
std::span<const std::string_view> useless_options(const RecordedStream& stream);

/// Fails if an option of a stream or of a space differs from its default but has no effect. Also
/// fails if the method "given" has neither rotation nor translation.
Result<void> check_options_used(const Recording& recording, const Manifest& manifest);

}  // namespace kinalign
