// SPDX-License-Identifier: Apache-2.0
// The board of a node that is a program: a simulated counter and sensor, a real socket.
#pragma once

#include "firmware/host_node/node_socket.h"
#include "firmware/host_node/options.h"
#include "firmware/host_node/pretended_clock.h"
#include "firmware/node/board.h"

namespace kinalign {

/// CLOCK_MONOTONIC_RAW in ns, which is the axis of the recorder's times too.
std::int64_t raw_ns();

class PosixBoard : public Board {
 public:
  PosixBoard(const HostNodeOptions& options, PretendedClock& clock, NodeSocket& socket)
      : options_(options), clock_(clock), socket_(socket) {}

  std::uint64_t counter_us() override { return asked_us_ = clock_.counter_us(raw_ns()); }
  /// The swing (formula.h) at the counter's last reading; the sampler has just read the counter.
  bool read_imu(NodeSample& sample) override;
  bool send(std::span<const std::uint8_t> datagram) override { return socket_.send(datagram); }
  bool receive(std::span<std::uint8_t> room, std::size_t& size) override {
    return socket_.receive(room, size);
  }
  bool read_battery(std::uint16_t& mv) override;
  void show(const Lights& lights) override { lights_ = lights; }
  void lock() override {}  // there is only one task
  void unlock() override {}

  const Lights& lights() const { return lights_; }

 private:
  const HostNodeOptions& options_;
  PretendedClock& clock_;
  NodeSocket& socket_;
  std::uint64_t asked_us_ = 0;
  int readings_ = 0;
  Lights lights_;
};

}  // namespace kinalign
