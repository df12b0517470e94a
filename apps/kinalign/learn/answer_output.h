// SPDX-License-Identifier: Apache-2.0
// The answer of a model on its way out: a take read in a child, whose bones the answer has, a
// skeleton written, lines printed.
#pragma once

#include "apps/cli/verb.h"

#include "kinalign/motion/clip.h"

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <optional>
#include <string>

namespace kinalign {

using AboutAnswer = nlohmann::ordered_json;

/// What `work` says, done in a child process: a damaged take ends no more than that. Errors name
/// the take `in`.
Result<AboutAnswer> in_child(const std::string& in,
                             const std::function<Result<AboutAnswer>()>& work);

/// The flag body. `otherwise`: whose bones the answer has without it.
Field body_flag(std::string& words, const std::string& otherwise);
/// Fails where the words are no stature and no name of a BVH.
Result<void> check_body(const std::string& words);
/// `body` with the lengths that the words ask for: a stature in metres, or a BVH of the person's
/// suit. None where they are empty.
Result<std::optional<Skeleton>> body_of_words(const std::string& words, const Skeleton& body,
                                              Call& call);
/// The member "body" of what is told. `by`: who says it, such as "the model".
AboutAnswer about_body(const Skeleton& body, const std::string& by);
/// The line on it: "body     as of a stature of 1.75 m, by --body".
std::string body_line(const AboutAnswer& about);

/// Writes a BVH to --out. Fails where a number of the clip is not finite, and names the model.
Result<void> write_answer(Clip clip, double rate_hz, const std::string& model, Call& call);

/// Fails before a live run where the file that it will end with can't be written. Leaves none.
Result<void> keep_free(const Call& call);

/// Prints `text`, a line for each warning, and the JSON.
void print_answer(std::string text, const AboutAnswer& about, Call& call);
/// The same of a live run: the JSON is a line, the event `ended`.
void print_live(std::string text, const AboutAnswer& about, Call& call);

}  // namespace kinalign
