// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/learn/answer_output.h"

#include "apps/cli/console.h"
#include "apps/kinalign/text/describe_file.h"
#include "apps/kinalign/verbs/inputs.h"

#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/formats/take/guarded.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinalign {

namespace {

bool is_finite(const Clip& clip) {
  const auto is_number = [](double value) { return std::isfinite(value); };
  const ClipFrames& frames = clip.frames;
  return std::all_of(frames.local_positions.begin(), frames.local_positions.end(), is_number) &&
         std::all_of(frames.local_rotations.begin(), frames.local_rotations.end(), is_number);
}

}  // namespace

Result<AboutAnswer> in_child(const std::string& in,
                             const std::function<Result<AboutAnswer>()>& work) {
  const auto as_text = [&]() -> Result<std::string> { return KA_TRY(work()).dump(); };
  AboutAnswer about =
      AboutAnswer::parse(KA_TRY(run_guarded(GuardLimits{}, blame(in), as_text)), nullptr, false);
  if (about.is_object()) return about;
  return Failure(Error{in, 0, "a take that can be read", "another answer"});
}

Result<void> write_answer(Clip clip, double rate_hz, const std::string& model, Call& call) {
  if (!is_finite(clip)) {
    return Failure(Error{model, 0, "a model that answers with numbers", "others"});
  }
  OutputFile file =
      KA_TRY(OutputFile::create(call.surroundings.files, call.common.out, call.common.overwrite()));
  KA_TRY(write_bvh(bvh_from_clip(std::move(clip), 1.0 / rate_hz),
                   [&](std::string_view text) { return file.write(text); }));
  return file.commit();
}

void print_answer(std::string text, const AboutAnswer& about, Call& call) {
  for (const AboutAnswer& warning : about.at("warnings")) {
    text += fmt::format("warning  {}\n", harmless(warning.get<std::string>()));
  }
  call.console.print(text);
  call.console.print_json(about.dump(1, ' ', false, AboutAnswer::error_handler_t::replace));
}

}  // namespace kinalign
