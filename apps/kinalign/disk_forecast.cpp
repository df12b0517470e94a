// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/disk_forecast.h"

#include <array>

namespace kinalign {

void DiskForecast::look(HostTime now, std::uint64_t written, std::uint64_t free) {
  constexpr Duration window = std::chrono::seconds(30);
  looks_.push_back({now, written});
  while (now - looks_.front().at > window) looks_.pop_front();
  free_ = free;
}

std::optional<double> DiskForecast::minutes_left() const {
  constexpr double least_s = 2.0;  // of a rate that means something
  if (looks_.empty()) return std::nullopt;
  const double s = seconds(looks_.back().at - looks_.front().at);
  const std::uint64_t came = looks_.back().written - looks_.front().written;
  if (s < least_s || looks_.back().written <= looks_.front().written) return std::nullopt;
  const double left = free_ > reserve ? static_cast<double>(*free_ - reserve) : 0.0;
  return left / (static_cast<double>(came) / s) / 60.0;
}

bool DiskForecast::take_warning() {
  const auto left = minutes_left();
  if (!left) return false;
  double step = warned_;
  for (const double minutes : std::array{10.0, 5.0, 2.0, 1.0}) {
    if (*left <= minutes) step = minutes;
  }
  if (step >= warned_) return false;
  warned_ = step;
  return true;
}

}  // namespace kinalign
