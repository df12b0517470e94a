// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/learn/answer_output.h"

#include "apps/cli/console.h"
#include "apps/cli/json_text.h"
#include "apps/kinalign/live/live_runs.h"
#include "apps/kinalign/text/describe_file.h"

#include "kinalign/core/numbers.h"
#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/formats/take/guarded.h"
#include "kinalign/models/pose/own_body.h"
#include "kinalign/sources/formats.h"
#include "kinalign/view/report_words.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinalign {

namespace {

/// False if the clip contains NaN or infinity, as the answer of a broken model does. No program can
/// read a BVH with "nan".
bool is_finite(const Clip& clip) {
  const auto is_number = [](double value) { return std::isfinite(value); };
  const ClipFrames& frames = clip.frames;
  return std::all_of(frames.local_positions.begin(), frames.local_positions.end(), is_number) &&
         std::all_of(frames.local_rotations.begin(), frames.local_rotations.end(), is_number);
}

/// The body heights (statures) that --body accepts, m.
constexpr double least_stature_m = 0.5, most_stature_m = 2.6;
// A larger BVH is refused.
constexpr std::uint64_t most_body_bytes = std::uint64_t{1} << 28U;

/// Parses a stature, m. Empty if the text is not a number.
std::optional<double> stature_in(const std::string& words) {
  double out = 0.0;
  // The whole text must be a number, because "1.75m" may be the name of a file.
  return parse_number(words, out) ? std::optional(out) : std::nullopt;
}

/// Adds one line for each warning below the summary. harmless() removes control characters, since
/// names in warnings come from files.
std::string with_warnings(std::string text, const AboutAnswer& about) {
  for (const AboutAnswer& warning : about.at("warnings")) {
    text += fmt::format("warning  {}\n", harmless(warning.get<std::string>()));
  }
  return text;
}

}  // namespace

Field model_flag(std::string& model) {
  return text_flag(
      "model",
      "a model's file, or the name of a shipped model (default: the shipped model that fits)",
      &model, "FILE");
}

Field body_flag(std::string& words, const std::string& otherwise) {
  return text_flag(
      "body",
      "bone lengths of the answer: a stature in m, or a BVH of the person's suit (default: " +
          otherwise + ")",
      &words, "BODY");
}

Result<void> check_body(const std::string& words) {
  // The name of a BVH is accepted here. The file is opened later, when the model is known.
  if (words.empty() || words.ends_with(".bvh")) return {};
  const auto stature = stature_in(words);
  if (stature && *stature >= least_stature_m && *stature <= most_stature_m) return {};
  return Failure(
      Error{"--body", 0, "a stature from 0.5 to 2.6 m, or a BVH of the suit", shown(words)});
}

/// The bones that --body asks for: the model's body scaled to a stature, or with the bone lengths
/// of a BVH file.
Result<std::optional<Skeleton>> body_of_words(const std::string& words, const Skeleton& body,
                                              Call& call) {
  if (words.empty()) return std::optional<Skeleton>{};
  // All bones are scaled by the same factor, so the proportions of the model's body stay.
  if (const auto stature = stature_in(words)) return scaled(body, *stature / stature_of(body));
  const std::string text = KA_TRY(read_whole(call.surroundings.files, words, most_body_bytes));
  // Only the lengths of the bones are taken from the BVH.
  return std::optional(KA_TRY(with_lengths_of(body, KA_TRY(read_bvh(text, words, {})).clip.skeleton)
                                  .map_error(in_file(words))));
}

AboutAnswer about_body(const Skeleton& body, const std::string& by) {
  return {{"stature_m", stature_of(body)}, {"by", by}};
}

std::string body_line(const AboutAnswer& about) {
  const AboutAnswer& body = about.at("body");
  return fmt::format("body     of stature {:.2f} m, from {}\n", body.at("stature_m").get<double>(),
                     harmless(body.at("by").get<std::string>()));
}

Result<AboutAnswer> answered(const std::string& in,
                             const std::function<Result<AboutAnswer>()>& work, Call& call) {
  // A damaged take can crash HDF5, so a child process reads takes. kinalign's own readers of all
  // other formats are safe in this process.
  if (KA_TRY(kind_of_file(call.surroundings.files, in)) != FileKind::take) {
    return work().map_error(in_file(in));
  }
  const auto as_text = [&]() -> Result<std::string> {
    return KA_TRY(work().map_error(in_file(in))).dump();
  };
  AboutAnswer about =
      // A child process that has read a damaged take may return anything. Text that is no JSON
      // object is an error.
      AboutAnswer::parse(KA_TRY(run_guarded(GuardLimits{}, blame(in), as_text)), nullptr, false);
  if (about.is_object()) return about;
  return Failure(Error{in, 0, "a take that can be read", "an unreadable answer"});
}

Result<void> write_answer(Clip clip, double rate_hz, const std::string& model, Call& call) {
  // The check comes before the file is created, so that an existing file stays.
  if (!is_finite(clip)) {
    return Failure(Error{model, 0, "a model with finite answers", "NaN or infinite values"});
  }
  OutputFile file =
      KA_TRY(OutputFile::create(call.surroundings.files, call.common.out, call.common.overwrite()));
  KA_TRY(write_bvh(bvh_from_clip(std::move(clip), 1.0 / rate_hz),
                   [&](std::string_view text) { return file.write(text); }));
  return file.commit();
}

Result<void> keep_free(const Call& call) {
  const Common& common = call.common;
  if (common.out.empty()) return {};
  // The file is created but not committed, so it disappears again. This tests the name and the
  // permissions.
  (void)KA_TRY(OutputFile::create(call.surroundings.files, common.out, common.overwrite()));
  return {};
}

std::string answer_line(const AboutAnswer& about, const std::string& out) {
  return fmt::format("{}: {} frames at {:g} Hz, {} joints\n", out.empty() ? "live" : harmless(out),
                     grouped(about.at("frames").get<std::size_t>()),
                     about.at("rate_hz").get<double>(), about.at("joints").get<std::size_t>());
}

std::string seen_text(const AboutAnswer& about) {
  return fmt::format("{:.1f} % missing, {:.1f} % inferred",
                     100.0 * about.at("missing").get<double>(),
                     100.0 * about.at("inferred").get<double>());
}

int print_answer(std::string text, const AboutAnswer& about, Call& call) {
  call.console.print(with_warnings(std::move(text), about));
  call.console.print_json(json_text(about, 1));
  return about.at("warnings").empty() ? 0 : 1;
}

Result<int> end_live(Clip clip, const std::string& model, const std::string& text,
                     const AboutAnswer& about, Call& call) {
  if (!call.common.out.empty()) {
    KA_TRY(write_answer(std::move(clip), about.at("rate_hz").get<double>(), model, call));
    call.console.wrote(call.common.out);
  }
  // "event" is the first member, as in all other lines of a live run.
  AboutAnswer event{{"event", "ended"}};
  event.update(about);
  call.console.print(with_warnings(text + live_lines(about), about));
  call.console.print_json(json_text(event));
  return about.at("warnings").empty() ? 0 : 1;
}

}  // namespace kinalign
