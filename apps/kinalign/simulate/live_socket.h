// SPDX-License-Identifier: Apache-2.0
// A UDP socket of a device in `simulate --live`. It sends to one port and receives only from that
// port.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/handle.h"

#include <cstdint>
#include <span>
#include <string>

namespace kinalign {

/// The number of datagrams of one socket, or of several.
struct LiveTraffic {
  std::uint64_t sent = 0;  // passed to send(), accepted or not
  /// The datagrams that the system refused (no route) or the host refused by ICMP (no program at
  /// the port).
  std::uint64_t refused = 0;
  std::uint64_t received = 0;  // datagrams from the host

  LiveTraffic& operator+=(const LiveTraffic& more);
};

/// Fails if `host` is no numeric IPv4 or IPv6 address. Names are not looked up.
Result<void> check_live_address(const std::string& host);

/// The socket of one device. Each device has one, so that the host sees different senders.
class LiveSocket {
 public:
  /// Opens a socket whose own port the system chooses. `host`: a numeric IPv4 or IPv6 address.
  /// Fails if `host` is no such address, or if this machine has no route to it.
  static Result<LiveSocket> connected_to(const std::string& host, std::uint16_t port);

  /// Returns false if the system refuses the datagram. A port at which no program listens shows
  /// only later: see traffic().
  bool send(std::span<const std::uint8_t> datagram);
  /// Receives the next datagram, cut to the size of `room`. Returns 0 if none has arrived.
  std::size_t receive(std::span<std::uint8_t> room);
  /// The number of datagrams so far.
  const LiveTraffic& traffic();
  int fd() const { return socket_.fd(); }

 private:
  explicit LiveSocket(int fd) : socket_(fd) {}
  // The kernel stores at most one refusal for each socket, so several refusals may count as one.
  void read_refusal();

  Handle socket_;
  LiveTraffic traffic_;
};

}  // namespace kinalign
