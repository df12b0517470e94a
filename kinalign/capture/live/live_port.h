// SPDX-License-Identifier: Apache-2.0
// A port of this machine alone that serves what is recorded while it is recorded, as an MCAP stream
// without chunks: docs/formats/recording.md. A client that reads too slowly loses whole messages,
// which their numbers show. Nothing here waits for a client.
#pragma once

#include "kinalign/capture/net/handle.h"
#include "kinalign/core/error.h"
#include "kinalign/mcap/records.h"

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace kinalign {

struct LivePortCounts {
  std::uint64_t clients = 0;      // that were let in
  std::uint64_t turned_away = 0;  // there were too many, or they sent something
  std::uint64_t lost = 0;         // messages that slow clients did not get, of all of them
};

class LivePort {
 public:
  static constexpr std::size_t most_clients = 8;
  /// Bytes that wait for a client at most, beside what the kernel keeps: half a minute of the
  /// paper's devices.
  static constexpr std::size_t most_waiting = std::size_t{4} << 20;

  /// On 127.0.0.1; port 0: any free one. A stream begins with `head`.
  static Result<LivePort> open(std::uint16_t port, const McapHeader& header,
                               const std::vector<McapMetadata>& head);

  std::uint16_t port() const { return port_; }
  /// The one that says that a client has come.
  int fd() const { return listener_.fd(); }
  bool has_clients() const { return !clients_.empty(); }

  /// For all clients. A client gets schema and channel before the channel's first message.
  void add(const McapSchema* schema, const McapChannel& channel, const McapMessage& message);
  /// Lets clients in, and sends what waits as far as they take it. Waits for nothing.
  void turn();
  /// The streams end in order. A client that does not take its rest now does not get it.
  void end();

  const LivePortCounts& counts() const { return counts_; }

 private:
  struct Client {
    Handle socket;
    std::string waiting;   // whole records but for the first one, of which a part may be sent
    std::size_t sent = 0;  // bytes of it
    std::set<std::uint16_t> channels{}, schemas{};  // that it knows
    std::uint64_t lost = 0;                         // messages
  };
  LivePort(Handle listener, std::uint16_t port) : listener_(std::move(listener)), port_(port) {}
  void accept();
  bool is_silent(const Client& client);
  static bool send(Client& client);

  Handle listener_;
  std::uint16_t port_ = 0;
  std::string head_;  // the bytes that a stream begins with
  std::vector<Client> clients_;
  LivePortCounts counts_;
};

}  // namespace kinalign
