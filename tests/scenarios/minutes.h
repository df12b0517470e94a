// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinalign/simulate/nodes/exchanges.h"

namespace kinalign {

constexpr double ms = 1e-3;

/// The options for some minutes of exchanges over a link.
inline ExchangeOptions minutes(Link link, double minutes) {
  ExchangeOptions options;
  options.length_s = 60.0 * minutes;
  options.link.link = link;
  return options;
}

}  // namespace kinalign
