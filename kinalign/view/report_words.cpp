// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/report_words.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>

namespace kinalign {

double take_seconds(std::int64_t begin_ns, std::int64_t end_ns, double rate_hz) {
  const double last = rate_hz > 0.0 ? 1.0 / rate_hz : 0.0;
  return 1e-9 * (static_cast<double>(end_ns) - static_cast<double>(begin_ns)) + last;
}

std::string duration_text(double s) {
  // 59.995 s would be displayed as "60.00 s", so minutes are used from this value on. `longest`
  // prevents overflow in the conversion to an integer.
  constexpr double shown_as_minute = 59.995, longest = 1e15;
  // The condition is also true for NaN.
  if (!(s >= shown_as_minute)) return fmt::format("{:.2f} s", s);
  const auto whole = static_cast<std::int64_t>(std::min(s + 0.005, longest));
  return whole < 3600
             ? fmt::format("{} min {:02} s", whole / 60, whole % 60)
             : fmt::format("{} h {:02} min {:02} s", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string share_text(std::uint64_t part, std::uint64_t whole) {
  if (part == 0 || whole == 0) return "";
  // 0.04 % with one digit would be displayed as 0.0 %, although the share is not zero.
  const double percent = 100.0 * static_cast<double>(part) / static_cast<double>(whole);
  return percent < 0.05 ? "< 0.1 %" : fmt::format("{:.1f} %", percent);
}

std::string clock_text(const std::optional<std::int64_t>& interval_ns, bool counted) {
  if (!interval_ns)
    return counted ? "counted stamps of unknown accuracy" : "stamps of unknown accuracy";
  // An interval of 0 means that the stream and the reference use the same clock.
  if (*interval_ns == 0) return counted ? "counted stamps, shared clock" : "shared clock";
  return fmt::format("{}± {:.1f} ms", counted ? "counted stamps " : "",
                     1e-6 * static_cast<double>(*interval_ns));
}

std::string date_text(std::int64_t ns) {
  // The stamp is rounded to milliseconds before it is split, so that the millisecond part is below
  // 1000.
  const std::int64_t ms = (ns + 500'000) / 1'000'000;
  return fmt::format("{:%F %T}.{:03}", fmt::gmtime(std::time_t{ms / 1000}), ms % 1000);
}

bool is_date(std::int64_t ns) {
  // About one year. Stamps of a device with a calendar are much later than 1970, and counts from a
  // start are shorter than a year.
  constexpr std::int64_t year_ns = 32'000'000'000'000'000;
  return ns >= year_ns;
}

}  // namespace kinalign
