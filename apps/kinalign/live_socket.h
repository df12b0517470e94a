// SPDX-License-Identifier: Apache-2.0
// A device's UDP socket, as `simulate --live` has one for each: sends to one port, hears it alone.
#pragma once

#include "kinalign/core/error.h"

#include <cstdint>
#include <span>
#include <string>

namespace kinalign {

class LiveSocket {
 public:
  /// From a port that the system chooses. `host`: an address, IPv4 or IPv6.
  static Result<LiveSocket> connected_to(const std::string& host, std::uint16_t port);

  LiveSocket(LiveSocket&& other) noexcept;
  LiveSocket& operator=(LiveSocket&& other) noexcept;
  LiveSocket(const LiveSocket&) = delete;
  LiveSocket& operator=(const LiveSocket&) = delete;
  ~LiveSocket();

  /// False where the system did not take it, as where nobody listens on this machine.
  bool send(std::span<const std::uint8_t> datagram) const;
  /// The next datagram, cut to `room`; nothing (0 bytes) where there is none.
  std::size_t receive(std::span<std::uint8_t> room) const;
  int fd() const { return fd_; }

 private:
  explicit LiveSocket(int fd) : fd_(fd) {}

  int fd_ = -1;
};

}  // namespace kinalign
