// SPDX-License-Identifier: Apache-2.0
// The figures of a set compared with the promises for it.
#pragma once

#include "tools/clock_table/measure.h"
#include "tools/clock_table/promises.h"

#include <array>
#include <string>
#include <vector>

namespace kinalign {

/// The verdict on one column of one promise, on one link.
struct Verdict {
  /// "5.3": the section; "reference": a figure of the reference simulator that is to be beaten.
  std::string source;
  Link link = Link::wired;
  std::string column;  // name of the column with its unit
  Extreme measured;
  double bar = 0.0;
  bool at_least = false;  // the bar is a lower limit; false: an upper limit

  /// A figure that is not a number meets no bar.
  bool met() const { return at_least ? measured.value >= bar : measured.value <= bar; }
};

/// The promised bars for the errors of such a set on a link: columns as in ErrorBars, ms.
std::array<Bar, 7> error_bars(const RunSet& set, Link link);

/// All columns that are promised of sets like this one (promises.h), link by link.
std::vector<Verdict> verdicts(const RunSet& set, std::span<const LinkFigures> tables);

}  // namespace kinalign
