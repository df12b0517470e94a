// SPDX-License-Identifier: Apache-2.0
// Refuses options of a manifest that would have no effect, because the user expects an effect.
#pragma once

#include "kinalign/take/manifest.h"
#include "kinalign/take/recording.h"

#include <span>
#include <string_view>

namespace kinalign {

/// Names of the options that have no effect for this kind of stream.
std::span<const std::string_view> useless_options(const RecordedStream& stream);

/// Fails if options of a stream, or options of a space other than its method, differ from the
/// defaults but have no effect. Fails, too, if method "given" has neither rotation nor translation.
Result<void> check_options_used(const Recording& recording, const Manifest& manifest);

}  // namespace kinalign
