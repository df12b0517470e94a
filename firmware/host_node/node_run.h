// SPDX-License-Identifier: Apache-2.0
// One run of a node on the host: its ticks, arrivals and events, until its time is over.
#pragma once

#include "firmware/host_node/answer_watch.h"
#include "firmware/host_node/posix_board.h"
#include "firmware/node/clockless_node.h"
#include "firmware/node/node.h"

#include <functional>
#include <string>
#include <variant>

namespace kinalign {

/// Counts summed over all reboots. Counts of the other kind of node stay 0.
struct RunCounts {
  NodeTally node;
  ClocklessCounts clockless;
  std::uint64_t reboots = 0;
};

class NodeRun {
 public:
  NodeRun(const HostNodeOptions& options, NodeSocket socket);

  /// Runs until options.seconds are over or the descriptor `stop` can be read. `print_line` gets
  /// lines for the user, for example that no host answers.
  using PrintLine = std::function<void(const std::string&)>;
  Tried<void> live(int stop, const PrintLine& print_line);
  RunCounts counts();
  const std::vector<ClockTruth>& truths() const { return clock_.truths(); }
  const Lights& lights() const { return board_.lights(); }

 private:
  void boot(std::uint32_t boot_id);
  Tried<void> befall(const Event& event);
  void tick_and_poll();
  void watch(std::int64_t age_ns, const PrintLine& print_line);
  std::int64_t idle_ns();
  std::uint32_t ticks_due();

  HostNodeOptions options_;
  NodeSocket socket_;
  PretendedClock clock_;
  PosixBoard board_;
  std::variant<std::monostate, Node, ClocklessNode> node_;
  RunCounts past_;  // counts of the starts before this one
  std::int64_t begin_ns_;
  AnswerWatch watch_;
  std::int64_t next_watch_ns_ = 0;
  std::size_t next_event_ = 0;
  bool link_up_ = true;
  double tick_period_us_;
  double next_tick_us_ = 0;
};

}  // namespace kinalign
