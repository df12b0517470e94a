// SPDX-License-Identifier: Apache-2.0
// A board in virtual time. Every reading of its counter takes 1 us. It keeps the datagrams that are
// sent, takes arriving ones from `arriving`, and writes down the order of its calls.
#pragma once

#include "firmware/node/board.h"

#include "kinalign/wire/node_datagram.h"
#include "kinalign/wire/node_frame.h"
#include "kinalign/wire/node_reply.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <deque>
#include <string>
#include <vector>

namespace kinalign {

using Bytes = std::vector<std::uint8_t>;

class FakeBoard : public Board {
 public:
  std::uint64_t counter_us() override {
    calls += 'c';
    return ++now_us;
  }
  bool read_imu(NodeSample& sample) override {
    calls += 'i';
    now_us += imu_takes_us;
    sample = reading;
    return imu_answers;
  }
  bool send(std::span<const std::uint8_t> datagram) override {
    calls += 's';
    if (!radio_takes) return false;
    sent.emplace_back(datagram.begin(), datagram.end());
    return true;
  }
  bool receive(std::span<std::uint8_t> room, std::size_t& size) override {
    calls += 'r';
    if (arriving.empty()) return false;
    size = std::min(room.size(), arriving.front().size());
    std::copy_n(arriving.front().begin(), size, room.begin());
    arriving.pop_front();
    return true;
  }
  bool read_battery(std::uint16_t& mv) override {
    calls += 'b';
    mv = battery_mv;
    return battery_mv != 0;
  }
  void show(const Lights& lights) override { shown.push_back(lights); }
  void lock() override { CHECK(++locks == 1); }
  void unlock() override { CHECK(--locks == 0); }

  std::uint64_t now_us = 1'000'000;
  std::uint64_t imu_takes_us = 400;
  bool imu_answers = true, radio_takes = true;
  std::uint16_t battery_mv = 0;
  NodeSample reading;
  std::string calls;  // c counter, i IMU, s send, r receive, b battery
  std::vector<Bytes> sent;
  std::deque<Bytes> arriving;
  std::vector<Lights> shown;
  int locks = 0;
};

inline constexpr MacKey node_key{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

template <class Datagram>
Datagram decoded(const Bytes& bytes, const MacKey* key = nullptr) {
  Envelope envelope;
  Datagram datagram;
  REQUIRE(open_envelope(bytes, envelope) == NodeRefusal::none);
  REQUIRE(decode(envelope, key, datagram) == NodeRefusal::none);
  return datagram;
}

template <class Datagram>
Bytes encoded(const Datagram& datagram, const MacKey* key = nullptr) {
  Bytes bytes(max_node_datagram);
  bytes.resize(encode(datagram, key, bytes).size());
  REQUIRE(!bytes.empty());
  return bytes;
}

/// The host's reply to a frame.
inline Bytes reply_to(const NodeFrame& frame, std::uint32_t reply_sequence,
                      const MacKey* key = nullptr, bool locked = false) {
  return encoded(NodeReply{frame.origin, locked, reply_sequence, 0xbeef0000 + reply_sequence, 5},
                 key);
}

}  // namespace kinalign
