// SPDX-License-Identifier: Apache-2.0
// The lines about the nodes' clocks that people read while the server runs: the cause first, then
// its effect. A clock that never agrees with the assumptions gets a single line. Programs get every
// event (--json).
#pragma once

#include "apps/kinalign/text/node_names.h"

#include "kinalign/clock/clock_event.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinalign {

/// The reason printed for a clock that contradicts the assumptions, after "node 7: " or "not
/// locked: ".
inline constexpr std::string_view contradiction =
    "its clock contradicts the assumptions again and again (drift above 100 ppm, or the node "
    "sleeps)";

class ClockEventLines {
 public:
  explicit ClockEventLines(NodeNames names = {}) : names_(std::move(names)) {}

  /// Takes the events in their order. `now`, of the host's raw clock, is the time of the call.
  void add(std::size_t stream, std::uint32_t node_id, const ClockEvent& event, HostTime now);
  /// The lines to print now. A withdrawal waits for its cause, at most a second.
  std::vector<std::string> lines(HostTime now);
  /// The lines to print at the end, also those that still wait.
  std::vector<std::string> last_lines() { return lines(HostTime::max()); }

  /// True if the clock of the stream's node contradicts the assumptions again and again, and did so
  /// within the last minute.
  bool contradicts(std::size_t stream, std::uint32_t node_id, HostTime now) const;

 private:
  struct Stretch {
    HostTime begin{}, end{};
    HostTime since{};  // the time of the first event about it
  };
  struct Clock {
    std::uint32_t node_id = 0;
    std::array<HostTime, 3> steps{HostTime::min(), HostTime::min(), HostTime::min()};  // latest
    bool contradicts = false;
    HostTime troubled = HostTime::min();      // the latest event of trouble
    std::optional<Stretch> waiting, printed;  // withdrawn stretches, not yet printed and printed
    bool settled = false;                     // the next withdrawn stretch is no longer certified
  };
  Clock& clock_of(std::size_t stream, std::uint32_t node_id);
  void take_step(Clock& clock, const ClockEvent& event);
  static void withdraw(Clock& clock, const ClockEvent& event, HostTime now);
  void print_waiting(Clock& clock);

  NodeNames names_;
  std::map<std::size_t, Clock> clocks_;  // by stream
  std::vector<std::string> lines_;
};

}  // namespace kinalign
