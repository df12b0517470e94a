// SPDX-License-Identifier: Apache-2.0
// UDP to one server, IPv4 or IPv6. Nothing waits.
#pragma once

#include "firmware/host_node/trouble.h"

#include <cstdint>
#include <span>

namespace kinalign {

class UdpSocket {
 public:
  /// From a port that the system chooses.
  static Tried<UdpSocket> connected_to(const std::string& host, const std::string& port);

  UdpSocket(UdpSocket&& other) noexcept;
  UdpSocket& operator=(UdpSocket&& other) noexcept;
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;
  ~UdpSocket();

  /// False: nothing was sent.
  bool send(std::span<const std::uint8_t> datagram);
  /// The next datagram of the server's, cut to `room`. False: there is none.
  bool receive(std::span<std::uint8_t> room, std::size_t& size);
  int descriptor() const { return descriptor_; }

 private:
  explicit UdpSocket(int descriptor) : descriptor_(descriptor) {}

  int descriptor_;
};

}  // namespace kinalign
