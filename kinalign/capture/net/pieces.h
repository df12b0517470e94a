// SPDX-License-Identifier: Apache-2.0
// UDP and TCP ports for any device protocol. Received bytes are passed on unchanged, with their
// arrival on the host's time axis and the number of their sender. No call blocks. Each call reads a
// limited amount from one port, so a flood on one port does not delay the others for long.
#pragma once

#include "kinalign/capture/net/datagram_batch.h"
#include "kinalign/capture/net/host_clock.h"
#include "kinalign/capture/net/udp_socket.h"
#include "kinalign/core/handle.h"
#include "kinalign/recording/counts.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// One datagram, or the bytes of one read from a connection.
struct Piece {
  // Number of the sender in the port's Senders.
  std::size_t sender = 0;
  std::string_view bytes;  // valid only during the call
  HostTime arrival{};
};
using TakePiece = std::function<void(const Piece& piece)>;

/// The senders of one port, by number. At most `most` senders are known at once. The number of a
/// silent sender is reused for a new sender. A number is reused sooner if its sender sent few
/// messages or has the host address of the new sender. Unrelated programs and reconnections of a
/// device therefore don't use up the numbers.
class Senders {
 public:
  static constexpr std::size_t most = 64;
  static constexpr std::uint64_t little = 10;  // messages; fewer may be an unrelated program
  // Each serial number occupies a channel of the recording.
  static constexpr std::uint64_t most_serials = 1000;

  struct Sender {
    HostAddress host{};
    std::uint16_t port = 0;
    // Arrival of the newest message.
    HostTime last_arrival{};
    // number of this sender among all senders that the port has had
    std::uint64_t serial = 0;
    std::uint64_t times = 0;  // number of received messages
    Datagram asked{};         // the newest datagram without its bytes, needed for answers; UDP only
  };
  /// Returns the sender's number; a new sender gets one. Absent if all numbers belong to active
  /// senders. After most_serials senders, a new sender takes over the serial number of a sender of
  /// the same host, the one silent longest. New senders of other hosts then share the serial number
  /// most_serials + 1.
  std::optional<std::size_t> number(const HostAddress& host, std::uint16_t port, HostTime now);
  /// Does the same for a TCP connection. A new connection is a new sender, even from the same port.
  /// `known` is the connection's number and serial number. It is set when the first bytes arrive.
  struct Known {
    std::size_t number = 0;
    std::uint64_t serial = 0;
  };
  std::optional<std::size_t> number(std::optional<Known>& known, const HostAddress& host,
                                    std::uint16_t port, HostTime now);
  const Sender& at(std::size_t number) const { return senders_[number]; }
  /// Returns the sender's number. Absent if the sender is not known.
  std::optional<std::size_t> find(const HostAddress& host, std::uint16_t port) const;
  /// Keeps the newest datagram of the sender, whose addresses an answer needs.
  void remember(std::size_t number, const Datagram& asked);
  std::size_t size() const { return senders_.size(); }

 private:
  void note_arrival(std::size_t number, HostTime now);
  /// Gives a new sender a number. `place_for` chooses the number; `own_past` finds an earlier
  /// sender of the same host.
  std::optional<std::size_t> add(const HostAddress& host, std::uint16_t port, HostTime now);
  std::optional<std::size_t> place_for(const HostAddress& host, HostTime now);
  std::optional<std::size_t> own_past(const HostAddress& host) const;

  std::vector<Sender> senders_;
  std::uint64_t serials_ = 0;
};

/// A UDP port.
class UdpPieces {
 public:
  /// Opens the port. If `address` is empty, it listens on all addresses.
  static Result<UdpPieces> open(const std::string& address, std::uint16_t port);

  void add_fds(std::vector<int>& fds) const;
  /// Passes the waiting datagrams to `take`.
  void drain(HostAxis& axis, const TakePiece& take);
  /// Sends `bytes` immediately, from the address to which the sender sent its newest datagram.
  void send(std::size_t sender, std::span<const std::uint8_t> bytes);
  /// Sends `bytes` to the sender with this address. Does nothing if no sender has the address.
  void send_to(const HostAddress& host, std::uint16_t port, std::span<const std::uint8_t> bytes);
  std::uint16_t port() const { return sockets_.front().port(); }
  const Senders& senders() const { return senders_; }
  PortCounts counts() const;
  /// Number of received datagrams, including refused ones. Needs no system call.
  std::uint64_t received() const { return counts_.pieces + counts_.refused; }

 private:
  explicit UdpPieces(std::vector<UdpSocket> sockets);
  void take_datagram(const Datagram& datagram, const HostAxis& axis, const TakePiece& take);

  std::vector<UdpSocket> sockets_;
  std::unique_ptr<DatagramBatch> batch_;
  Senders senders_;
  PortCounts counts_;
};

/// A TCP port. It either connects to a device that is the server, or accepts connections from
/// devices. A failed connection is attempted again.
class TcpPieces {
 public:
  /// Connects to the device at `address` in the background. The device may be switched on later.
  static Result<TcpPieces> connect(const std::string& address, std::uint16_t port);
  static Result<TcpPieces> listen(const std::string& address, std::uint16_t port);

  void add_fds(std::vector<int>& fds) const;
  /// Passes the bytes that have arrived to `take`. Also attempts to reconnect, at most once a
  /// second.
  void drain(HostAxis& axis, const TakePiece& take);
  /// Sends all bytes or none. A connection that accepted only a part is closed.
  void send(std::size_t sender, std::span<const std::uint8_t> bytes);
  std::uint16_t port() const { return port_; }
  const Senders& senders() const { return senders_; }
  PortCounts counts() const { return counts_; }
  std::uint64_t received() const { return counts_.pieces + counts_.refused; }

 private:
  /// One connection. `connected` is false while the connection is being established.
  struct Link {
    Handle socket;
    HostTime last_arrival{};  // last arrival; before data arrived, begin of the connection
    bool connected = false;
    NodeAddress address{};                   // address of the device
    std::optional<Senders::Known> sender{};  // absent until bytes arrive
  };
  TcpPieces(std::string address, std::uint16_t port, Handle listener);
  void accept(HostTime now);
  bool give_up_idle(HostTime now);
  void try_to_connect(HostTime now);
  bool drain_link(Link& link, HostAxis& axis, const TakePiece& take);
  bool settle(Link& link);

  std::string address_;
  std::uint16_t port_ = 0;
  Handle listener_;  // holds no descriptor if this side connects
  std::vector<Link> links_;
  HostTime next_try_ = HostTime::min();
  std::vector<char> buffer_;
  Senders senders_;
  PortCounts counts_;
};

}  // namespace kinalign
