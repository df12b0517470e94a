// SPDX-License-Identifier: Apache-2.0
// The measured tables of docs/clock_figures.md: RMS, p99, worst stamp,
// certificates, widths, gains and starts. They stand between the page's two comments.
#pragma once

#include "tools/clock_table/measure.h"

#include <string>

namespace kinalign {

/// The four sets of the tables on all links, from seed `first` on.
struct PageSets {
  RunSet minute, ten_minutes, hour, bursts;
};
PageSets page_sets(std::uint64_t first);

/// The figures of the sets: one entry for each link, A to G.
struct PageFigures {
  PageSets sets;
  std::vector<LinkFigures> minute, ten_minutes, hour, bursts;
};
PageFigures measure(const PageSets& sets);

std::string markdown(const PageFigures& page);

}  // namespace kinalign
