// SPDX-License-Identifier: Apache-2.0
// A node that sends frames over a link and echoes the host's replies, in virtual time: what each
// side reads from its clock, and the truth. Seconds on the host's axis unless said.
#pragma once

#include "kinalign/simulate/nodes/link.h"
#include "kinalign/simulate/nodes/node_clock.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace kinalign {

struct CounterStep {
  double at = 0.0, by = 0.0;  // s
};

struct Reboot {
  double at = 0.0;
  double gap = 0.0;      // s without power
  bool same_id = false;  // the firmware did not draw a new boot id
};

/// Light sleep and the like: the counter runs at another rate for a while.
struct RateStretch {
  double begin = 0.0, end = 0.0;
  double rate = 0.0;  // 500e-6: 500 ppm fast
};

struct ExchangeOptions {
  double length_s = 60.0;
  double rate_hz = 15.0;
  LinkOptions link{};
  NodeClockOptions clock{};
  std::vector<CounterStep> steps{};  // each in rising order
  std::vector<Reboot> reboots{};
  std::vector<RateStretch> stretches{};
};

/// A frame with all that follows from it. Absent stamps: lost on the way.
struct SimulatedFrame {
  double sent = 0.0;
  std::uint32_t boot_id = 0, sequence = 0;
  std::int64_t n_tx_us = 0;  // the counter, just before sending
  double truth = 0.0;        // when the counter stood half a microsecond behind n_tx_us
  std::optional<double> heard, heard_again;  // by the host; again: a duplicate
  double replied = 0.0;                      // where it was heard: when the host sent its reply
  std::optional<double> reply_heard;         // by the node
  std::int64_t n_rx_us = 0;                  // where the reply was heard: the counter just after
  std::optional<std::size_t> echo;           // the frame whose reply this one echoes: the newest
  std::optional<double> confirmed;  // T6 of the paper's exchange, where the node answers the
                                    // reply within a millisecond
};

struct SimulatedExchanges {
  ExchangeOptions options;
  Floors floors;
  std::vector<SimulatedFrame> frames;  // in the order in which they were sent
};

SimulatedExchanges simulate_exchanges(const ExchangeOptions& options, std::uint64_t seed);

/// What reached the host, in the order in which it did.
struct Heard {
  double at = 0.0;
  std::size_t frame = 0;
  bool again = false;
};
std::vector<Heard> in_order_of_arrival(const SimulatedExchanges& exchanges);

}  // namespace kinalign
