// SPDX-License-Identifier: Apache-2.0
// Values of described options (core/options.h) read from TOML and JSON: checked in the same way,
// with the same messages.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/options.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace kinalign {

using OptionValue = std::variant<bool, std::int64_t, double, std::string, std::vector<std::string>>;

/// Sets the option to `value`. The error names no place: expected "gap_ms as a number from 0 to
/// 86400000", found "-1".
Result<void> assign(const Field& field, const OptionValue& value);

/// Fails unless the numbers are w,x,y,z with a length from 0.5 to 2. `name`: their key.
Result<void> check_rotation(const std::string& name, std::span<const double> numbers);

/// The field with that name; nullptr if there is none.
const Field* find_field(const Fields& fields, std::string_view name);

}  // namespace kinalign
