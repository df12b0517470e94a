// SPDX-License-Identifier: Apache-2.0
// Three time axes. The compiler refuses to subtract, compare or assign times of different axes.
// Files of recordings contain only Time, which a TimeModel (kinalign/clock) converts to the take's
// axis. A live node has NodeTime, and the machine that receives its data has HostTime. A LiveClock
// or HostFromNode (kinalign/clock) converts from NodeTime to HostTime.
#pragma once

#include <chrono>
#include <cstdint>

namespace kinalign {

using Duration = std::chrono::nanoseconds;

struct UtcClock {};   // since 1970-01-01 UTC without leap seconds (POSIX); ends in 2262
struct HostClock {};  // CLOCK_MONOTONIC_RAW since one start of a host: never stepped or slewed
struct NodeClock {};  // since the node started; valid only together with its boot id

using Time = std::chrono::time_point<UtcClock, Duration>;
using HostTime = std::chrono::time_point<HostClock, Duration>;
using NodeTime = std::chrono::time_point<NodeClock, Duration>;

/// Converts a time to the integer in files and packets, and back.
constexpr std::int64_t to_ns(Time t) { return t.time_since_epoch().count(); }
constexpr Time utc_time(std::int64_t ns) { return Time{Duration{ns}}; }

/// later - earlier, ns. The unsigned subtraction is exact even if the signed difference would
/// exceed the range of Duration.
constexpr std::uint64_t step_between(Time earlier, Time later) {
  return static_cast<std::uint64_t>(to_ns(later)) - static_cast<std::uint64_t>(to_ns(earlier));
}

/// A duration in seconds. Stamps are first subtracted from a nearby origin, because a double of
/// seconds since 1970 is only exact to 0.24 us.
constexpr double seconds(Duration d) { return std::chrono::duration<double>(d).count(); }
/// The inverse of seconds(), cut to whole nanoseconds.
constexpr Duration from_seconds(double s) { return Duration{static_cast<std::int64_t>(s * 1e9)}; }

}  // namespace kinalign
