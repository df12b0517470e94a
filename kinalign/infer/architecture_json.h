// SPDX-License-Identifier: Apache-2.0
// An architecture as the JSON text that a model's file holds. Layout: docs/formats/model.md.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/infer/architecture.h"

#include <string>
#include <string_view>

namespace kinalign {

/// {"inputs":75,"layers":[{"kind":"linear","out":3}]}: the members of each layer's kind, in the
/// order of Layer.
std::string architecture_json(const Architecture& architecture);

/// Fails at unknown kinds and members, and where validate() of shapes.h fails. The error names the
/// layer. All members have the defaults of Layer but `out` and `branches`, which must be there
/// where the kind uses them. `name` appears in messages only.
Result<Architecture> parse_architecture_json(std::string_view text, const std::string& name);

}  // namespace kinalign
