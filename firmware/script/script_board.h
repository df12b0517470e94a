// SPDX-License-Identifier: Apache-2.0
// A board that consists of a line of bytes: clock, sensor and radio come over it, and the node's
// actions go back. It is the same on a microcontroller's serial port and in host_node, so one
// script shows whether both nodes behave alike (script.h lists the messages).
#pragma once

#include "firmware/node/board.h"
#include "firmware/script/line.h"

#include "kinalign/wire/bytes.h"

#include <array>

namespace kinalign {

class ScriptBoard : public Board {
 public:
  explicit ScriptBoard(Line& line) : line_(line) {}

  /// Sets clock and sensor for a tick; gives the number of ticks that are due.
  std::uint32_t begin_tick(ByteReader& message);
  /// Sets clock, radio and battery for a poll; gives whether there is a link.
  bool begin_poll(ByteReader& message);
  /// Adds a datagram for the next poll. Datagrams beyond eight are lost, and each is cut at 80
  /// bytes.
  void arrive(std::span<const std::uint8_t> datagram);

  std::uint64_t counter_us() override;
  bool read_imu(NodeSample& sample) override;
  bool send(std::span<const std::uint8_t> datagram) override;
  bool receive(std::span<std::uint8_t> room, std::size_t& size) override;
  bool read_battery(std::uint16_t& mv) override;
  void show(const Lights& lights) override;
  void lock() override {}
  void unlock() override {}

 private:
  struct Arrival {
    std::array<std::uint8_t, 80> bytes{};
    std::size_t size = 0;
  };

  Line& line_;
  std::uint64_t now_us_ = 0;
  NodeSample reading_;
  bool sensor_answers_ = false;
  bool radio_takes_ = false;
  bool has_battery_ = false;
  std::uint16_t battery_mv_ = 0;
  std::array<Arrival, 8> arrivals_{};
  std::size_t arrived_ = 0, received_ = 0;
};

}  // namespace kinalign
