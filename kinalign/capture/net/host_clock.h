// SPDX-License-Identifier: Apache-2.0
// The host's time axis, HostTime. It is CLOCK_MONOTONIC_RAW, which is never stepped or slewed. The
// kernel stamps arrivals on CLOCK_REALTIME, which may be stepped and slewed. Arrival stamps are
// therefore converted to HostTime and rounded up. An arrival stamp that is too late still gives a
// correct bound on a node's clock.
#pragma once

#include "kinalign/capture/net/event_queue.h"
#include "kinalign/clock/utc_anchor.h"
#include "kinalign/core/handle.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace kinalign {

/// Reads the system's clocks. Tests replace it.
class ClockReader {
 public:
  virtual ~ClockReader() = default;
  virtual HostTime raw() = 0;     // CLOCK_MONOTONIC_RAW
  virtual Time utc() = 0;         // CLOCK_REALTIME
  virtual Duration asleep() = 0;  // CLOCK_BOOTTIME - CLOCK_MONOTONIC
  /// Returns whether the wall clock was set since the previous call, by any amount.
  virtual bool wall_was_set() = 0;
};

class SystemClocks : public ClockReader {
 public:
  HostTime raw() override;
  Time utc() override;
  Duration asleep() override;
  /// Uses a timer that the kernel cancels when the wall clock is set (timerfd_create(2)). Returns
  /// false if the system has no such timer.
  bool wall_was_set() override;

 private:
  Handle timer_;  // created by the first call of wall_was_set
};

/// A reading of the wall clock between two readings of the host clock.
struct ClockBracket {
  HostTime before{};
  Time utc{};
  HostTime after{};
};

/// Returns whether the wall clock ran without a step between two brackets. `slew` is the greatest
/// relative rate of a slew. A step smaller than such a slew is not noticed here; wall_was_set
/// reports it, if the system supports that.
bool runs_on(const ClockBracket& earlier, const ClockBracket& later, double slew);

/// Greatest relative slew that is assumed when a stamp is converted to the host axis. The kernel's
/// own limit is 5e-4. A clock that is slewed faster gives no useful stamps.
inline constexpr double most_slew = 1e-3;

/// Converts a kernel stamp to HostTime. The datagram must have been received before the bracket
/// `behind` was read. `steady` is a reading of the wall clock since which it was not stepped. The
/// result is never earlier than the true arrival. If the stamp is absent or older than `steady`,
/// the result is the end of the bracket.
HostTime arrival(std::optional<Time> stamp, const ClockBracket& behind, Time steady);

struct HostClockEvent {
  enum class Kind : std::uint8_t {
    suspended,    // the host was suspended; earlier bounds on node clocks are invalid
    backwards,    // the raw clock went back; the axis continues, and node estimates begin again
    wall_stepped  // the wall clock was stepped; only reported, because no stamp depends on it
  };
  Kind kind{};
  HostTime at{};
  // Length of the suspension or size of the step.
  Duration by{};
};

/// Converts arrival stamps to the host's time axis, and detects suspensions and clock steps. The
/// ports of a recording share one axis, and the nodes' port has another. Stamps are converted with
/// the bracket that the last look() read, so call look() after each receive.
class HostAxis {
 public:
  explicit HostAxis(ClockReader& reader);

  /// The present host time. It is never earlier than the previous result.
  HostTime now();
  /// Call after datagrams were received and before arrival() is called for their stamps.
  void look();
  HostTime arrival(std::optional<Time> stamp) const {
    return kinalign::arrival(stamp, bracket_, steady_);
  }

  /// Call once a second. Returns a pair of host time and UTC for the recording. Such pairs later
  /// convert host times to UTC.
  ClockPair watch();
  /// Events since the previous call. Events beyond the limit are counted in missed_events.
  std::vector<HostClockEvent> take_events() { return events_.take(); }
  std::uint64_t missed_events() const { return events_.missed(); }
  /// Increases whenever the estimates of the node clocks must begin again.
  std::uint32_t epoch() const { return epoch_; }

 private:
  ClockBracket read();

  ClockReader& reader_;
  HostTime last_ = HostTime::min();
  Duration shift_{0};  // added to the raw clock so that the axis never goes back
  ClockBracket bracket_;
  Time steady_{};  // wall clock reading since which the wall clock was not stepped
  // The bracket of the last watch().
  std::optional<ClockBracket> watched_;
  bool was_set_ = false;  // the wall clock was set since the last watch()
  Duration asleep_;
  std::uint32_t epoch_ = 0;
  EventQueue<HostClockEvent> events_;
};

}  // namespace kinalign
