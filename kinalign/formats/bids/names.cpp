// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/bids/names.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

namespace kinalign {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// The parts of a time. They are separate, because a year far in the future does not fit into a
/// Time.
struct TimeParts {
  std::chrono::sys_days day;
  std::chrono::seconds of_day{};
  std::chrono::nanoseconds fraction{};
};

/// The number of `count` digits from `at` on; -1 if other characters stand there. Signs and blanks
/// are not accepted, unlike in std::from_chars.
int digits_at(std::string_view text, std::size_t at, std::size_t count) {
  if (text.size() < at + count) return -1;
  int value = 0;
  for (const char c : text.substr(at, count)) {
    if (!is_digit(c)) return -1;
    value = 10 * value + (c - '0');
  }
  return value;
}

/// Converts a fraction of a second to ns, for example ".25". Digits after the ninth are cut off.
std::optional<std::chrono::nanoseconds> fraction_of(std::string_view text) {
  if (text.empty()) return std::chrono::nanoseconds{0};
  if (text.size() < 2 || text[0] != '.') return std::nullopt;
  text.remove_prefix(1);
  if (!std::all_of(text.begin(), text.end(), is_digit)) return std::nullopt;
  std::int64_t ns = 0;
  // A missing digit counts as 0, so ".5" is 500,000,000 ns.
  for (std::size_t i = 0; i < 9; ++i) ns = 10 * ns + (i < text.size() ? text[i] - '0' : 0);
  return std::chrono::nanoseconds{ns};
}

/// Parses a time and checks the range of each part. A leap second (60) is allowed.
std::optional<TimeParts> time_parts_of(std::string_view text) {
  constexpr std::size_t whole = 19;  // YYYY-MM-DDThh:mm:ss
  // A time without Z is read as UTC.
  if (text.ends_with('Z')) text.remove_suffix(1);
  if (text.size() < whole) return std::nullopt;
  const bool separated =
      text[4] == '-' && text[7] == '-' && text[10] == 'T' && text[13] == ':' && text[16] == ':';
  const int year = digits_at(text, 0, 4), month = digits_at(text, 5, 2),
            day = digits_at(text, 8, 2), hour = digits_at(text, 11, 2),
            minute = digits_at(text, 14, 2), second = digits_at(text, 17, 2);
  const auto fraction = fraction_of(text.substr(whole));
  if (!separated || !fraction || year < 0 || hour < 0 || hour > 23 || minute < 0 || minute > 59 ||
      second < 0 || second > 60 || month < 0 || day < 0) {
    return std::nullopt;
  }
  // The calendar checks the length of the month.
  const std::chrono::year_month_day date{std::chrono::year{year},
                                         std::chrono::month{static_cast<unsigned>(month)},
                                         std::chrono::day{static_cast<unsigned>(day)}};
  if (!date.ok()) return std::nullopt;
  return TimeParts{std::chrono::sys_days{date},
                   std::chrono::seconds{3600 * hour + 60 * minute + second}, *fraction};
}

}  // namespace

bool is_bids_label(std::string_view text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](char c) { return is_digit(c) || is_letter(c); });
}

std::string bids_subject_folder(const BidsEntities& e) { return "sub-" + e.subject + "/"; }

std::string bids_path(const BidsEntities& e, std::string_view ending) {
  std::string name = "sub-" + e.subject + "_task-" + e.task + "_tracksys-" + e.system;
  if (!e.run.empty()) name += "_run-" + e.run;
  return bids_subject_folder(e) + "motion/" + name + "_" + std::string(ending);
}

std::string bids_scans_path(const BidsEntities& e) {
  return bids_subject_folder(e) + "sub-" + e.subject + "_scans.tsv";
}

std::string_view BidsName::label(std::string_view key) const {
  for (const auto& [name, label] : entities) {
    if (name == key) return label;
  }
  return {};
}

std::optional<BidsName> parse_bids_name(std::string_view file_name) {
  BidsName out;
  for (;;) {
    const auto end = file_name.find('_');
    // The last part has no key. It consists of suffix and extension.
    if (end == std::string_view::npos) {
      out.ending = file_name;
      if (file_name.empty() || file_name.find('-') != std::string_view::npos) return std::nullopt;
      return out;
    }
    const std::string_view part = file_name.substr(0, end);
    // "key-" and "-label" are not entities.
    const auto dash = part.find('-');
    if (dash == std::string_view::npos || dash == 0 || dash + 1 == part.size()) return std::nullopt;
    out.entities.emplace_back(part.substr(0, dash), part.substr(dash + 1));
    file_name.remove_prefix(end + 1);
  }
}

std::string acq_time_text(Time time) {
  const std::chrono::sys_time<Duration> at{time.time_since_epoch()};
  // floor() is used, because times before 1970 are negative.
  const auto day = std::chrono::floor<std::chrono::days>(at);
  const std::chrono::year_month_day date{day};
  const std::chrono::hh_mm_ss of_day{std::chrono::floor<std::chrono::microseconds>(at - day)};
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:06}Z", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                     of_day.hours().count(), of_day.minutes().count(), of_day.seconds().count(),
                     of_day.subseconds().count());
}

std::optional<Time> parse_acq_time(std::string_view text) {
  const auto parts = time_parts_of(text);
  if (!parts) return std::nullopt;
  const int year = static_cast<int>(std::chrono::year_month_day{parts->day}.year());
  // Readers accept +-4e18 ns, which is 1843 to 2096.
  if (year < 1850 || year > 2090) return std::nullopt;
  const std::chrono::nanoseconds whole = parts->day.time_since_epoch() + parts->of_day;
  return Time{whole + parts->fraction};
}

bool is_acq_time(std::string_view text) { return time_parts_of(text).has_value(); }

}  // namespace kinalign
