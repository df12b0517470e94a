// SPDX-License-Identifier: Apache-2.0
// The host's axis, HostTime: CLOCK_MONOTONIC_RAW, which nobody steps or slews. The kernel stamps
// arrivals on CLOCK_REALTIME, which anybody may; they are moved over here, rounded up, since a
// later arrival bounds a node's clock as truly as the right one.
#pragma once

#include "kinalign/capture/net/event_queue.h"
#include "kinalign/clock/utc_anchor.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace kinalign {

/// The system's clocks; a test brings its own.
class ClockReader {
 public:
  virtual ~ClockReader() = default;
  virtual HostTime raw() = 0;     // CLOCK_MONOTONIC_RAW
  virtual Time utc() = 0;         // CLOCK_REALTIME
  virtual Duration asleep() = 0;  // CLOCK_BOOTTIME - CLOCK_MONOTONIC
  /// Whether the wall clock was set, by however little, since this was asked last.
  virtual bool wall_was_set() = 0;
};

/// The wall clock runs with CLOCK_MONOTONIC, slewed as that is, unless it is set. So what a look at
/// both says spares the question to the kernel, a system call for each datagram: a step shows in
/// it, unless it is smaller than a look takes, some 0.1 us. Such a one the next question finds.
class WallWatch {
 public:
  struct Look {
    Duration at{};             // CLOCK_MONOTONIC
    Duration least{}, most{};  // CLOCK_REALTIME less that: read between two readings of it
  };
  /// Whether the kernel has to be asked: the wall clock may have been set, or it was not asked for
  /// a tenth of a second.
  bool must_ask(const Look& look);

 private:
  std::optional<Look> ran_;  // since the kernel was asked: when that was, and what all looks allow
};

class SystemClocks : public ClockReader {
 public:
  SystemClocks() = default;
  SystemClocks(const SystemClocks&) = delete;
  SystemClocks& operator=(const SystemClocks&) = delete;
  ~SystemClocks() override;

  HostTime raw() override;
  Time utc() override;
  Duration asleep() override;
  /// By a timer that the kernel cancels then (timerfd_create(2)); false where there is none. What
  /// WallWatch says of how little.
  bool wall_was_set() override;

 private:
  WallWatch watch_;
  std::optional<int> timer_;  // since it was asked first
};

/// utc was read between the two.
struct ClockBracket {
  HostTime before{};
  Time utc{};
  HostTime after{};
};

/// Whether the wall clock ran on between two brackets: no step beyond what such a slew makes of the
/// time between them. Smaller ones the system tells, where it can.
bool runs_on(const ClockBracket& earlier, const ClockBracket& later, double slew);

/// As much is allowed for where a stamp is moved to the raw axis: the kernel's own is 5e-4, and one
/// that is slewed faster has no stamps of use.
inline constexpr double most_slew = 1e-3;

/// When a datagram arrived that the kernel stamped, and that was received before the bracket was
/// read. Never earlier than the truth if the wall clock has run on since `steady`; the end of the
/// bracket where the stamp is from before that, or there is none.
HostTime arrival(std::optional<Time> stamp, const ClockBracket& behind, Time steady);

/// When something came: as arrival() has it, and as the kernel stamped it, where it did.
struct Moment {
  HostTime at{};
  std::optional<Time> stamp{};
};
/// Later, as far as is known. Arrivals are moved over with a doubt of their own each; stamps have
/// none, unless somebody sets the clock between the two: then both have to say so.
bool is_behind(const Moment& one, const Moment& other);

struct HostClockEvent {
  enum class Kind : std::uint8_t {
    suspended,    // the host slept: nothing is known of nodes' clocks from before
    backwards,    // the raw clock went back; its axis goes on, and clocks begin anew
    wall_stepped  // noted alone: no stamp depends on it
  };
  Kind kind{};
  HostTime at{};
  Duration by{};
};

class HostAxis {
 public:
  explicit HostAxis(ClockReader& reader);

  /// Never earlier than what it said before.
  HostTime now();
  /// After datagrams were received, before their arrival is asked for.
  void look();
  HostTime arrival(std::optional<Time> stamp) const {
    return kinalign::arrival(stamp, bracket_, steady_);
  }

  /// Once a second: a pair for the log that gives UTC afterwards.
  ClockPair watch();
  /// What was seen since this was asked last, and how many more had no room.
  std::vector<HostClockEvent> take_events() { return events_.take(); }
  std::uint64_t missed_events() const { return events_.missed(); }
  /// Rises where clocks of nodes have to begin anew.
  std::uint32_t epoch() const { return epoch_; }

 private:
  ClockBracket read();

  ClockReader& reader_;
  HostTime last_ = HostTime::min();
  Duration shift_{0};  // of the raw clock, since it went back
  ClockBracket bracket_;
  Time steady_{};  // since when the wall clock has run on; as it says
  std::optional<ClockBracket> watched_;
  bool was_set_ = false;  // the wall clock, since then
  Duration asleep_;
  std::uint32_t epoch_ = 0;
  EventQueue<HostClockEvent> events_;
};

}  // namespace kinalign
