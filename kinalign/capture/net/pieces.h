// SPDX-License-Identifier: Apache-2.0
// Devices' ports, whatever they speak: datagrams or connections, handed on as they came, with their
// arrival on the host's axis and a number for who sent them. Nothing here waits, and one port's
// flood takes no more than its turn.
#pragma once

#include "kinalign/capture/net/datagram_batch.h"
#include "kinalign/capture/net/handle.h"
#include "kinalign/capture/net/host_clock.h"
#include "kinalign/capture/net/udp_socket.h"
#include "kinalign/recording/counts.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// A datagram, or what a connection had at once.
struct Piece {
  std::size_t sender = 0;
  std::string_view bytes;  // good during the call alone
  HostTime arrival{};
  std::optional<Time> stamp{};  // the kernel's, of a datagram
};
using TakePiece = std::function<void(const Piece& piece)>;

/// Who sends to a port, by number. There is room for `most` at once: the number of one who is
/// silent becomes another's, sooner where he has said little or is the newcomer's own past. So
/// neither strangers nor a device's own returns keep a device out.
class Senders {
 public:
  static constexpr std::size_t most = 64;
  static constexpr std::uint64_t little = 10;        // messages: who said fewer may be a stranger
  static constexpr std::uint64_t most_lives = 1000;  // each takes a channel

  struct Sender {
    HostAddress host{};
    std::uint16_t port = 0;
    HostTime heard{};
    std::uint64_t life = 0;   // which sender this is, of all that ever had a number
    std::uint64_t times = 0;  // it was heard
    Datagram asked{};         // of UDP: its newest without its bytes, for answers
  };
  /// Absent: too many others are heard just now. After most_lives a newcomer goes on with the life
  /// of its host that was silent longest; strangers then share the life most_lives + 1.
  std::optional<std::size_t> number(const HostAddress& host, std::uint16_t port, HostTime now);
  /// Of a connection: one that was made anew is another sender, also from the same port. `known`:
  /// the connection's own number and life, set with its first piece.
  struct Known {
    std::size_t number = 0;
    std::uint64_t life = 0;
  };
  std::optional<std::size_t> number(std::optional<Known>& known, const HostAddress& host,
                                    std::uint16_t port, HostTime now);
  const Sender& at(std::size_t number) const { return senders_[number]; }
  /// Absent: it has none.
  std::optional<std::size_t> find(const HostAddress& host, std::uint16_t port) const;
  void remember(std::size_t number, const Datagram& asked);
  std::size_t size() const { return senders_.size(); }

 private:
  void hear(std::size_t number, HostTime now);
  std::optional<std::size_t> add(const HostAddress& host, std::uint16_t port, HostTime now);
  std::optional<std::size_t> place_for(const HostAddress& host, HostTime now);
  std::optional<std::size_t> own_past(const HostAddress& host) const;

  std::vector<Sender> senders_;
  std::uint64_t lives_ = 0;
};

/// A UDP port.
class UdpPieces {
 public:
  /// `address` empty: all.
  static Result<UdpPieces> open(const std::string& address, std::uint16_t port);

  void add_fds(std::vector<int>& fds) const;
  void drain(HostAxis& axis, const TakePiece& take);
  /// At once, from the address that the sender's newest datagram was sent to.
  void send(std::size_t sender, std::span<const std::uint8_t> bytes);
  /// To a sender by its address; nobody else is sent anything.
  void send_to(const HostAddress& host, std::uint16_t port, std::span<const std::uint8_t> bytes);
  std::uint16_t port() const { return sockets_.front().port(); }
  const Senders& senders() const { return senders_; }
  PortCounts counts() const;
  /// All that came, without asking the kernel.
  std::uint64_t heard() const { return counts_.pieces + counts_.refused; }

 private:
  explicit UdpPieces(std::vector<UdpSocket> sockets);
  void take_datagram(const Datagram& datagram, const HostAxis& axis, const TakePiece& take);

  std::vector<UdpSocket> sockets_;
  std::unique_ptr<DatagramBatch> batch_;
  Senders senders_;
  PortCounts counts_;
};

/// TCP: a connection to a device that serves, made anew whenever it breaks, or those of devices
/// that connect to us.
class TcpPieces {
 public:
  /// To the device at `address`, in the background: what is not there yet may come.
  static Result<TcpPieces> connect(const std::string& address, std::uint16_t port);
  static Result<TcpPieces> listen(const std::string& address, std::uint16_t port);

  void add_fds(std::vector<int>& fds) const;
  /// Also connects anew, now and then.
  void drain(HostAxis& axis, const TakePiece& take);
  /// All of it at once or nothing; a connection that took a part is given up.
  void send(std::size_t sender, std::span<const std::uint8_t> bytes);
  std::uint16_t port() const { return port_; }
  const Senders& senders() const { return senders_; }
  PortCounts counts() const { return counts_; }
  std::uint64_t heard() const { return counts_.pieces + counts_.refused; }

 private:
  struct Link {
    Handle socket;
    HostTime heard{};  // or made
    bool connected = false;
    HostAddress host{};  // of the other end
    std::uint16_t port = 0;
    std::optional<Senders::Known> sender{};  // since it said something
  };
  TcpPieces(std::string address, std::uint16_t port, Handle listener);
  void accept(HostTime now);
  bool give_up_idle(HostTime now);
  void try_to_connect(HostTime now);
  bool drain_link(Link& link, HostAxis& axis, const TakePiece& take);
  bool settle(Link& link);

  std::string address_;
  std::uint16_t port_ = 0;
  Handle listener_;  // none: we connect
  std::vector<Link> links_;
  HostTime next_try_ = HostTime::min();
  std::vector<char> buffer_;
  Senders senders_;
  PortCounts counts_;
};

}  // namespace kinalign
