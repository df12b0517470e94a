// SPDX-License-Identifier: Apache-2.0
// Options as people write them.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/options.h"

#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Sets the option from text ("0.5", "true", "slerp"); a vector of strings grows by it. Fails, with
/// an Error that names no place, outside the range or the choices.
Result<void> set_field(const Field& field, std::string_view text);

/// The value as set_field reads it; empty for an optional without one. Vectors: joined by ", ".
std::string field_text(const Field& field);

/// Whether a flag of it stands alone: --double, not --double true.
bool is_switch(const Field& field);

/// What stands behind the flag in a help page: "NUMBER", "FILE", "spline|slerp", "" for a switch.
std::string placeholder(const Field& field);

/// "--gap-ms" of gap_ms.
std::string flag_of(std::string_view name);

/// "KINALIGN_GAP_MS" of gap_ms.
std::string variable_of(std::string_view name);

/// "a, b or c"
std::string any_of(const std::vector<std::string>& words);

}  // namespace kinalign
