// SPDX-License-Identifier: Apache-2.0
// Plays a script to a node. Messages have the form of line.h. All numbers are big-endian, floats
// IEEE 754 binary32. To the node:
//
//   C  start: u32 node id, u32 boot id, u8 flags (1 key, 2 clockless, 4 narrow counter), 16 bytes
//      key, u32 frame period us, u32 dither us
//   T  tick: u64 counter us, u32 due, u8 the sensor's answer (a sample's flags; 128: it does not
//      answer), 10 floats: acceleration, angular velocity, orientation
//   D  a datagram arrives
//   P  poll: u64 counter us, u8 flags (1 link, 2 the radio takes datagrams, 4 battery), u16 mV
//   E  end
//
// Every reading of the counter takes 7 us. From the node:
//
//   S  a datagram was sent      X  the radio did not take it      L  lights: link, sync, battery
//   K  end of the answers to a message: after each of T, P and C
//   N  at the end: the node's counts, u64 each, in the order of firmware/node/count_names.h
//   M  after N, on a microcontroller only: the bytes of its stack that were used, u32
#pragma once

#include "firmware/node/clockless_node.h"
#include "firmware/node/node.h"
#include "firmware/script/script_board.h"

#include <variant>

namespace kinalign {

class Script {
 public:
  explicit Script(Line& line) : line_(line), board_(line) {}

  /// Plays until message E or the line's end.
  void play();

 private:
  void start(ByteReader& message);
  void tick(std::uint32_t due);
  void poll(bool link_up);
  void write_counts();

  Line& line_;
  ScriptBoard board_;
  std::array<std::uint8_t, longest_message> message_{};
  std::variant<std::monostate, Node, ClocklessNode> node_;
};

}  // namespace kinalign
