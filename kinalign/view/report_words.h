// SPDX-License-Identifier: Apache-2.0
// Figures of a report in words, the same on a terminal and on a page.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace kinalign {

/// How sure a stream's stamps are: "shared clock", "± 3.6 ms", "counted stamps of unknown
/// accuracy".
std::string clock_text(const std::optional<std::int64_t>& interval_ns, bool counted);

/// 3601: "3,601".
std::string grouped(std::uint64_t number);

/// From the first row to the end of the last one, which lasts as long as a usual step.
double take_seconds(std::int64_t begin_ns, std::int64_t end_ns, double rate_hz);

/// 61.5 s: "1 min 01 s".
std::string duration_text(double s);

/// A share in per cent with one digit; "< 0.1 %" where that shows nothing; empty where it is zero.
std::string share_text(std::uint64_t part, std::uint64_t whole);

/// A stamp as calendars have it, to the millisecond: "2026-09-21 14:13:20.000".
std::string date_text(std::int64_t ns);

/// Devices without a calendar count from near zero: such a stamp is no date.
bool is_date(std::int64_t ns);

}  // namespace kinalign
