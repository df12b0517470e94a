// SPDX-License-Identifier: Apache-2.0
// What a manifest says and nothing would come of: refused, since whoever wrote it expects that it
// counts.
#pragma once

#include "kinalign/take/manifest.h"
#include "kinalign/take/recording.h"

#include <span>
#include <string_view>

namespace kinalign {

/// Names of options that a stream of this kind has no use for.
std::span<const std::string_view> useless_options(const RecordedStream& stream);

/// Fails where a stream's options, or a space's beside its method, differ from the defaults and
/// have no effect, and where method "given" is given nothing.
Result<void> check_options_used(const Recording& recording, const Manifest& manifest);

}  // namespace kinalign
