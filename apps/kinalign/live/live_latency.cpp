// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/live/live_latency.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

/// A percentile: the value below which the fraction `share` of the newest values lies.
double value_at(const std::vector<float>& all, double share, std::size_t newest) {
  const auto count = static_cast<std::ptrdiff_t>(std::min(newest, all.size()));
  if (count == 0) return 0.0;
  std::vector<float> values(all.end() - count, all.end());
  // By the nearest-rank definition of a percentile, the value has the rank ceil(share * count),
  // counted from 1.
  const auto at = values.begin() +
                  static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(count)) - 1.0);
  // nth_element() changes the order of its values, so it works on a copy.
  std::nth_element(values.begin(), at, values.end());
  return static_cast<double>(*at);
}

}  // namespace

void LiveLatency::add(Duration after_arrival, Duration behind_motion) {
  // Memory is limited, so after `most` frames no more latencies are stored.
  if (after_arrival_.size() == most) return;
  after_arrival_.push_back(static_cast<float>(1e3 * seconds(after_arrival)));
  behind_motion_.push_back(static_cast<float>(1e3 * seconds(behind_motion)));
}

double LiveLatency::after_arrival_ms(double share, std::size_t newest) const {
  return value_at(after_arrival_, share, newest);
}

double LiveLatency::behind_motion_ms(double share, std::size_t newest) const {
  return value_at(behind_motion_, share, newest);
}

}  // namespace kinalign
