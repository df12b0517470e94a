// SPDX-License-Identifier: Apache-2.0
// Asks an NTP server on loopback for SECONDS, with IN_FLIGHT requests under way at any time, and
// prints the number of answers and their delays: ntp_load PORT IN_FLIGHT SECONDS SOURCES. The
// requests come in turn from SOURCES addresses of 127/8. ntp_bench.py runs it.
#include "tests/ntp_client.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <vector>

using namespace kinalign;

namespace {

constexpr std::size_t most = 64;  // datagrams of one system call

std::int64_t now_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
}

/// The buffers of one system call, the same bytes at the same place in each.
struct Messages {
  explicit Messages(sockaddr_in* to) : heads(most), pieces(most), bytes(most), sources(most) {
    for (std::size_t i = 0; i < most; ++i) {
      pieces[i] = {bytes[i].data(), bytes[i].size()};
      heads[i].msg_hdr.msg_iov = &pieces[i];
      heads[i].msg_hdr.msg_iovlen = 1;
      if (to == nullptr) continue;
      heads[i].msg_hdr.msg_name = to;
      heads[i].msg_hdr.msg_namelen = sizeof *to;
      heads[i].msg_hdr.msg_control = sources[i].control.data();
      heads[i].msg_hdr.msg_controllen = sources[i].control.size();
      cmsghdr* head = CMSG_FIRSTHDR(&heads[i].msg_hdr);
      head->cmsg_level = IPPROTO_IP;
      head->cmsg_type = IP_PKTINFO;
      head->cmsg_len = CMSG_LEN(sizeof(in_pktinfo));
    }
  }
  /// Sets the address from which message `i` comes.
  void set_source(std::size_t i, std::uint32_t address) {
    in_pktinfo info{};
    info.ipi_spec_dst.s_addr = htonl(address);
    std::memcpy(CMSG_DATA(CMSG_FIRSTHDR(&heads[i].msg_hdr)), &info, sizeof info);
  }
  struct Source {
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(in_pktinfo))> control;
  };
  std::vector<mmsghdr> heads;
  std::vector<iovec> pieces;
  std::vector<std::array<std::uint8_t, ntp_packet_size>> bytes;
  std::vector<Source> sources;
};

class Load {
 public:
  Load(std::uint16_t port, std::uint32_t sources) : sources_(sources), out_(&to_), in_(nullptr) {
    to_.sin_family = AF_INET;
    to_.sin_port = htons(port);
    to_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{0, 100'000};
    ::setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  }

  void ask(std::size_t requests) {
    for (std::size_t i = 0; i < requests; ++i) {
      NtpPacket request;
      request.mode = ntp_mode_client;
      request.transmit = {sent_at_.size() + 1};
      out_.bytes[i] = encode(request);
      const auto source = static_cast<std::uint32_t>(sent_at_.size() % sources_);
      out_.set_source(i, 0x7f000001U + source);
      sent_at_.push_back(now_ns());
    }
    if (::sendmmsg(fd_, out_.heads.data(), static_cast<unsigned>(requests), 0) !=
        static_cast<int>(requests)) {
      std::perror("sendmmsg");
      std::exit(3);
    }
  }

  /// Receives answers and gives the number of good ones; 0 after a tenth of a second without any.
  std::size_t receive() {
    const int got = ::recvmmsg(fd_, in_.heads.data(), most, MSG_WAITFORONE, nullptr);
    const std::int64_t now = now_ns();
    std::size_t good = 0;
    for (int i = 0; i < got; ++i) {
      const auto& bytes = in_.bytes[static_cast<std::size_t>(i)];
      std::uint64_t asked = 0;  // the originate stamp holds the request's number
      for (std::size_t k = 24; k < 32; ++k) asked = asked << 8 | bytes[k];
      if (asked == 0 || asked > sent_at_.size()) continue;
      const auto answer = ntp_answer_in(bytes, NtpStamp{asked});
      if (!answer || answer->stratum == 0) continue;  // a kiss
      took_.push_back(now - sent_at_[asked - 1]);
      ++good;
    }
    return good;
  }

  std::vector<std::int64_t>& took() { return took_; }
  std::size_t sent() const { return sent_at_.size(); }

 private:
  int fd_ = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in to_{};
  std::uint32_t sources_;
  Messages out_, in_;
  std::vector<std::int64_t> sent_at_, took_;
};

double quantile_us(std::vector<std::int64_t>& took, double share) {
  const auto at =
      took.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(took.size() - 1));
  std::nth_element(took.begin(), at, took.end());
  return static_cast<double>(*at) / 1e3;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  const auto in_flight = std::min<std::size_t>(std::strtoul(argv[2], nullptr, 10), most);
  const double seconds = std::min(std::strtod(argv[3], nullptr), 60.0);
  Load load(static_cast<std::uint16_t>(std::strtoul(argv[1], nullptr, 10)),
            static_cast<std::uint32_t>(std::strtoul(argv[4], nullptr, 10)));
  const std::int64_t begin = now_ns();
  const auto end = begin + static_cast<std::int64_t>(seconds * 1e9);
  std::size_t lost = 0;
  load.ask(in_flight);
  while (now_ns() < end) {
    const std::size_t good = load.receive();
    if (good == 0) lost += in_flight;  // all are lost, because nothing came for a tenth of a second
    load.ask(good == 0 ? in_flight : good);
  }
  const double elapsed = static_cast<double>(now_ns() - begin) / 1e9;
  auto& took = load.took();
  if (took.empty()) return 3;
  std::printf(
      "{\"answers\": %zu, \"lost\": %zu, \"elapsed_s\": %.3f, \"p50_us\": %.1f, \"p99_us\": "
      "%.1f}\n",
      took.size(), lost, elapsed, quantile_us(took, 0.5), quantile_us(took, 0.99));
}
