// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/disk_forecast.h"

#include "apps/kinalign/text/record_text.h"

#include <fmt/format.h>

#include <array>

namespace kinalign {

namespace {

/// A time in words: "3 min", "2.5 h", "12 d". A forecast is not exact enough for more digits.
std::string minutes_text(double minutes) {
  if (minutes < 120) return fmt::format("{:.0f} min", minutes);
  if (minutes < 48 * 60) return fmt::format("{:.1f} h", minutes / 60);
  return fmt::format("{:.0f} d", minutes / 60 / 24);
}

}  // namespace

void DiskForecast::look(HostTime now, std::uint64_t written, std::uint64_t free) {
  constexpr Duration window = std::chrono::seconds(30);
  free_ = free;
  // The new element is added before old ones are removed, so the deque is never empty.
  looks_.push_back({now, written});
  while (now - looks_.front().at > window) looks_.pop_front();
}

std::optional<double> DiskForecast::minutes_left() const {
  constexpr double least_s = 2.0;  // a rate from a shorter time is too inaccurate
  if (looks_.empty()) return std::nullopt;
  // The rate is computed from the first and the last element; those in between do not matter.
  const auto& [begin, written_before] = looks_.front();
  const auto& [end, written] = looks_.back();
  const double s = seconds(end - begin);
  if (s < least_s || written <= written_before) return std::nullopt;
  // If the free space is below the reserve, no time is left.
  const double left = *free_ > reserve ? static_cast<double>(*free_ - reserve) : 0.0;
  return left * s / static_cast<double>(written - written_before) / 60.0;
}

bool DiskForecast::take_warning() {
  const auto left = minutes_left();
  if (!left) return false;
  // The loop finds the smallest limit that has been reached. If several limits were passed at once,
  // there is one warning.
  double step = warned_;
  for (const double minutes : std::array{10.0, 5.0, 2.0, 1.0}) {
    if (*left <= minutes) step = minutes;
  }
  if (step >= warned_) return false;
  warned_ = step;
  return true;
}

std::string disk_text(const DiskForecast& forecast, std::uint64_t bytes, const std::string& path) {
  const auto left = forecast.minutes_left();
  const auto free = forecast.free();
  // Free space is printed in decimal gigabytes, as disks are sold.
  const std::string room = free ? fmt::format("{:.1f} GB", megabytes(*free) / 1e3) : "";
  std::string text = "disk  ";
  if (left) {
    text += fmt::format("{} left at this rate, {}; ", minutes_text(*left), room);
  } else if (free) {
    text += room + " left; ";
  }
  return text + fmt::format("{:.1f} MB in {}", megabytes(bytes), path);
}

}  // namespace kinalign
