// SPDX-License-Identifier: Apache-2.0
// A node that sends frames over a link and echoes the host's replies, in virtual time: the readings
// of both clocks, and the truth. Times are in seconds on the host's axis unless stated.
#pragma once

#include "kinalign/simulate/nodes/link.h"
#include "kinalign/simulate/nodes/node_clock.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace kinalign {

/// A step of the node's counter: time and size.
struct CounterStep {
  double at = 0.0, by = 0.0;  // s
};

struct Reboot {
  double at = 0.0;
  double gap = 0.0;      // s without power
  bool same_id = false;  // the firmware draws no new boot id
};

/// A period in which the counter runs at another rate, such as light sleep.
struct RateStretch {
  double begin = 0.0, end = 0.0;
  double rate = 0.0;  // 500e-6: 500 ppm fast
};

/// The conditions of one run. Faults are explicit, so a test can state when each of them happens.
struct ExchangeOptions {
  double length_s = 60.0;
  double rate_hz = 15.0;
  LinkOptions link{};
  NodeClockOptions clock{};
  std::vector<CounterStep> steps{};  // steps, reboots and stretches are in rising order
  std::vector<Reboot> reboots{};
  std::vector<RateStretch> stretches{};
};

/// A frame and everything that follows from it. An absent time: the packet was lost.
struct SimulatedFrame {
  double sent = 0.0;
  std::uint32_t boot_id = 0, sequence = 0;
  std::int64_t n_tx_us = 0;  // the counter, just before sending
  double truth = 0.0;        // the time at which the counter stood half a microsecond after n_tx_us
  std::optional<double> arrival,
      second_arrival;    // arrivals at the host; second_arrival: of a duplicate
  double replied = 0.0;  // if the frame was heard: time at which the host sent its reply
  std::optional<double> reply_arrival;  // arrival of the reply at the node
  std::int64_t n_rx_us = 0;         // if the reply was heard: the counter just after its arrival
  std::optional<std::size_t> echo;  // the frame whose reply this one echoes: the newest one
  /// T6 of the paper's exchange: the node answers the reply within a millisecond.
  std::optional<double> confirmed;
};

struct SimulatedExchanges {
  ExchangeOptions options;
  Floors floors;
  std::vector<SimulatedFrame> frames;  // in the order of sending
};

/// The same seed and options give the same run.
SimulatedExchanges simulate_exchanges(const ExchangeOptions& options, std::uint64_t seed);

/// An arrival at the host. in_order_of_arrival() lists them in that order.
struct ArrivedFrame {
  double at = 0.0;
  std::size_t frame = 0;
  bool again = false;
};
std::vector<ArrivedFrame> in_order_of_arrival(const SimulatedExchanges& exchanges);

}  // namespace kinalign
