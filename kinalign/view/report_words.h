// SPDX-License-Identifier: Apache-2.0
// The numbers of a report in words, the same on a terminal and on a page.
#pragma once

#include "kinalign/core/numbers.h"

#include <cstdint>
#include <optional>
#include <string>

namespace kinalign {

/// The certainty of a stream's stamps: "shared clock", "± 3.6 ms", "counted stamps of unknown
/// accuracy".
/// `counted`: the stamps were made from the count of samples, not measured.
std::string clock_text(const std::optional<std::int64_t>& interval_ns, bool counted);

/// The time from the first row to the end of the last one, which lasts one usual step.
/// So a take of one row at 30 Hz lasts 33 ms, and not 0.
double take_seconds(std::int64_t begin_ns, std::int64_t end_ns, double rate_hz);

/// The time in words: 61.5 s gives "1 min 01 s".
/// Below a minute it has hundredths of a second.
std::string duration_text(double s);

/// A share in per cent with one digit; "< 0.1 %" if that would show 0; empty if it is zero.
std::string share_text(std::uint64_t part, std::uint64_t whole);

/// A stamp as date and time, to the millisecond: "2026-09-21 14:13:20.000".
/// UTC, by the calendar; the caller adds the words for it.
std::string date_text(std::int64_t ns);

/// False for stamps of devices without a calendar, which count from near zero.
bool is_date(std::int64_t ns);

}  // namespace kinalign
