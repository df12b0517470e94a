// SPDX-License-Identifier: Apache-2.0
// Exchanges in, stamps out: each line of the input is a frame, «n_tx_us h_rx_ns», with the echo
// that it carries, «n_rx_us h_tx_ns», if it carries one. Any program can do this with any device
// that has a counter; times as in kinalign/clock/live_clock.h.
#include "kinalign/clock/live_clock.h"

#include <iostream>
#include <sstream>
#include <string>

using namespace kinalign;

int main() {
  LiveClock clock;
  std::string line;
  while (std::getline(std::cin, line)) {
    std::istringstream fields(line);
    std::int64_t n_tx = 0, h_rx = 0, n_rx = 0, h_tx = 0;
    if (!(fields >> n_tx >> h_rx)) continue;
    Exchange frame{1, NodeTime{std::chrono::microseconds(n_tx)}, HostTime{Duration{h_rx}}, {}};
    if (fields >> n_rx >> h_tx) {
      frame.echo = {NodeTime{std::chrono::microseconds(n_rx)}, HostTime{Duration{h_tx}}};
    }
    clock.push(frame);
    const auto stamp = clock.host_from_node(1, frame.n_tx);
    if (!stamp || stamp->certainty != Certainty::certified) continue;
    std::cout << n_tx << " us: sent at " << stamp->time.time_since_epoch().count() << " ns, from "
              << (*stamp->earliest - stamp->time).count() / 1000 << " to +"
              << (*stamp->latest - stamp->time).count() / 1000 << " us\n";
  }
}
