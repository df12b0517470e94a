// SPDX-License-Identifier: Apache-2.0
// What alignment did, in the few lines that people read first: the worst stands first.
#pragma once

#include "kinalign/take/report.h"

#include <cstdint>
#include <optional>
#include <string>

namespace kinalign {

class Console;

/// `out` is the take's file; empty: nothing was written. Colours are the console's.
std::string summary(const AlignmentReport& report, const std::string& out, const Console& console);

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

}  // namespace kinalign
