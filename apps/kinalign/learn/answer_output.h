// SPDX-License-Identifier: Apache-2.0
// The answer of a model on its way out: a take read in a child, a skeleton written, lines printed.
#pragma once

#include "apps/cli/verb.h"

#include "kinalign/motion/clip.h"

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <string>

namespace kinalign {

using AboutAnswer = nlohmann::ordered_json;

/// What `work` says, done in a child process: a damaged take ends no more than that. Errors name
/// the take `in`.
Result<AboutAnswer> in_child(const std::string& in,
                             const std::function<Result<AboutAnswer>()>& work);

/// Writes a BVH to --out. Fails where a number of the clip is not finite, and names the model.
Result<void> write_answer(Clip clip, double rate_hz, const std::string& model, Call& call);

/// Prints `text`, a line for each warning, and the JSON.
void print_answer(std::string text, const AboutAnswer& about, Call& call);

}  // namespace kinalign
