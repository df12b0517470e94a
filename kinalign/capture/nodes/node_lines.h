// SPDX-License-Identifier: Apache-2.0
// One socket per known node, connected to the node's address, so that the kernel puts the node's
// datagrams into a buffer of their own. Strangers can fill that buffer only by forging the node's
// address and port. Link-local addresses get no socket. Before such a socket is connected, it
// receives a share of all datagrams of the port (SO_REUSEPORT). These stay in its buffer and are
// read like all others, so the reader must go by each datagram's address. The class also owns the
// descriptor on which a receiver waits.
#pragma once

#include "kinalign/capture/net/udp_socket.h"
#include "kinalign/capture/nodes/node_session.h"
#include "kinalign/core/handle.h"

#include <optional>
#include <span>
#include <vector>

namespace kinalign {

class NodeLines {
 public:
  /// `open`: the sockets for all senders. They must not move, and they share their port from now
  /// on.
  NodeLines(std::span<const UdpSocket> open, std::size_t most);

  /// The path of a node's datagrams: from `way.from` to `way.to`, an address of this host. If the
  /// system gives no socket, the open sockets receive the node's datagrams, and a socket is asked
  /// for again after a second. A node whose addresses alternate gets a new socket once a second at
  /// most.
  struct Way {
    NodeAddress from;
    HostAddress to{};
    bool operator==(const Way&) const = default;
  };
  void follow(std::size_t stream, const Way& way, std::uint16_t port, HostTime now);

  /// Readable when any of the sockets is readable.
  int fd() const { return poll_.fd(); }
  /// The sockets that can be read, those of nodes first.
  std::span<const UdpSocket* const> ready();
  /// Datagrams that the kernel dropped on all sockets, closed ones included.
  std::uint64_t dropped() const;

 private:
  /// One for each stream of the receiver, by its number.
  struct Line {
    Way way;
    std::optional<UdpSocket> socket;
    HostTime asked = HostTime::min();  // time of the last attempt to open the socket
  };
  void wait_for(const UdpSocket& socket, std::uint64_t number);

  std::span<const UdpSocket> open_;
  std::vector<Line> lines_;
  Handle poll_;
  std::vector<const UdpSocket*> ready_;
  std::uint64_t dropped_before_ = 0;  // datagrams dropped on sockets that are now closed
};

}  // namespace kinalign
