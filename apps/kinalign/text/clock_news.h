// SPDX-License-Identifier: Apache-2.0
// What people are told of the nodes' clocks while the server runs: the cause first, what it costs
// behind it, and of a clock that never agrees with the assumptions one line. Programs get every
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

/// Of such a clock, behind "node 7: " or "not locked: ".
inline constexpr std::string_view contradiction =
    "its clock keeps contradicting the assumptions (more than 100 ppm off, or asleep)";

class ClockNews {
 public:
  explicit ClockNews(NodeNames names = {}) : names_(std::move(names)) {}

  /// In the order of the events; `now`, of the host's raw clock, is when they are told.
  void hear(std::size_t stream, std::uint32_t node_id, const ClockEvent& event, HostTime now);
  /// Lines to be told now. A withdrawal waits for its cause, but not longer than a second.
  std::vector<std::string> lines(HostTime now);
  /// At the end: those that still wait, too.
  std::vector<std::string> last_lines() { return lines(HostTime::max()); }

  /// Its node's clock contradicts the assumptions again and again, and did so within the last
  /// minute.
  bool contradicts(std::size_t stream, std::uint32_t node_id, HostTime now) const;

 private:
  struct Stretch {
    HostTime begin{}, end{};
    HostTime since{};  // when it was heard of
  };
  struct Clock {
    std::uint32_t node_id = 0;
    std::array<HostTime, 3> steps{HostTime::min(), HostTime::min(), HostTime::min()};  // the last
    bool contradicts = false;
    HostTime troubled = HostTime::min();   // last
    std::optional<Stretch> waiting, told;  // withdrawn
    bool settled = false;                  // what is withdrawn next was not certified any more
  };
  Clock& clock_of(std::size_t stream, std::uint32_t node_id);
  void take_step(Clock& clock, const ClockEvent& event);
  static void withdraw(Clock& clock, const ClockEvent& event, HostTime now);
  void tell_waiting(Clock& clock);

  NodeNames names_;
  std::map<std::size_t, Clock> clocks_;  // by stream
  std::vector<std::string> lines_;
};

}  // namespace kinalign
