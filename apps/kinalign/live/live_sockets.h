// SPDX-License-Identifier: Apache-2.0
// The sockets of a live verb: a TCP connection to `record`, and UDP datagrams for answered frames.
#pragma once

#include "apps/kinalign/live/live_words.h"

#include "kinalign/core/error.h"
#include "kinalign/core/handle.h"
#include "kinalign/wire/time.h"

#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// A connection to `record`; its socket never blocks. If this program reads too slowly, `record`
/// drops messages and counts them as lost.
class LiveConnection {
 public:
  /// Connects within five seconds. Fails if no server listens at the address.
  static Result<LiveConnection> open(const Endpoint& at);

  enum class Came { bytes, nothing, end };
  /// Waits for data for at most `patience`. Returns Came::end if the connection has broken or
  /// ended.
  Came wait(Duration patience);
  /// The bytes that the last wait() has received. They are valid until the next wait().
  std::string_view bytes() const { return {buffer_.data(), size_}; }

 private:
  explicit LiveConnection(Handle socket)
      : socket_(std::move(socket)), buffer_(std::size_t{1} << 16) {}

  Handle socket_;
  std::vector<char> buffer_;
  std::size_t size_ = 0;
};

/// Sends datagrams to one address. A lost frame is not sent again, because the next one follows at
/// once.
class LiveDatagrams {
 public:
  static Result<LiveDatagrams> open(const Endpoint& to);
  void send(std::string_view text) const;

 private:
  explicit LiveDatagrams(Handle socket) : socket_(std::move(socket)) {}
  Handle socket_;
};

}  // namespace kinalign
