// SPDX-License-Identifier: Apache-2.0
// A socket of its own for each node that is known, connected to its address: the kernel puts the
// node's datagrams into that one's buffer, which no stranger fills but who forges that address and
// port. Link-local addresses have none. Before it is connected it takes a share of everybody's
// (SO_REUSEPORT): these wait in it and are read like all others, so who reads one goes by each
// datagram's address. Besides, the descriptor that a receiver waits for.
#pragma once

#include "kinalign/capture/net/udp_socket.h"
#include "kinalign/capture/nodes/node_life.h"

#include <optional>
#include <span>
#include <vector>

namespace kinalign {

class NodeLines {
 public:
  /// `open`: for everybody; they have to stay where they are, and share their port from now on.
  NodeLines(std::span<const UdpSocket> open, std::size_t most);
  NodeLines(NodeLines&& other) noexcept;
  NodeLines& operator=(NodeLines&&) = delete;
  NodeLines(const NodeLines&) = delete;
  NodeLines& operator=(const NodeLines&) = delete;
  ~NodeLines();

  /// The node sends from `way.from` to `way.to`, an address of ours. Where the system gives no
  /// socket all goes on over the open ones, and a second later it is asked again; no sooner does a
  /// line follow one that sends from, or to, several addresses in turn.
  struct Way {
    NodeAddress from;
    HostAddress to{};
    bool operator==(const Way&) const = default;
  };
  void follow(std::size_t stream, const Way& way, std::uint16_t port, HostTime now);

  /// Can be read where any socket can.
  int fd() const { return poll_; }
  /// Those that can be read, lines of nodes first.
  std::span<const UdpSocket* const> ready();
  std::uint64_t dropped() const;

 private:
  struct Line {
    Way way;
    std::optional<UdpSocket> socket;
    HostTime asked = HostTime::min();  // for the socket
  };
  void wait_for(const UdpSocket& socket, std::uint64_t number);

  std::span<const UdpSocket> open_;
  std::vector<Line> lines_;
  int poll_ = -1;
  std::vector<const UdpSocket*> ready_;
  std::uint64_t dropped_before_ = 0;  // by lines that are closed
};

}  // namespace kinalign
