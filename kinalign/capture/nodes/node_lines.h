// SPDX-License-Identifier: Apache-2.0
// One socket per known node, connected to the node's address. The kernel then buffers the node's
// datagrams separately. Other senders can fill that buffer only by forging the node's address and
// port.
//
// Link-local addresses get no socket. Before a socket is connected, it receives a share of all
// datagrams of the port (SO_REUSEPORT). These datagrams stay in its buffer and are read later, so
// the reader must use each datagram's address. The class also owns the descriptor on which a
// receiver waits.
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
  /// `open`: the sockets for all senders. They must not move in memory. From now on they share
  /// their port.
  NodeLines(std::span<const UdpSocket> open, std::size_t most);

  /// The source and destination of a node's datagrams: from `way.from` to `way.to`, an address of
  /// this host. If the system gives no socket, the open sockets receive the node's datagrams, and
  /// the next attempt follows after a second. A node whose address changes often gets at most one
  /// new socket per second.
  struct Way {
    NodeAddress from;
    HostAddress to{};
    bool operator==(const Way&) const = default;
  };
  void follow(std::size_t stream, const Way& way, std::uint16_t port, HostTime now);

  /// Descriptor that becomes readable when any of the sockets is readable.
  int fd() const { return poll_.fd(); }
  /// The readable sockets, those of nodes first.
  std::span<const UdpSocket* const> ready();
  /// Number of datagrams that the kernel dropped on all sockets, including closed sockets.
  std::uint64_t dropped() const;

 private:
  /// The socket of one stream. Streams are numbered as in the receiver.
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
