// SPDX-License-Identifier: Apache-2.0
// Describes the content of a model's file as text and as JSON.
#pragma once

#include "apps/kinalign/text/describe_file.h"

#include <string>
#include <string_view>

namespace kinalign {

/// The largest size of a model's file. `info` reads the whole file into memory, so a larger file is
/// refused.
inline constexpr std::size_t most_model_bytes = std::size_t{1} << 30U;

/// Describes a model. `bytes`: the whole file. Fails if the file is no model of kinalign, or a
/// model that can't be used.
Result<Description> describe_model(const std::string& path, std::string_view bytes);

}  // namespace kinalign
