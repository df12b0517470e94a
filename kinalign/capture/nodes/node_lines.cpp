// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/nodes/node_lines.h"

#include "kinalign/capture/nodes/node_filter.h"

#include <sys/epoll.h>

#include <algorithm>
#include <array>
#include <utility>

namespace kinalign {

namespace {

constexpr Duration between_sockets = std::chrono::seconds(1);
// sockets at once: one for each of 64 nodes, and the sockets for all senders
constexpr std::size_t most_ready = 80;

/// A link-local address (fe80::/10) is valid on one interface only, which is not known here.
bool is_link_local(const HostAddress& host) {
  return host[0] == 0xfe && (host[1] & 0xc0U) == 0x80U;
}

}  // namespace

// The open sockets get the numbers after those of the lines.
NodeLines::NodeLines(std::span<const UdpSocket> open, std::size_t most)
    : open_(open), lines_(most), poll_(::epoll_create1(EPOLL_CLOEXEC)) {
  for (std::size_t i = 0; i < open_.size(); ++i) {
    open_[i].share_port();  // if the system refuses, all datagrams arrive at the open sockets
    wait_for(open_[i], most + i);
  }
}

void NodeLines::wait_for(const UdpSocket& socket, std::uint64_t number) {
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.u64 = number;
  ::epoll_ctl(poll_.fd(), EPOLL_CTL_ADD, socket.fd(), &event);
}

// A node whose address changes often gets at most one new socket per second.
void NodeLines::follow(std::size_t stream, const Way& way, std::uint16_t port, HostTime now) {
  Line& line = lines_[stream];
  if (line.socket && line.way == way) return;
  if (line.asked != HostTime::min() && now - line.asked < between_sockets) return;
  line.asked = now;
  line.way = way;
  if (line.socket) dropped_before_ += dropped_by_kernel(*line.socket);
  line.socket.reset();  // closing the socket removes it from poll_
  if (is_link_local(way.from.host) || is_link_local(way.to)) return;
  auto socket = UdpSocket::connected(way.to, port, way.from.host, way.from.port);
  if (!socket) return;
  attach_node_filter(*socket);
  line.socket.emplace(std::move(*socket));
  wait_for(*line.socket, stream);
}

// Sockets of nodes come first, because their numbers are lower than those of the open sockets.
std::span<const UdpSocket* const> NodeLines::ready() {
  std::array<epoll_event, most_ready> events{};
  ready_.clear();
  const int found = ::epoll_wait(poll_.fd(), events.data(), events.size(), 0);
  const auto count = static_cast<std::size_t>(std::max(found, 0));
  std::sort(events.begin(), events.begin() + count,
            [](const auto& a, const auto& b) { return a.data.u64 < b.data.u64; });
  for (const epoll_event& event : std::span(events).first(count)) {
    const auto number = static_cast<std::size_t>(event.data.u64);
    const bool is_line = number < lines_.size();
    // A closed socket may still be in the list of events.
    if (is_line && !lines_[number].socket) continue;
    ready_.push_back(is_line ? &*lines_[number].socket : &open_[number - lines_.size()]);
  }
  return ready_;
}

std::uint64_t NodeLines::dropped() const {
  std::uint64_t sum = dropped_before_;
  for (const UdpSocket& socket : open_) sum += dropped_by_kernel(socket);
  for (const Line& line : lines_) {
    if (line.socket) sum += dropped_by_kernel(*line.socket);
  }
  return sum;
}

}  // namespace kinalign
