// SPDX-License-Identifier: Apache-2.0
// Datagrams by the batch: one system call receives up to 32, one sends the answers, each from the
// address that was asked. Waits for nothing, neither for what comes nor for what goes.
#pragma once

#include "kinalign/capture/net/host_address.h"
#include "kinalign/wire/time.h"

#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kinalign {

/// A datagram as it arrived.
struct Datagram {
  std::span<const std::uint8_t> bytes;
  bool cut = false;  // it was longer than `bytes`
  HostAddress from{};
  std::uint16_t from_port = 0;
  std::uint32_t from_scope = 0;  // of a link-local address: the interface
  HostAddress to{};
  bool unicast = true;           // `to` is an address of this host
  std::optional<Time> received;  // the kernel's stamp, CLOCK_REALTIME; none where it gave none
};

/// Sends to where `asked` came from, from the address that it was sent to; where that was not this
/// host's alone, from one of its own. False: the system did not take it.
bool send_back(int fd, const Datagram& asked, std::span<const std::uint8_t> bytes);

class DatagramBatch {
 public:
  static constexpr std::size_t most = 32;    // datagrams of one batch
  static constexpr std::size_t room = 1536;  // bytes of one that comes: a frame of Ethernet
  static constexpr std::size_t any_room = std::size_t{64} << 10;  // for the longest there is
  static constexpr std::size_t answer_room = 64;                  // bytes of one that goes

  /// `bytes`: of a datagram that comes, at most; longer ones are cut.
  explicit DatagramBatch(std::size_t bytes = room);
  DatagramBatch(const DatagramBatch&) = delete;
  DatagramBatch& operator=(const DatagramBatch&) = delete;
  ~DatagramBatch() = default;

  /// What has come since; the number of datagrams. Forgets the batch before, with answers that were
  /// not sent.
  std::size_t receive(int fd);
  Datagram at(std::size_t i) const;

  /// Room for an answer to datagram `i`, which is sent if `queue` follows. `asked`: at(i).
  std::span<std::uint8_t, answer_room> answer_to(std::size_t i) { return slots_[i].answer; }
  void queue(std::size_t i, const Datagram& asked, std::size_t size);
  /// Sends what was queued. Those that the system did not take, as numbers for at(); good until the
  /// next call.
  std::span<const std::size_t> send(int fd);

 private:
  static constexpr std::size_t control_room = 128;
  struct Slot {
    sockaddr_in6 from{};  // holds a sockaddr_in too
    iovec in{}, out{};
    alignas(cmsghdr) std::array<std::uint8_t, control_room> control{}, answer_control{};
    std::array<std::uint8_t, answer_room> answer{};
    std::vector<std::uint8_t> bytes;
  };

  std::vector<Slot> slots_;
  std::vector<mmsghdr> in_, out_;
  std::array<std::size_t, most> queued_{};  // which datagrams the first of out_ answer
  std::size_t queue_length_ = 0;
  std::vector<std::size_t> unsent_;
};

}  // namespace kinalign
