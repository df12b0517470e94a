// SPDX-License-Identifier: Apache-2.0
// The answer of a model: reads a take in a child process, applies --body, writes the skeleton and
// prints the lines about it.
#pragma once

#include "apps/cli/verb.h"

#include "kinalign/motion/clip.h"

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <optional>
#include <string>

namespace kinalign {

/// The facts about an answer. The same object is the JSON of --json and the source of the printed
/// lines, so both always agree.
using AboutAnswer = nlohmann::ordered_json;

/// Returns the result of `work`, which reads the file `in`. If that is a take, it runs in a child
/// process, so a damaged take can crash only the child. Errors without a file name `in`.
/// Only the JSON comes back from the child. A file that `work` writes stays, so the child may write
/// the answer itself.
Result<AboutAnswer> answered(const std::string& in,
                             const std::function<Result<AboutAnswer>()>& work, Call& call);

/// The flag --model of a verb with shipped models.
Field model_flag(std::string& model);
/// The flag --body. `otherwise`: the help's words for the bones that the answer has without the
/// flag.
Field body_flag(std::string& words, const std::string& otherwise);
/// Fails if the text is neither a stature from 0.5 to 2.6 m nor the name of a BVH file.
Result<void> check_body(const std::string& words);
/// `body` with the lengths that the text asks for: a stature in metres, or a BVH of the person's
/// suit. Absent if the text is empty.
Result<std::optional<Skeleton>> body_of_words(const std::string& words, const Skeleton& body,
                                              Call& call);
/// The member "body" of the JSON. `by`: the source of the bone lengths, such as "the model".
AboutAnswer about_body(const Skeleton& body, const std::string& by);
/// The printed line about the body: "body     as of a stature of 1.75 m, by --body".
std::string body_line(const AboutAnswer& about);

/// Writes a BVH to --out. Fails if a number of the clip is not finite; the error names the model.
Result<void> write_answer(Clip clip, double rate_hz, const std::string& model, Call& call);

/// Fails before a live run starts if the file to be written at its end can't be created. Leaves no
/// file.
/// A live run may last for hours. A name that can't be written must fail at its start.
Result<void> keep_free(const Call& call);

/// The first printed line: "clean.bvh: 300 frames at 30 Hz, 25 joints". A live run without a file
/// is called "live".
std::string answer_line(const AboutAnswer& about, const std::string& out);
/// The share of the Kinect's joints: "1.2 % missing, 3.4 % inferred".
std::string seen_text(const AboutAnswer& about);

/// Prints `text`, a line for each warning, and the JSON. Returns the exit code: 1 if there are
/// warnings.
int print_answer(std::string text, const AboutAnswer& about, Call& call);
/// Ends a live run: writes the clip if --out names a file, and prints as print_answer() does, with
/// the latencies. The JSON is one line, the event `ended`.
Result<int> end_live(Clip clip, const std::string& model, const std::string& text,
                     const AboutAnswer& about, Call& call);

}  // namespace kinalign
