// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/net/pieces.h"
#include "kinalign/wire/little_endian_reader.h"

#include <algorithm>

namespace kinalign {

namespace {

constexpr int batches_in_turn = 4;  // batches of one socket before other ports are read

}  // namespace

Result<UdpPieces> UdpPieces::open(const std::string& address, std::uint16_t port) {
  const std::vector<std::string> addresses =
      address.empty() ? std::vector<std::string>() : std::vector{address};
  return UdpPieces(KA_TRY(open_udp_sockets(addresses, port)));
}

UdpPieces::UdpPieces(std::vector<UdpSocket> sockets)
    : sockets_(std::move(sockets)),
      batch_(std::make_unique<DatagramBatch>(DatagramBatch::any_room)) {}

void UdpPieces::add_fds(std::vector<int>& fds) const {
  for (const UdpSocket& socket : sockets_) fds.push_back(socket.fd());
}

void UdpPieces::drain(HostAxis& axis, const TakePiece& take) {
  for (const UdpSocket& socket : sockets_) {
    for (int turn = 0; turn < batches_in_turn; ++turn) {
      const std::size_t datagrams = batch_->receive(socket.fd());
      if (datagrams == 0) break;
      axis.look();
      for (std::size_t i = 0; i < datagrams; ++i) take_datagram(batch_->at(i), axis, take);
      if (datagrams < DatagramBatch::most) break;
    }
  }
}

// A truncated datagram is passed on without its end. With buffers of `any_room` bytes this is rare.
void UdpPieces::take_datagram(const Datagram& datagram, const HostAxis& axis,
                              const TakePiece& take) {
  const HostTime arrival = axis.arrival(datagram.received);
  const auto sender = senders_.number(datagram.from, datagram.from_port, arrival);
  ++(sender ? counts_.pieces : counts_.refused);
  if (datagram.cut) ++counts_.cut;
  if (!sender) return;
  counts_.bytes += datagram.bytes.size();
  senders_.remember(*sender, datagram);
  take({*sender, text_of(datagram.bytes), arrival});
}

void UdpPieces::send(std::size_t sender, std::span<const std::uint8_t> bytes) {
  const Datagram& asked = senders_.at(sender).asked;
  // Each socket serves one address family. The answer needs the socket of the sender's family.
  const auto socket = std::find_if(sockets_.begin(), sockets_.end(), [&](const UdpSocket& one) {
    return is_ipv6_text(one.address()) != is_ipv4(asked.from);
  });
  if (socket == sockets_.end() || !send_back(socket->fd(), asked, bytes)) ++counts_.unsent;
}

void UdpPieces::send_to(const HostAddress& host, std::uint16_t port,
                        std::span<const std::uint8_t> bytes) {
  if (const auto sender = senders_.find(host, port)) send(*sender, bytes);
}

PortCounts UdpPieces::counts() const {
  PortCounts counts = counts_;
  for (const UdpSocket& socket : sockets_) counts.dropped += dropped_by_kernel(socket);
  return counts;
}

}  // namespace kinalign
