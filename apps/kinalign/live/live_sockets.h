// SPDX-License-Identifier: Apache-2.0
// The sockets of a verb that works live: a connection to record, and datagrams for frames.
#pragma once

#include "apps/kinalign/live/live_words.h"

#include "kinalign/core/error.h"
#include "kinalign/core/handle.h"
#include "kinalign/wire/time.h"

#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The socket never blocks. Data that this program does not read in time are dropped by record and
/// counted as lost messages.
class LiveConnection {
 public:
  /// Waits at most five seconds. Fails if no server listens there.
  static Result<LiveConnection> open(const Endpoint& at);

  enum class Came { bytes, nothing, end };
  /// Waits at most that time. A connection that broke and one that ended both give Came::end.
  Came wait(Duration patience);
  /// The bytes of the last wait(); valid until the next one.
  std::string_view bytes() const { return {buffer_.data(), size_}; }

 private:
  explicit LiveConnection(Handle socket)
      : socket_(std::move(socket)), buffer_(std::size_t{1} << 16) {}

  Handle socket_;
  std::vector<char> buffer_;
  std::size_t size_ = 0;
};

/// Datagrams to one address. A datagram that no program receives is lost.
/// A lost frame is not repeated: the next one follows at once.
class LiveDatagrams {
 public:
  static Result<LiveDatagrams> open(const Endpoint& to);
  void send(std::string_view text) const;

 private:
  explicit LiveDatagrams(Handle socket) : socket_(std::move(socket)) {}
  Handle socket_;
};

}  // namespace kinalign
