// SPDX-License-Identifier: Apache-2.0
// The content of a model's file, as text and as JSON.
#pragma once

#include "apps/kinalign/text/describe_file.h"

#include <string>
#include <string_view>

namespace kinalign {

/// A larger model's file is refused.
/// `info` reads the whole file into memory, so the length of a file that only looks like a model
/// must be limited.
inline constexpr std::size_t most_model_bytes = std::size_t{1} << 30U;

/// Describes a model. `bytes`: the whole file. Fails if it is no model of kinalign, or one that
/// can't be used.
Result<Description> describe_model(const std::string& path, std::string_view bytes);

}  // namespace kinalign
