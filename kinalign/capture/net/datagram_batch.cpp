// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/net/datagram_batch.h"

#include "kinalign/capture/net/kernel_stamp.h"
#include "kinalign/capture/net/socket_address.h"

#include <cerrno>
#include <cstring>

namespace kinalign {

namespace {

template <class T>
T read_as(const cmsghdr& control) {
  T value{};
  std::memcpy(&value, CMSG_DATA(&control), sizeof value);
  return value;
}

/// Reads the arrival stamp or the destination address from one control message of the kernel. Other
/// control messages are ignored.
void read_control(const cmsghdr& control, Datagram& datagram) {
  if (const auto stamp = kernel_stamp(control)) {
    datagram.received = stamp;
  } else if (control.cmsg_level == IPPROTO_IP && control.cmsg_type == IP_PKTINFO) {
    const auto info = read_as<in_pktinfo>(control);
    datagram.to = host_of(info.ipi_addr);
    // For a datagram to a broadcast address, the kernel also gives the local address of the
    // interface.
    datagram.unicast = info.ipi_addr.s_addr == info.ipi_spec_dst.s_addr;
  } else if (control.cmsg_level == IPPROTO_IPV6 && control.cmsg_type == IPV6_PKTINFO) {
    const auto info = read_as<in6_pktinfo>(control);
    datagram.to = host_of(info.ipi6_addr);
    datagram.unicast = datagram.to[0] != 0xff;
  }
}

/// Writes the control message that makes `asked.to` the source address of an answer. Returns the
/// number of bytes written to `control`.
std::size_t put_source(const Datagram& asked, std::span<std::uint8_t> control) {
  const bool four = is_ipv4(asked.to);
  const std::size_t size = four ? sizeof(in_pktinfo) : sizeof(in6_pktinfo);
  cmsghdr head{};
  head.cmsg_level = four ? IPPROTO_IP : IPPROTO_IPV6;
  head.cmsg_type = four ? IP_PKTINFO : IPV6_PKTINFO;
  head.cmsg_len = CMSG_LEN(size);
  std::memcpy(control.data(), &head, sizeof head);
  std::uint8_t* at = control.data() + CMSG_LEN(0);
  if (four) {
    in_pktinfo info{};
    std::memcpy(&info.ipi_spec_dst, asked.to.data() + 12, 4);
    std::memcpy(at, &info, sizeof info);
  } else {
    in6_pktinfo info{};
    std::memcpy(&info.ipi6_addr, asked.to.data(), asked.to.size());
    info.ipi6_ifindex = asked.from_scope;
    std::memcpy(at, &info, sizeof info);
  }
  return CMSG_SPACE(size);
}

/// Returns a message header with the address `peer` and the data `out`.
msghdr head_to(void* peer, socklen_t size, iovec& out) {
  msghdr head{};
  head.msg_name = peer;
  head.msg_namelen = size;
  head.msg_iov = &out;
  head.msg_iovlen = 1;
  return head;
}

}  // namespace

bool send_back(int fd, const Datagram& asked, std::span<const std::uint8_t> bytes) {
  if (asked.from_port == 0) return false;
  SystemAddress peer = system_address(asked.from, asked.from_port, asked.from_scope);
  alignas(cmsghdr) std::array<std::uint8_t, CMSG_SPACE(sizeof(in6_pktinfo))> control{};
  // iovec needs a pointer to mutable bytes, but sendmsg(2) does not write to them.
  iovec out{const_cast<std::uint8_t*>(bytes.data()), bytes.size()};
  msghdr head = head_to(peer.data(), peer.size, out);
  // If no source address is given, the system chooses one of this host's addresses.
  if (asked.unicast) {
    head.msg_control = control.data();
    head.msg_controllen = put_source(asked, control);
  }
  return ::sendmsg(fd, &head, MSG_DONTWAIT) == static_cast<ssize_t>(bytes.size());
}

// Each message header points to the buffers of its slot. The slots never move.
DatagramBatch::DatagramBatch(std::size_t bytes) : slots_(most), in_(most), out_(most) {
  unsent_.reserve(most);
  for (std::size_t i = 0; i < most; ++i) {
    Slot& slot = slots_[i];
    slot.bytes.resize(bytes);
    slot.in = {slot.bytes.data(), slot.bytes.size()};
    in_[i].msg_hdr = head_to(&slot.from, sizeof slot.from, slot.in);
    in_[i].msg_hdr.msg_control = slot.control.data();
  }
}

std::size_t DatagramBatch::receive(int fd) {
  queue_length_ = 0;
  for (mmsghdr& message : in_) {  // recvmmsg(2) changed these lengths in the previous call
    message.msg_hdr.msg_namelen = sizeof(sockaddr_storage);
    message.msg_hdr.msg_controllen = control_room;
  }
  const int got = ::recvmmsg(fd, in_.data(), most, MSG_DONTWAIT, nullptr);
  return got < 0 ? 0 : static_cast<std::size_t>(got);
}

Datagram DatagramBatch::at(std::size_t i) const {
  const Slot& slot = slots_[i];
  const mmsghdr& message = in_[i];
  Datagram datagram;
  datagram.bytes = std::span(slot.bytes).first(message.msg_len);
  datagram.cut = (message.msg_hdr.msg_flags & MSG_TRUNC) != 0;
  const NodeAddress from = address_of(slot.from);
  datagram.from = from.host;
  datagram.from_port = from.port;
  if (slot.from.ss_family == AF_INET6) {
    datagram.from_scope = reinterpret_cast<const sockaddr_in6&>(slot.from).sin6_scope_id;
  }
  msghdr head = message.msg_hdr;  // CMSG_NXTHDR needs a mutable header
  for (cmsghdr* control = CMSG_FIRSTHDR(&head); control != nullptr;
       control = CMSG_NXTHDR(&head, control)) {
    read_control(*control, datagram);
  }
  return datagram;
}

// The answer goes to the sender's address that recvmmsg(2) wrote to the slot.
void DatagramBatch::queue(std::size_t i, const Datagram& asked, std::size_t size) {
  Slot& slot = slots_[i];
  slot.out = {slot.answer.data(), size};
  msghdr head = head_to(&slot.from, in_[i].msg_hdr.msg_namelen, slot.out);
  head.msg_control = slot.answer_control.data();
  head.msg_controllen = put_source(asked, slot.answer_control);
  queued_[queue_length_] = i;
  out_[queue_length_++].msg_hdr = head;
}

std::span<const std::size_t> DatagramBatch::send(int fd) {
  unsent_.clear();
  for (std::size_t at = 0; at < queue_length_;) {
    const auto left = static_cast<unsigned>(queue_length_ - at);
    const int sent = ::sendmmsg(fd, &out_[at], left, MSG_DONTWAIT);
    if (sent < 0 && errno == EINTR) continue;
    // The system has no route or its buffer is full; the next answer may still be sent.
    if (sent < 0) unsent_.push_back(queued_[at]);
    at += sent < 0 ? 1 : static_cast<std::size_t>(sent);
  }
  queue_length_ = 0;
  return unsent_;
}

}  // namespace kinalign
