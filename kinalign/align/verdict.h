// SPDX-License-Identifier: Apache-2.0
// Whether a stream of a take is good, usable or bad, and why: from the report's findings and
// figures, by fixed limits. docs/report.md lists the limits for users.
#pragma once

#include "kinalign/take/report.h"

#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

enum class Quality { good, usable, bad };

/// "good", "usable", "bad"
std::string_view to_string(Quality quality);

/// Something measured of a stream, against the limit above which the stream is only usable.
struct Concern {
  std::string stream;
  std::string part;  // "LeftForeArm", "waist": whose it is; empty: all of the stream
  std::string what;  // "2.2 % of samples invalid"
  /// 1 at the limit of `usable`; what counts nothing has 0. For comparing concerns with each other.
  double weight = 0.0;
  Quality quality = Quality::good;
};

/// "ankle_left: 4.9 % of samples invalid"
std::string words_of(const Concern& concern);

struct Verdict {
  std::string stream;
  Quality quality = Quality::good;
  std::vector<Concern> concerns;  // worst first; also those that cost nothing
  /// In a few words; of a good stream the largest of its small concerns.
  std::string reason;
};

/// Judges one group of the take. `files`: the inputs of the group, by which findings name it. An
/// error makes it bad, a warning usable. A finding of a file that several streams share counts for
/// the stream that it names, or for all of them.
Verdict verdict_of(const AlignmentReport& report, const std::string& stream,
                   const std::vector<InputFacts>& files);

/// One more concern, of what the report does not know.
void add_concern(Concern concern, Verdict& verdict);

/// The heaviest concerns of all, at most `most`, none that weighs nothing.
std::vector<Concern> worst_of(const std::vector<Verdict>& verdicts, std::size_t most);

}  // namespace kinalign
