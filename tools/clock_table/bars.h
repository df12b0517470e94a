// SPDX-License-Identifier: Apache-2.0
// The figures of a set held against what is promised of it.
#pragma once

#include "tools/clock_table/measure.h"
#include "tools/clock_table/promises.h"

#include <array>
#include <string>
#include <vector>

namespace kinalign {

/// One column of one promise, on one link.
struct Verdict {
  std::string source;  // "5.3": the section; "reference": a figure of its that is to be beaten
  Link link = Link::wired;
  std::string column;  // with its unit
  Extreme measured;
  double bar = 0.0;
  bool at_least = false;  // the bar is the least that is enough, not the most

  /// A figure that is not a number meets no bar.
  bool met() const { return at_least ? measured.value >= bar : measured.value <= bar; }
};

/// What is promised of the errors of such a set on a link: columns as in ErrorBars, ms.
std::array<Bar, 7> error_bars(const RunSet& set, Link link);

/// All columns that are promised of sets like this one (promises.h), link by link.
std::vector<Verdict> verdicts(const RunSet& set, std::span<const LinkFigures> tables);

}  // namespace kinalign
