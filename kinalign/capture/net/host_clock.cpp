// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/net/host_clock.h"

#include <sys/timerfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <limits>
#include <utility>

namespace kinalign {

namespace {

// a bracket at most this wide is not read again
constexpr Duration narrow = std::chrono::microseconds(2);
constexpr Duration reading_noise = std::chrono::microseconds(1);
constexpr Duration shortest_sleep = std::chrono::milliseconds(10);

Duration read_clock(clockid_t clock) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return std::chrono::seconds(now.tv_sec) + Duration{now.tv_nsec};
}

Duration share(Duration of, double part) {
  return Duration{static_cast<std::int64_t>(static_cast<double>(of.count()) * part)};
}

/// The least and the greatest possible value of the raw clock minus UTC.
std::pair<Duration, Duration> offsets(const ClockBracket& b) {
  const Duration utc = b.utc.time_since_epoch();
  return {b.before.time_since_epoch() - utc, b.after.time_since_epoch() - utc};
}

}  // namespace

HostTime SystemClocks::raw() { return HostTime{read_clock(CLOCK_MONOTONIC_RAW)}; }
Time SystemClocks::utc() { return Time{read_clock(CLOCK_REALTIME)}; }

// CLOCK_BOOTTIME counts during a suspension, CLOCK_MONOTONIC does not.
Duration SystemClocks::asleep() {
  Duration least = Duration::max();
  for (int i = 0; i < 3; ++i) {  // an interruption between the two readings looks like a suspension
    const Duration running = read_clock(CLOCK_MONOTONIC);
    least = std::min(least, read_clock(CLOCK_BOOTTIME) - running);
  }
  return least;
}

// The kernel cancels a timer of this kind when the wall clock is set. The next read of the timer
// then fails once with ECANCELED.
bool SystemClocks::wall_was_set() {
  if (timer_.fd() < 0) {
    timer_ = Handle(::timerfd_create(CLOCK_REALTIME, TFD_NONBLOCK | TFD_CLOEXEC));
    itimerspec never{};
    // if the clock reaches this time in 2038, the read below succeeds
    never.it_value.tv_sec = std::numeric_limits<std::int32_t>::max();
    ::timerfd_settime(timer_.fd(), TFD_TIMER_ABSTIME | TFD_TIMER_CANCEL_ON_SET, &never, nullptr);
  }
  std::uint64_t ticks = 0;
  return ::read(timer_.fd(), &ticks, sizeof ticks) < 0 && errno == ECANCELED;
}

bool runs_on(const ClockBracket& earlier, const ClockBracket& later, double slew) {
  const auto [least_then, greatest_then] = offsets(earlier);
  const auto [least, greatest] = offsets(later);
  const Duration slack = reading_noise + share(later.after - earlier.before, slew);
  return least - slack <= greatest_then && least_then <= greatest + slack;
}

// The time from the stamp to the end of the bracket is reduced by the greatest slew. The result may
// therefore be late, but never early.
HostTime arrival(std::optional<Time> stamp, const ClockBracket& behind, Time steady) {
  if (!stamp || *stamp < steady || *stamp > behind.utc) return behind.after;
  const Duration since = behind.utc - *stamp;
  return behind.after - share(since, 1.0 - most_slew);
}

HostAxis::HostAxis(ClockReader& reader) : reader_(reader), asleep_(reader.asleep()) {
  static_cast<void>(reader_.wall_was_set());  // discards earlier settings of the wall clock
  bracket_ = read();
  steady_ = bracket_.utc;
}

// If the raw clock goes back, the axis repeats its last value and is shifted from then on.
HostTime HostAxis::now() {
  const HostTime read = reader_.raw() + shift_;
  if (read < last_) {
    ++epoch_;
    shift_ += last_ - read;
    events_.add({HostClockEvent::Kind::backwards, last_, last_ - read});
    return last_;
  }
  last_ = read;
  return read;
}

// An interruption makes a bracket wide, so the narrowest of up to three readings is kept.
ClockBracket HostAxis::read() {
  ClockBracket best;
  for (int i = 0; i < 3; ++i) {
    const HostTime before = now();
    const Time utc = reader_.utc();
    const ClockBracket bracket{before, utc, now()};
    if (i == 0 || bracket.after - bracket.before < best.after - best.before) best = bracket;
    if (best.after - best.before <= narrow) break;
  }
  return best;
}

/// A datagram may wait in the buffer while the wall clock is stepped. Its stamp is then older than
/// steady_.
void HostAxis::look() {
  const ClockBracket before = std::exchange(bracket_, read());
  // called after the bracket was read, so that a step before the bracket is noticed
  const bool set = reader_.wall_was_set();
  was_set_ = was_set_ || set;
  // A stamp from before this step can't be converted to host time.
  if (set || !runs_on(before, bracket_, most_slew)) steady_ = bracket_.utc;
}

// A suspension of more than 10 ms starts a new epoch. A step of the wall clock is only reported.
ClockPair HostAxis::watch() {
  const ClockBracket bracket = read();
  const Duration asleep = reader_.asleep();
  if (asleep - asleep_ > shortest_sleep) {
    ++epoch_;
    events_.add({HostClockEvent::Kind::suspended, bracket.after, asleep - asleep_});
  }
  asleep_ = asleep;
  const bool seen = std::exchange(was_set_, false);
  const bool set = reader_.wall_was_set();
  if (set) steady_ = bracket.utc;
  if (watched_ && (seen || set || !runs_on(*watched_, bracket, fastest_slew))) {
    const Duration by = offsets(*watched_).first - offsets(bracket).first;
    events_.add({HostClockEvent::Kind::wall_stepped, bracket.after, by});
  }
  watched_ = bracket;
  return {bracket.before + (bracket.after - bracket.before) / 2, bracket.utc};
}

}  // namespace kinalign
