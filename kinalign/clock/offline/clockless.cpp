// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/offline/clockless.h"

#include "kinalign/clock/lifted_hull.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

std::optional<Duration> one_way_delay(const ClocklessExchange& exchange) {
  if (!exchange.t6) return std::nullopt;
  return (*exchange.t6 - exchange.t3) / 2;
}

std::optional<Duration> least_one_way_delay(std::span<const ClocklessExchange> exchanges) {
  std::optional<Duration> least;
  for (const ClocklessExchange& e : exchanges) {
    if (const auto d = one_way_delay(e)) least = std::min(least.value_or(*d), *d);
  }
  return least;
}

std::vector<std::optional<HostTime>> stamps_by_each_delay(
    std::span<const ClocklessExchange> exchanges) {
  std::vector<std::optional<HostTime>> stamps;
  for (const ClocklessExchange& e : exchanges) {
    const auto d = one_way_delay(e);
    stamps.push_back(d ? std::optional(e.t2 - *d) : std::nullopt);
  }
  return stamps;
}

std::optional<std::vector<HostTime>> stamps_by_mean_delay(
    std::span<const ClocklessExchange> exchanges) {
  Duration sum{};
  std::int64_t count = 0;
  for (const ClocklessExchange& e : exchanges) {
    if (const auto d = one_way_delay(e)) {
      sum += *d;
      ++count;
    }
  }
  if (count == 0) return std::nullopt;
  std::vector<HostTime> stamps;
  for (const ClocklessExchange& e : exchanges) stamps.push_back(e.t2 - sum / count);
  return stamps;
}

std::optional<std::vector<HostTime>> stamps_by_frame_number(
    std::span<const ClocklessExchange> exchanges, double rate_hz, double curvature) {
  const auto least = least_one_way_delay(exchanges);
  if (!least) return std::nullopt;
  const ClocklessExchange& origin = exchanges.front();
  const auto planned = [&](const ClocklessExchange& e) {
    return static_cast<double>(e.frame - origin.frame) / rate_hz;
  };
  // The frame number gives the planned time. The hull of the arrivals follows the frames with the
  // least delay.
  LiftedHull hull(curvature);
  for (const ClocklessExchange& e : exchanges) {
    hull.add(planned(e), seconds(e.t2 - origin.t2) - planned(e));
  }
  std::vector<HostTime> stamps;
  for (const ClocklessExchange& e : exchanges) {
    const double t = planned(e), since = t + hull.peak(t).bound;
    stamps.push_back(origin.t2 + Duration{std::llround(since * 1e9)} - *least);
  }
  return stamps;
}

}  // namespace kinalign
