// SPDX-License-Identifier: Apache-2.0
// A device's UDP socket, as `simulate --live` has one for each: sends to one port, hears it alone.
#pragma once

#include "kinalign/core/error.h"

#include <cstdint>
#include <span>
#include <string>

namespace kinalign {

/// Datagrams of one socket or of several.
struct LiveTraffic {
  std::uint64_t sent = 0;  // by the program, taken or not
  std::uint64_t refused =
      0;                    // of these: nobody listens there, as far as he is told, or no way there
  std::uint64_t heard = 0;  // from there

  LiveTraffic& operator+=(const LiveTraffic& more);
};

/// Fails where `host` is no address of IPv4 or IPv6: a name is none.
Result<void> check_live_address(const std::string& host);

class LiveSocket {
 public:
  /// From a port that the system chooses. `host`: an address, IPv4 or IPv6. Fails where it is none,
  /// and where this machine knows no way to it.
  static Result<LiveSocket> connected_to(const std::string& host, std::uint16_t port);

  LiveSocket(LiveSocket&& other) noexcept;
  LiveSocket& operator=(LiveSocket&& other) noexcept;
  LiveSocket(const LiveSocket&) = delete;
  LiveSocket& operator=(const LiveSocket&) = delete;
  ~LiveSocket();

  /// False where the system did not take it. That nobody listens is told after it was sent:
  /// traffic() has it.
  bool send(std::span<const std::uint8_t> datagram);
  /// The next datagram, cut to `room`; nothing (0 bytes) where there is none.
  std::size_t receive(std::span<std::uint8_t> room);
  /// Up to now.
  const LiveTraffic& traffic();
  int fd() const { return fd_; }

 private:
  explicit LiveSocket(int fd) : fd_(fd) {}
  void hear_refusal();

  int fd_ = -1;
  LiveTraffic traffic_;
};

}  // namespace kinalign
