// SPDX-License-Identifier: Apache-2.0
// Receives and sends datagrams in batches. One system call receives up to 32 datagrams, and another
// sends the answers to them. Each answer is sent from the address at which its request arrived. No
// call blocks.
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
  std::uint32_t from_scope = 0;  // interface number of a link-local sender, else 0
  // Address to which the datagram was sent.
  HostAddress to{};
  bool unicast = true;  // `to` is an address of this host, not a broadcast or multicast address
  // the kernel's stamp, CLOCK_REALTIME; absent if the kernel gave none
  std::optional<Time> received;
};

/// Sends `bytes` to the sender of the datagram `asked`. The source address is the address to which
/// `asked` was sent. If that address was a broadcast or multicast address, the system chooses one
/// of this host's addresses. Returns false if the system did not accept the datagram.
bool send_back(int fd, const Datagram& asked, std::span<const std::uint8_t> bytes);

/// Call receive(), then at() and queue() for each datagram, then send(). Reuse one batch, because
/// its buffers are large.
class DatagramBatch {
 public:
  static constexpr std::size_t most = 32;    // datagrams in one batch
  static constexpr std::size_t room = 1536;  // bytes of one received datagram: an Ethernet frame
  // bytes; holds the longest possible UDP datagram
  static constexpr std::size_t any_room = std::size_t{64} << 10;
  static constexpr std::size_t answer_room = 64;  // bytes of one answer

  /// `bytes`: size of the receive buffer. A longer datagram is truncated.
  explicit DatagramBatch(std::size_t bytes = room);
  DatagramBatch(const DatagramBatch&) = delete;
  DatagramBatch& operator=(const DatagramBatch&) = delete;
  ~DatagramBatch() = default;

  /// Receives the waiting datagrams and returns their number. The previous batch is discarded, and
  /// so are its queued answers that were not sent.
  std::size_t receive(int fd);
  Datagram at(std::size_t i) const;

  /// Returns the buffer for the answer to datagram `i`. Write the answer there, then call queue().
  std::span<std::uint8_t, answer_room> answer_to(std::size_t i) { return slots_[i].answer; }
  /// Queues the first `size` bytes of answer_to(i) for the next send(). `asked` is at(i).
  void queue(std::size_t i, const Datagram& asked, std::size_t size);
  /// Sends the queued answers. Returns the indices (see at()) of the datagrams whose answers the
  /// system did not accept. The span is valid until the next call.
  std::span<const std::size_t> send(int fd);

 private:
  static constexpr std::size_t control_room = 128;
  // One received datagram and its answer. The system's message headers point into a slot, so slots
  // must not move.
  struct Slot {
    sockaddr_storage from{};
    iovec in{}, out{};
    alignas(cmsghdr) std::array<std::uint8_t, control_room> control{}, answer_control{};
    std::array<std::uint8_t, answer_room> answer{};
    std::vector<std::uint8_t> bytes;
  };

  std::vector<Slot> slots_;
  std::vector<mmsghdr> in_, out_;
  // out_[k] answers the datagram queued_[k], for k below queue_length_
  std::array<std::size_t, most> queued_{};
  std::size_t queue_length_ = 0;
  std::vector<std::size_t> unsent_;
};

}  // namespace kinalign
