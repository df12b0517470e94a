// SPDX-License-Identifier: Apache-2.0
// What the clocks promise, as data: section 5 of the specification (time-sync.md).
#pragma once

#include "kinalign/simulate/link.h"

#include <array>

namespace kinalign {

/// 5.5: from the first frame until the live error stays under the limit, s.
struct StartBars {
  Link link;
  double limit;  // s, of the error
  double median, p90;
};
inline constexpr std::array start_bars{
    StartBars{Link::wired, 0.1e-3, 0.2, 0.5},     StartBars{Link::quiet, 1e-3, 0.2, 0.5},
    StartBars{Link::paper, 5e-3, 1.0, 3.0},       StartBars{Link::paper, 1e-3, 3.0, 7.0},
    StartBars{Link::modem_sleep, 1e-3, 1.5, 3.0}, StartBars{Link::congested, 1e-3, 1.0, 10.0},
    StartBars{Link::roaming, 1e-3, 0.5, 3.0},     StartBars{Link::thin_floor, 5e-3, 0.5, 2.0}};

}  // namespace kinalign
