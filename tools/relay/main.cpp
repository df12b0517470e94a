// SPDX-License-Identifier: Apache-2.0
// A UDP relay on loopback that delays, loses, doubles and reorders like a simulated link, for tests
// with real sockets:  kinalign_relay HOST_PORT LINK SEED RATE_HZ
// LINK is A to G. Prints its port, then a line for each sender: the port under which the host knows
// it, and the least delays that it gets up and down, s.
// Ends with its standard input. A late wake-up makes delays longer, never shorter.
#include "kinalign/simulate/nodes/packet_fates.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <queue>

namespace {

using namespace kinalign;
using Clock = std::chrono::steady_clock;

constexpr std::size_t most_senders = 64, most_waiting = 100'000;

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

int open_socket() {
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const sockaddr_in any = loopback(0);
  if (fd < 0 || ::bind(fd, reinterpret_cast<const sockaddr*>(&any), sizeof any) != 0) std::exit(3);
  return fd;
}

std::uint16_t port_of(int fd) {
  sockaddr_in bound{};
  socklen_t size = sizeof bound;
  ::getsockname(fd, reinterpret_cast<sockaddr*>(&bound), &size);
  return ntohs(bound.sin_port);
}

/// A node, and the socket through which the host sees it.
struct Sender {
  sockaddr_in address{};
  int to_host = -1;
  PacketFates up, down;
};

struct Packet {
  Clock::time_point at;
  int fd = -1;
  sockaddr_in to{};
  std::vector<std::uint8_t> bytes;

  // The earliest packet comes first.
  bool operator<(const Packet& other) const { return at > other.at; }
};

class Relay {
 public:
  Relay(std::uint16_t host_port, const LinkOptions& link, std::uint64_t seed, double rate_hz)
      : host_(loopback(host_port)), link_(link), seed_(seed), rate_hz_(rate_hz) {}

  std::uint16_t port() const { return port_of(front_); }

  void run() {
    for (;;) {
      std::vector<pollfd> waiting{{STDIN_FILENO, POLLIN, 0}, {front_, POLLIN, 0}};
      for (const auto& sender : senders_) waiting.push_back({sender->to_host, POLLIN, 0});
      wait(waiting);
      if (waiting[0].revents != 0) return;
      take_from_nodes();
      for (const auto& sender : senders_) take_from_host(*sender);
      send_what_is_due();
    }
  }

 private:
  void wait(std::vector<pollfd>& waiting) {
    if (packets_.empty()) {
      ::poll(waiting.data(), waiting.size(), -1);
      return;
    }
    const auto left = std::max(packets_.top().at - Clock::now(), Clock::duration::zero());
    const auto whole = std::chrono::duration_cast<std::chrono::seconds>(left);
    const timespec timeout{whole.count(), (left - whole).count()};
    ::ppoll(waiting.data(), waiting.size(), &timeout, nullptr);
  }

  void take_from_nodes() {
    sockaddr_in from{};
    while (const std::size_t size = receive(front_, from)) {
      if (Sender* sender = sender_of(from)) put(sender->up.next(), size, sender->to_host, host_);
    }
  }

  void take_from_host(Sender& sender) {
    sockaddr_in from{};
    while (const std::size_t size = receive(sender.to_host, from)) {
      put(sender.down.next(), size, front_, sender.address);
    }
  }

  std::size_t receive(int fd, sockaddr_in& from) {
    socklen_t length = sizeof from;
    const ssize_t size = ::recvfrom(fd, buffer_.data(), buffer_.size(), 0,
                                    reinterpret_cast<sockaddr*>(&from), &length);
    return size > 0 ? static_cast<std::size_t>(size) : 0;
  }

  Sender* sender_of(const sockaddr_in& from) {
    for (const auto& sender : senders_) {
      if (sender->address.sin_port == from.sin_port) return sender.get();
    }
    if (senders_.size() == most_senders) return nullptr;
    const std::uint64_t seed = seed_ + senders_.size();
    senders_.push_back(std::make_unique<Sender>(
        Sender{from, open_socket(), PacketFates(link_, seed, Way::up, rate_hz_),
               PacketFates(link_, seed, Way::down, rate_hz_)}));
    const Floors least = floors(link_.link, seed);
    std::printf("%d %.9f %.9f\n", port_of(senders_.back()->to_host), least.up, least.down);
    std::fflush(stdout);
    return senders_.back().get();
  }

  void put(const PacketFates::Fate& fate, std::size_t size, int fd, const sockaddr_in& to) {
    const auto now = Clock::now();
    for (const auto& delay : {fate.first, fate.duplicate}) {
      if (!delay || packets_.size() == most_waiting) continue;
      packets_.push({now + *delay,
                     fd,
                     to,
                     {buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(size)}});
    }
  }

  void send_what_is_due() {
    while (!packets_.empty() && packets_.top().at <= Clock::now()) {
      const Packet& packet = packets_.top();
      ::sendto(packet.fd, packet.bytes.data(), packet.bytes.size(), 0,
               reinterpret_cast<const sockaddr*>(&packet.to), sizeof packet.to);
      packets_.pop();
    }
  }

  sockaddr_in host_;
  LinkOptions link_;
  std::uint64_t seed_;
  double rate_hz_;
  int front_ = open_socket();
  std::vector<std::unique_ptr<Sender>> senders_;
  std::priority_queue<Packet> packets_;
  std::array<std::uint8_t, 2048> buffer_{};
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5 || argv[2][0] < 'A' || argv[2][0] > 'G') {
    std::fputs("usage: kinalign_relay HOST_PORT LINK(A-G) SEED RATE_HZ\n", stderr);
    return 2;
  }
  ::prctl(PR_SET_TIMERSLACK, 1000UL);  // timer slack in ns
  LinkOptions link;
  link.link = static_cast<Link>(argv[2][0] - 'A');
  Relay relay(static_cast<std::uint16_t>(std::strtoul(argv[1], nullptr, 10)), link,
              std::strtoull(argv[3], nullptr, 10), std::strtod(argv[4], nullptr));
  std::printf("%d\n", relay.port());
  std::fflush(stdout);
  relay.run();
  return 0;
}
