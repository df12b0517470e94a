// SPDX-License-Identifier: Apache-2.0
#include "kinalign/check/judge_survey.h"

#include <fmt/format.h>

#include <cmath>

namespace kinalign {

Findings judge_survey(const ClipSurvey& survey, const StreamOptions& options) {
  if (!options.start_ns || !options.end_ns) return {};
  const double step = 1e-9 * survey.step_ns;
  const double between = 1e-9 * static_cast<double>(*options.end_ns - *options.start_ns);
  const double stated = step * static_cast<double>(survey.survey.samples);
  if (std::abs(between - stated) <= 2.0 * step) return {};
  FileFindings out{survey.facts.name};
  out.add(Severity::warning, fmt::format("{:.3f} s between the clicks", between),
          fmt::format("{} frames of {:.6g} s, {:.3f} s", survey.survey.samples, step, stated),
          "stamps are counted from the first click by the file's step",
          "the true step may differ from the file's, or frames are missing");
  return out.all;
}

}  // namespace kinalign
