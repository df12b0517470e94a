// SPDX-License-Identifier: Apache-2.0
// A device's UDP socket for `simulate --live`: sends to one port and receives from that port only.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/handle.h"

#include <cstdint>
#include <span>
#include <string>

namespace kinalign {

/// The datagrams of one socket, or of several.
struct LiveTraffic {
  std::uint64_t sent = 0;  // given to send(), accepted or not
  /// The datagrams that the system or, by ICMP, the host refused: no route, or no program there.
  std::uint64_t refused = 0;
  std::uint64_t received = 0;  // received from the host

  LiveTraffic& operator+=(const LiveTraffic& more);
};

/// Fails if `host` is not a numeric address of IPv4 or IPv6; names are not looked up.
Result<void> check_live_address(const std::string& host);

/// Each device has a socket of its own, so the host sees each as a sender with its own port.
class LiveSocket {
 public:
  /// A socket on a port that the system chooses. `host`: a numeric address, IPv4 or IPv6. Fails if
  /// it is none, or if this machine has no route to it.
  static Result<LiveSocket> connected_to(const std::string& host, std::uint16_t port);

  /// False if the system did not accept the datagram. A port without a listener is known only after
  /// sending: see traffic().
  bool send(std::span<const std::uint8_t> datagram);
  /// The next datagram, cut to `room`; 0 bytes if there is none.
  std::size_t receive(std::span<std::uint8_t> room);
  /// The counts up to now.
  const LiveTraffic& traffic();
  int fd() const { return socket_.fd(); }

 private:
  explicit LiveSocket(int fd) : socket_(fd) {}
  // The kernel keeps at most one refusal for each socket, so several of them may count as one.
  void read_refusal();

  Handle socket_;
  LiveTraffic traffic_;
};

}  // namespace kinalign
