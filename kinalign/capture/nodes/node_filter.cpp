// SPDX-License-Identifier: Apache-2.0
// The filter is a classic BPF program (the kernel's Documentation/networking/filter.rst). For a UDP
// socket, the program sees the 8 bytes of the UDP header before the datagram.
#include "kinalign/capture/nodes/node_filter.h"

#include "kinalign/wire/node_datagram.h"
#include "kinalign/wire/node_layout.h"

#include <linux/filter.h>
#include <linux/sock_diag.h>
#include <sys/socket.h>

#include <array>

namespace kinalign {

namespace {

// Bytes of the UDP header, and of a node's shortest datagram.
constexpr std::uint32_t header = 8;
constexpr std::uint32_t least = node_datagram_size(0, false);

// One instruction. `if_true` and `if_false` count the instructions that a jump skips.
constexpr sock_filter step(int code, std::uint32_t k, int if_true = 0, int if_false = 0) {
  return {static_cast<std::uint16_t>(code), static_cast<std::uint8_t>(if_true),
          static_cast<std::uint8_t>(if_false), k};
}

}  // namespace

bool attach_node_filter(const UdpSocket& socket) {
  // The filter accepts a datagram if its length is within the limits, its length field equals the
  // length, and it begins with the magic number. Datagrams of all protocol versions pass, because
  // unknown versions are counted.
  std::array program{
      step(BPF_LD | BPF_W | BPF_LEN, 0),
      step(BPF_JMP | BPF_JGE | BPF_K, header + least, 0, 8),
      step(BPF_JMP | BPF_JGT | BPF_K, header + max_node_datagram, 7, 0),
      step(BPF_ALU | BPF_SUB | BPF_K, header),
      step(BPF_MISC | BPF_TAX, 0),
      step(BPF_LD | BPF_H | BPF_ABS, header + 6),  // the length field of the datagram
      step(BPF_JMP | BPF_JEQ | BPF_X, 0, 0, 3),
      step(BPF_LD | BPF_W | BPF_ABS, header),
      step(BPF_JMP | BPF_JEQ | BPF_K, node_magic, 0, 1),
      step(BPF_RET | BPF_K, 0xffff),
      step(BPF_RET | BPF_K, 0),
  };
  const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
  return ::setsockopt(socket.fd(), SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter) == 0;
}

}  // namespace kinalign
