// SPDX-License-Identifier: Apache-2.0
// The lines about the nodes' clocks that a user reads while a server or recorder runs. A clock that
// keeps contradicting the assumptions gets a single line. Programs get every event (--json).
#pragma once

#include "apps/kinalign/text/node_names.h"

#include "kinalign/clock/clock_event.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace kinalign {

/// The reason printed for a clock that contradicts the assumptions. It stands after "node 7: " or
/// "not locked: ".
inline constexpr std::string_view contradiction_text =
    "its clock keeps contradicting the assumptions (drift above 100 ppm, or the node sleeps)";

/// Chooses the events that get a line for people: only those that say something new. A clock that
/// steps again and again would otherwise fill the screen. Invariant: `steps` has the last three
/// steps, the newest one last.
class ClockEventLines {
 public:
  explicit ClockEventLines(NodeNames names = {}) : names_(std::move(names)) {}

  /// The line about an event. Empty if the event gets no line. `now`: the time of the call on the
  /// host's raw clock.
  std::string line(std::size_t stream, std::uint32_t node_id, const ClockEvent& event,
                   HostTime now);

  /// True if the clock of the stream's node has contradicted the assumptions repeatedly, the last
  /// time within the last minute.
  bool contradicts(std::size_t stream, std::uint32_t node_id, HostTime now) const;

 private:
  struct Clock {
    std::uint32_t node_id = 0;
    // The times of the last three steps.
    std::array<HostTime, 3> steps{HostTime::min(), HostTime::min(), HostTime::min()};
    bool contradicts = false;
    HostTime troubled = HostTime::min();   // the time of the latest event of trouble
    HostTime withdrawn = HostTime::min();  // withdrawals up to this time were printed
  };

  NodeNames names_;
  std::map<std::size_t, Clock> clocks_;  // by stream
};

}  // namespace kinalign
