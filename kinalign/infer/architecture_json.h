// SPDX-License-Identifier: Apache-2.0
// Converts an architecture to and from the JSON text in a model's file. Layout:
// docs/formats/model.md.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/infer/architecture.h"

#include <string>
#include <string_view>

namespace kinalign {

/// {"inputs":75,"layers":[{"kind":"linear","out":3}]}: each layer has the members that its kind
/// uses, in the order of struct Layer.
std::string architecture_json(const Architecture& architecture);

/// Fails at unknown kinds and members, and if validate() of shapes.h fails. The error names the
/// layer. Members may be absent and then have the defaults of Layer, except `out`, `window` and
/// `branches`, which are required if the kind uses them. `name` appears in messages only.
Result<Architecture> parse_architecture_json(std::string_view text, const std::string& name);

}  // namespace kinalign
