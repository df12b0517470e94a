// SPDX-License-Identifier: Apache-2.0
// The numbers of a report as text, the same on a terminal and on a page.
#pragma once

#include "kinalign/core/numbers.h"

#include <cstdint>
#include <optional>
#include <string>

namespace kinalign {

/// Returns the time accuracy of a stream's stamps: "shared clock", "± 3.6 ms", "counted stamps of
/// unknown accuracy". `counted`: the stamps were computed from the number of samples.
std::string clock_text(const std::optional<std::int64_t>& interval_ns, bool counted);

/// Returns the time from the first row to the end of the last row, which lasts one usual step. A
/// take of one row at 30 Hz therefore lasts 33 ms, not 0.
double take_seconds(std::int64_t begin_ns, std::int64_t end_ns, double rate_hz);

/// Returns a time as text: 61.5 s gives "1 min 01 s". Below a minute it has hundredths of a second.
std::string duration_text(double s);

/// Returns a share in per cent with one digit; "< 0.1 %" if it would be displayed as 0; empty if it
/// is zero.
std::string share_text(std::uint64_t part, std::uint64_t whole);

/// Returns a stamp as UTC date and time, to the millisecond: "2026-09-21 14:13:20.000". The caller
/// adds "UTC".
std::string date_text(std::int64_t ns);

/// Returns whether a stamp is a date. Stamps of devices without a calendar count from near zero.
bool is_date(std::int64_t ns);

}  // namespace kinalign
