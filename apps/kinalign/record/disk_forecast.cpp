// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/disk_forecast.h"

#include "apps/kinalign/text/record_text.h"

#include <fmt/format.h>

#include <array>

namespace kinalign {

namespace {

/// The time in words: "3 min", "2.5 h", "12 d". A forecast deserves no more digits.
std::string minutes_text(double minutes) {
  if (minutes < 120) return fmt::format("{:.0f} min", minutes);
  if (minutes < 48 * 60) return fmt::format("{:.1f} h", minutes / 60);
  return fmt::format("{:.0f} d", minutes / 60 / 24);
}

}  // namespace

void DiskForecast::look(HostTime now, std::uint64_t written, std::uint64_t free) {
  constexpr Duration window = std::chrono::seconds(30);
  free_ = free;
  // Old looks are removed after the new one is added, so the deque is never empty here.
  looks_.push_back({now, written});
  while (now - looks_.front().at > window) looks_.pop_front();
}

std::optional<double> DiskForecast::minutes_left() const {
  constexpr double least_s = 2.0;  // a rate over less time is too inaccurate
  if (looks_.empty()) return std::nullopt;
  // The rate is the difference of both ends over their time; the looks in between do not matter.
  const auto& [begin, written_before] = looks_.front();
  const auto& [end, written] = looks_.back();
  const double s = seconds(end - begin);
  if (s < least_s || written <= written_before) return std::nullopt;
  // Within the reserve nothing is left.
  const double left = *free_ > reserve ? static_cast<double>(*free_ - reserve) : 0.0;
  return left * s / static_cast<double>(written - written_before) / 60.0;
}

bool DiskForecast::take_warning() {
  const auto left = minutes_left();
  if (!left) return false;
  // The loop finds the smallest step that has been reached. Steps that were skipped give one
  // warning only.
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
  // The second member is in decimal gigabytes, as disks are sold.
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
