// SPDX-License-Identifier: Apache-2.0
// A node that sends frames over a simulated link and echoes the host's replies, in simulated time.
// The result contains the readings of both clocks and the truth. Times are seconds on the host's
// time axis unless stated otherwise.
#pragma once

#include "kinalign/simulate/nodes/link.h"
#include "kinalign/simulate/nodes/node_clock.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace kinalign {

/// A step of the node's counter: its time and its size.
struct CounterStep {
  double at = 0.0, by = 0.0;  // s
};

struct Reboot {
  double at = 0.0;
  double gap = 0.0;      // time without power, s
  bool same_id = false;  // the firmware does not draw a new boot id
};

/// A period in which the counter runs at another rate, as in light sleep.
struct RateStretch {
  double begin = 0.0, end = 0.0;
  double rate = 0.0;  // 500e-6: 500 ppm fast
};

/// The conditions of one run. All faults are given explicitly, so a test knows when each fault
/// happens.
struct ExchangeOptions {
  double length_s = 60.0;
  double rate_hz = 15.0;
  LinkOptions link{};
  NodeClockOptions clock{};
  std::vector<CounterStep> steps{};  // steps, reboots and stretches must be in rising order
  std::vector<Reboot> reboots{};
  std::vector<RateStretch> stretches{};
};

/// A frame, its reply and the truth. If a time is absent, the packet was lost.
struct SimulatedFrame {
  double sent = 0.0;
  std::uint32_t boot_id = 0, sequence = 0;
  std::int64_t n_tx_us = 0;  // the counter just before sending
  double truth = 0.0;        // the time at which the counter was n_tx_us + 0.5 us
  std::optional<double> arrival,
      second_arrival;    // of a duplicate
  double replied = 0.0;  // time at which the host sent its reply, if the frame arrived
  std::optional<double> reply_arrival;  // arrival of the reply at the node
  std::int64_t n_rx_us = 0;             // the counter just after the arrival of the reply
  std::optional<std::size_t> echo;      // the frame whose reply this frame echoes: the newest reply
  /// Arrival at the host of the node's answer to the reply (T6 of the exchange in the HFUT-MMD
  /// paper). The node answers within a millisecond.
  std::optional<double> confirmed;
};

struct SimulatedExchanges {
  ExchangeOptions options;
  Floors floors;
  std::vector<SimulatedFrame> frames;  // in the order of sending
};

/// The same seed and options give the same run.
SimulatedExchanges simulate_exchanges(const ExchangeOptions& options, std::uint64_t seed);

/// An arrival at the host.
struct ArrivedFrame {
  double at = 0.0;
  std::size_t frame = 0;
  bool again = false;
};
/// Returns all arrivals, including duplicates, in the order of their times.
std::vector<ArrivedFrame> in_order_of_arrival(const SimulatedExchanges& exchanges);

}  // namespace kinalign
