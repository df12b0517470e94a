// SPDX-License-Identifier: Apache-2.0
// Values of described options (core/options.h) as TOML and JSON hold them: checked on the way in,
// the same messages for both.
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

/// Puts `value` into the option. The error has no place: "gap_ms as a number from 0 to
/// 86400000", "-1".
Result<void> assign(const Field& field, const OptionValue& value);

/// Fails where these are not w,x,y,z of a length from 0.5 to 2: `name` is the key they stand under.
Result<void> check_rotation(const std::string& name, std::span<const double> numbers);

/// The field of that name; nullptr where there is none.
const Field* find_field(const Fields& fields, std::string_view name);

}  // namespace kinalign
