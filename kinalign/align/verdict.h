// SPDX-License-Identifier: Apache-2.0
// Judges whether a stream of a take is good, usable or bad, and states why. The judgement compares
// the report's findings and figures with fixed limits, which docs/report.md lists for users.
#pragma once

#include "kinalign/take/report.h"

#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

enum class Quality { good, usable, bad };

/// Returns "good", "usable" or "bad".
std::string_view to_string(Quality quality);

/// One measured property of a stream, compared with its limits. Above the first limit the stream is
/// usable, but not good.
struct Concern {
  std::string stream;
  std::string part;  // joint or nodes concerned: "LeftForeArm", "waist"; empty: the whole stream
  std::string what;  // "2.2 % of samples invalid"
  /// The figure divided by the limit of `usable`; 0 if the property does not matter. Concerns are
  /// compared by this weight.
  double weight = 0.0;
  Quality quality = Quality::good;
};

/// Returns the concern as text: "ankle_left: 4.9 % of samples invalid".
std::string words_of(const Concern& concern);

struct Verdict {
  std::string stream;
  Quality quality = Quality::good;
  std::vector<Concern> concerns;  // worst first; includes concerns below the limits
  /// Short text: the worst concern. For a good stream it is the largest of its small concerns.
  std::string reason;
};

/// Judges one group of the take. `files`: the input files of the group, by which findings are
/// assigned to the group. An error makes the stream bad, a warning makes it usable. A finding about
/// a file with several streams applies to the stream that it names, or else to all of them.
Verdict verdict_of(const AlignmentReport& report, const std::string& stream,
                   const std::vector<InputFacts>& files);

/// Adds a concern that is not in the report.
void add_concern(Concern concern, Verdict& verdict);

/// Returns the worst concerns of all verdicts, at most `most`, without those of weight 0.
std::vector<Concern> worst_of(const std::vector<Verdict>& verdicts, std::size_t most);

}  // namespace kinalign
