// SPDX-License-Identifier: Apache-2.0
// What is in a model's file, as lines for people and as JSON.
#pragma once

#include "apps/kinalign/text/describe_file.h"

#include <string>
#include <string_view>

namespace kinalign {

inline constexpr std::size_t most_model_bytes = std::size_t{1} << 30U;

/// `bytes`: of the whole file. Fails where they are no model of kinalign, or one that can't be
/// used.
Result<Description> describe_model(const std::string& path, std::string_view bytes);

}  // namespace kinalign
