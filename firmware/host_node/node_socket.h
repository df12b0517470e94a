// SPDX-License-Identifier: Apache-2.0
// A UDP socket to one server, IPv4 or IPv6. No call waits.
#pragma once

#include "firmware/host_node/trouble.h"

#include <cstdint>
#include <span>

namespace kinalign {

class NodeSocket {
 public:
  /// The socket sends from a port that the system chooses.
  static Tried<NodeSocket> connected_to(const std::string& host, const std::string& port);

  NodeSocket(NodeSocket&& other) noexcept;
  NodeSocket& operator=(NodeSocket&& other) noexcept;
  NodeSocket(const NodeSocket&) = delete;
  NodeSocket& operator=(const NodeSocket&) = delete;
  ~NodeSocket();

  /// False: nothing was sent.
  bool send(std::span<const std::uint8_t> datagram);
  /// Takes the next datagram from the server, cut to the size of `room`. False: there is none.
  bool receive(std::span<std::uint8_t> room, std::size_t& size);
  int descriptor() const { return descriptor_; }

 private:
  explicit NodeSocket(int descriptor) : descriptor_(descriptor) {}

  int descriptor_;
};

}  // namespace kinalign
