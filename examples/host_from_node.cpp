// SPDX-License-Identifier: Apache-2.0
// Reads exchanges and prints stamps. Each line of the input is a frame, «n_tx_us h_rx_ns», followed
// by the echo that it carries, «n_rx_us h_tx_ns», if it carries one. Any program can do this with
// any device that has a counter; the times are those of kinalign/clock/live/live_clock.h. Here the
// counter's µs become ns.
#include "kinalign/clock/live/live_clock.h"

#include <iostream>
#include <iterator>
#include <sstream>
#include <string>

using namespace kinalign;

int main() {
  const auto node = [](std::int64_t us) { return NodeTime{std::chrono::microseconds(us)}; };
  LiveClock clock;
  std::string line;
  for (int number = 1; std::getline(std::cin, line); ++number) {
    std::istringstream text(line);
    const std::vector<std::int64_t> t{std::istream_iterator<std::int64_t>(text), {}};
    if (!text.eof() || (t.size() != 2 && t.size() != 4)) {
      std::cerr << "line " << number << ": expected two or four whole numbers, found " << line
                << "\n";
      return 3;
    }
    Exchange frame{1, node(t[0]), HostTime{Duration{t[1]}}, {}};
    if (t.size() == 4) frame.echo = {node(t[2]), HostTime{Duration{t[3]}}};
    clock.push(frame);
    const auto stamp = clock.host_from_node(1, frame.n_tx);
    if (!stamp || stamp->certainty != Certainty::certified) continue;
    std::cout << t[0] << " us: sent at " << stamp->time.time_since_epoch().count() << " ns, from "
              << (*stamp->earliest - stamp->time).count() / 1000 << " to +"
              << (*stamp->latest - stamp->time).count() / 1000 << " us\n";
  }
}
