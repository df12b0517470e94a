// SPDX-License-Identifier: Apache-2.0
// The work around a model's answer: reads takes in a child process, applies --body, writes the
// skeleton and prints the lines about it.
#pragma once

#include "apps/cli/verb.h"

#include "kinalign/motion/clip.h"

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <optional>
#include <string>

namespace kinalign {

/// The facts about an answer. --json prints this object, and the printed lines are made from it, so
/// both agree.
using AboutAnswer = nlohmann::ordered_json;

/// Returns the result of `work`, which reads the file `in`. If `in` is a take, `work` runs in a
/// child process, so that a damaged take can crash only the child. `work` may also write files,
/// which stay. Errors without a file get the name `in`.
Result<AboutAnswer> answered(const std::string& in,
                             const std::function<Result<AboutAnswer>()>& work, Call& call);

/// The flag --model of a verb that has models which come with kinalign.
Field model_flag(std::string& model);
/// The flag --body. `otherwise`: words for the help page that say which bones the answer has
/// without the flag.
Field body_flag(std::string& words, const std::string& otherwise);
/// Fails if the text is neither a stature from 0.5 to 2.6 m nor the name of a BVH file.
Result<void> check_body(const std::string& words);
/// `body` with the bone lengths that the text asks for: a stature in metres, or a BVH of the
/// person's suit. Empty if the text is empty.
Result<std::optional<Skeleton>> body_of_words(const std::string& words, const Skeleton& body,
                                              Call& call);
/// The JSON member "body". `by`: the source of the bone lengths, such as "the model".
AboutAnswer about_body(const Skeleton& body, const std::string& by);
/// The printed line about the body: "body     as of a stature of 1.75 m, by --body".
std::string body_line(const AboutAnswer& about);

/// Writes a BVH to --out. Fails if the clip contains NaN or infinity; the error names the model.
Result<void> write_answer(Clip clip, double rate_hz, const std::string& model, Call& call);

/// Fails if the file of --out can't be created. A live run may take hours and writes its file at
/// the end, so this is checked before it starts. No file is left.
Result<void> keep_free(const Call& call);

/// The first printed line: "clean.bvh: 300 frames at 30 Hz, 25 joints". Without a file the line
/// begins with "live".
std::string answer_line(const AboutAnswer& about, const std::string& out);
/// The share of the Kinect's joints that are missing or inferred: "1.2 % missing, 3.4 % inferred".
std::string seen_text(const AboutAnswer& about);

/// Prints `text`, a line for each warning, and the JSON. Returns the exit code, which is 1 if there
/// are warnings.
int print_answer(std::string text, const AboutAnswer& about, Call& call);
/// Ends a live run: writes the clip if --out names a file, and prints like print_answer(), with the
/// latencies. The JSON is one line with the event `ended`.
Result<int> end_live(Clip clip, const std::string& model, const std::string& text,
                     const AboutAnswer& about, Call& call);

}  // namespace kinalign
