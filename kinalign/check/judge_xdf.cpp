// SPDX-License-Identifier: Apache-2.0
#include "kinalign/check/judge_survey.h"
#include "kinalign/core/numbers.h"

#include <fmt/format.h>

namespace kinalign {

namespace {

/// Makes findings about one stream. Unusable stamps are a warning; all other facts are notes.
void judge_stream(const XdfStreamSurvey& one, FileFindings& out) {
  const std::string stream = fmt::format(" of stream '{}'", shown(one.stream.name));
  // A stream without samples has no further findings.
  if (one.samples == 0) {
    out.add(Severity::note, "samples" + stream, "none",
            "this stream was recorded, but its sender sent no samples");
    return;
  }
  // A stamp that is not a number, or is too large, gives no time.
  if (one.timeless > 0) {
    out.add(Severity::warning, "stamps below 1e15" + stream,
            grouped(one.timeless) + " other stamps", "these samples have no time");
  }
  if (one.backward > 0) {
    out.add(Severity::warning, "rising stamps" + stream,
            fmt::format("{} that step back, by up to {:.3f} s", grouped(one.backward),
                        one.largest_step_back_s),
            "the sender's clock was set back, or samples arrived out of order");
  }
  // NaN usually marks a missing value, so it is only a note.
  if (one.no_numbers > 0) {
    out.add(Severity::note, "finite values" + stream,
            grouped(one.no_numbers) + " NaN or infinite values",
            "many senders mark missing measurements this way");
  }
  // Without clock offsets, the stamps are taken as stamps of the recorder's clock. This is right if
  // sender and recorder ran on one machine.
  if (one.clock.empty()) {
    out.add(Severity::note, "clock offsets" + stream, "none",
            "its stamps are treated as stamps of the recorder's clock");
  } else if (one.clock.size() > 1) {
    out.add(
        Severity::warning, "one clock" + stream, fmt::format("{} clocks", one.clock.size()),
        "the clock was reset during the recording; each stamp is converted by the nearest clock "
        "line");
  }
}

}  // namespace

Findings judge_survey(const std::string& path, const XdfSurvey& survey) {
  // The findings of the reader are reported first.
  FileFindings out{path, survey.findings};
  for (const XdfStreamSurvey& one : survey.streams) judge_stream(one, out);
  if (survey.streams.empty()) {
    out.add(Severity::warning, "a readable stream", "none",
            "this file has no data that can be used");
  }
  return out.all;
}

}  // namespace kinalign
