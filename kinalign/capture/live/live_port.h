// SPDX-License-Identifier: Apache-2.0
// A TCP port for programs on this machine. It serves the recording while it is made, as an MCAP
// stream without chunks: docs/formats/recording.md. A client that reads too slowly loses whole
// messages, which shows in the message numbers. No call blocks.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/handle.h"
#include "kinalign/mcap/records.h"

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace kinalign {

/// Counts since the port was opened.
struct LivePortCounts {
  std::uint64_t clients = 0;  // clients that were accepted
  // connections refused or closed: too many clients, or the client sent data
  std::uint64_t turned_away = 0;
  std::uint64_t lost = 0;  // messages that slow clients did not get, summed over the clients
};

class LivePort {
 public:
  static constexpr std::size_t most_clients = 8;
  /// Limit on the bytes waiting for one client, besides the kernel's buffer: half a minute of the
  /// paper's devices.
  static constexpr std::size_t most_waiting = std::size_t{4} << 20;

  /// Listens on 127.0.0.1. Port 0: any free port. Each stream begins with `header` and `head`.
  static Result<LivePort> open(std::uint16_t port, const McapHeader& header,
                               const std::vector<McapMetadata>& head);

  std::uint16_t port() const { return port_; }
  /// Readable when a client connects.
  int fd() const { return listener_.fd(); }
  bool has_clients() const { return !clients_.empty(); }

  /// Queues a message for all clients. A client gets schema and channel before the channel's first
  /// message.
  void add(const McapSchema* schema, const McapChannel& channel, const McapMessage& message);
  /// Accepts clients and sends waiting bytes as far as the clients accept them. Does not block.
  void turn();
  /// Ends all streams properly. A client that does not accept its remaining bytes now does not get
  /// them.
  void end();

  const LivePortCounts& counts() const { return counts_; }

 private:
  /// A client that connects in the middle of a recording gets the head and then all messages from
  /// that time on.
  struct Client {
    Handle socket;
    std::string waiting;   // whole records, except that a part of the first one may be sent already
    std::size_t sent = 0;  // bytes of `waiting` that are sent
    std::set<std::uint16_t> channels{}, schemas{};  // ids already sent to this client
    std::uint64_t lost = 0;                         // messages not queued for this client
  };
  LivePort(Handle listener, std::uint16_t port) : listener_(std::move(listener)), port_(port) {}
  void accept();
  bool is_silent(const Client& client);
  static bool send(Client& client);

  Handle listener_;
  std::uint16_t port_ = 0;
  std::string head_;  // the first bytes of each stream
  std::vector<Client> clients_;
  LivePortCounts counts_;
};

}  // namespace kinalign
