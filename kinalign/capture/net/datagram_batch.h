// SPDX-License-Identifier: Apache-2.0
// Receives and sends datagrams in batches. One system call receives up to 32 datagrams, and one
// sends their answers. Each answer leaves from the address to which its request was sent. No call
// blocks.
#pragma once

#include "kinalign/capture/net/host_address.h"
#include "kinalign/wire/time.h"

#include <sys/socket.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kinalign {

/// A received datagram.
struct Datagram {
  std::span<const std::uint8_t> bytes;
  bool cut = false;  // the datagram was longer than `bytes`
  // Sender's address and UDP port.
  HostAddress from{};
  std::uint16_t from_port = 0;
  std::uint32_t from_scope = 0;  // the interface of a link-local address, else 0
  // Destination address of the datagram.
  HostAddress to{};
  bool unicast = true;  // `to` is an address of this host, not a broadcast or multicast address
  // the kernel's stamp, CLOCK_REALTIME; absent if the kernel gave none
  std::optional<Time> received;
};

/// Sends `bytes` to the sender of `asked`. The source address is the address to which `asked` was
/// sent. If that address was a broadcast or multicast address, the system chooses one of this
/// host's addresses. Returns false if the system did not accept the datagram.
bool send_back(int fd, const Datagram& asked, std::span<const std::uint8_t> bytes);

/// The order of calls: receive, then at and queue for each datagram, then send. A batch is made
/// once, because its buffers are large.
class DatagramBatch {
 public:
  static constexpr std::size_t most = 32;    // datagrams in one batch
  static constexpr std::size_t room = 1536;  // bytes of one received datagram: an Ethernet frame
  // bytes: fits the longest possible UDP datagram
  static constexpr std::size_t any_room = std::size_t{64} << 10;
  static constexpr std::size_t answer_room = 64;  // bytes of one answer

  /// `bytes`: the longest datagram that is received whole; a longer one is truncated.
  explicit DatagramBatch(std::size_t bytes = room);
  DatagramBatch(const DatagramBatch&) = delete;
  DatagramBatch& operator=(const DatagramBatch&) = delete;
  ~DatagramBatch() = default;

  /// Receives the datagrams that are waiting and returns their number. The previous batch is
  /// discarded, with queued answers that were not sent.
  std::size_t receive(int fd);
  Datagram at(std::size_t i) const;

  /// Buffer for the answer to datagram `i`. The answer is sent only if `queue` follows. `asked` is
  /// at(i).
  std::span<std::uint8_t, answer_room> answer_to(std::size_t i) { return slots_[i].answer; }
  void queue(std::size_t i, const Datagram& asked, std::size_t size);
  /// Sends the queued answers. Returns the indices (see at()) of the datagrams whose answers the
  /// system did not accept. The span is valid until the next call.
  std::span<const std::size_t> send(int fd);

 private:
  static constexpr std::size_t control_room = 128;
  // Everything about one datagram and its answer. Messages of the system point into a slot, so
  // slots never move.
  struct Slot {
    sockaddr_storage from{};
    iovec in{}, out{};
    alignas(cmsghdr) std::array<std::uint8_t, control_room> control{}, answer_control{};
    std::array<std::uint8_t, answer_room> answer{};
    std::vector<std::uint8_t> bytes;
  };

  std::vector<Slot> slots_;
  std::vector<mmsghdr> in_, out_;
  // indices of the datagrams that the first queue_length_ messages in out_ answer
  std::array<std::size_t, most> queued_{};
  std::size_t queue_length_ = 0;
  std::vector<std::size_t> unsent_;
};

}  // namespace kinalign
