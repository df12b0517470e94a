// SPDX-License-Identifier: Apache-2.0
// A TCP port that sends the recording to programs on this machine while it is made. The stream is
// MCAP without chunks (docs/formats/recording.md). If a client reads too slowly, whole messages are
// dropped for that client. Gaps in the message numbers show the loss. No call blocks.
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
  // connections refused because of too many clients, or closed because the client sent data
  std::uint64_t turned_away = 0;
  std::uint64_t lost = 0;  // messages dropped for slow clients, summed over the clients
};

class LivePort {
 public:
  static constexpr std::size_t most_clients = 8;
  /// Limit on the bytes that wait for one client, in addition to the kernel's buffer. The limit is
  /// about 18 s of data from a motion capture suit, a Kinect and five nodes.
  static constexpr std::size_t most_waiting = std::size_t{4} << 20;

  /// Listens on 127.0.0.1. Port 0: any free port. Each stream begins with `header` and `head`.
  static Result<LivePort> open(std::uint16_t port, const McapHeader& header,
                               const std::vector<McapMetadata>& head);

  std::uint16_t port() const { return port_; }
  /// Descriptor that becomes readable when a client connects.
  int fd() const { return listener_.fd(); }
  bool has_clients() const { return !clients_.empty(); }

  /// Queues a message for all clients. A client gets the schema and the channel before the first
  /// message of that channel.
  void add(const McapSchema* schema, const McapChannel& channel, const McapMessage& message);
  /// Accepts new clients and sends waiting bytes to each client. Does not block.
  void turn();
  /// Writes the end of each stream. Bytes that a client does not accept now are dropped.
  void end();

  const LivePortCounts& counts() const { return counts_; }

 private:
  /// A client. If it connects during a recording, it gets the head and then all messages from that
  /// time on.
  struct Client {
    Handle socket;
    std::string waiting;   // whole records; only the first may be partly sent
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
