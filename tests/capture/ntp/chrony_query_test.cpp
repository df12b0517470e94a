// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/ntp/chrony_query.h"

#include "kinalign/capture/net/datagram_batch.h"
#include "kinalign/capture/net/udp_socket.h"

#include <doctest/doctest.h>
#include <netinet/in.h>

#include <algorithm>
#include <vector>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

constexpr HostTime start{1h};

/// A chronyd that reports stratum 2 and a root delay of 1 s.
class Chronyd {
 public:
  Chronyd() : socket_(*UdpSocket::open("127.0.0.1", 0)) {}
  std::uint16_t port() const { return socket_.port(); }

  /// Answers the waiting requests and gives their number.
  std::size_t answer() {
    const std::size_t requests = batch_.receive(socket_.fd());
    for (std::size_t i = 0; i < requests; ++i) {
      const Datagram asked = batch_.at(i);
      std::vector<std::uint8_t> bytes(asked.bytes.begin(), asked.bytes.end());
      bytes[1] = 2;
      bytes[7] = 5;
      std::copy_n(asked.bytes.begin() + 8, 4, bytes.begin() + 16);
      std::fill_n(bytes.begin() + 8, 4, std::uint8_t{0});
      bytes[53] = 2;
      bytes[92] = 0x04;  // 2^23 times 2^(2 - 25) s
      bytes[93] = 0x80;
      send(bytes, asked);
    }
    return requests;
  }

 private:
  void send(const std::vector<std::uint8_t>& bytes, const Datagram& asked) const {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(asked.from_port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    REQUIRE(::sendto(socket_.fd(), bytes.data(), bytes.size(), 0,
                     reinterpret_cast<const sockaddr*>(&to), sizeof to) == 104);
  }

  UdpSocket socket_;
  DatagramBatch batch_;
};

}  // namespace

TEST_CASE("an answer is had by the next look, and counts for ten seconds") {
  Chronyd chronyd;
  ChronyQuery query(chronyd.port());
  CHECK(!query.latest(start));
  CHECK(chronyd.answer() == 1);
  query.wait();
  const auto tracking = query.latest(start + 1s);
  REQUIRE(tracking);
  CHECK(tracking->stratum == 2);
  CHECK(tracking->root_delay == 1s);
  CHECK(query.latest(start + 11s));
  CHECK(!query.latest(start + 11s + 1ns));
}

TEST_CASE("it is asked every two seconds, and an answer to an old question is none") {
  Chronyd chronyd;
  ChronyQuery query(chronyd.port());
  for (int i = 0; i < 9; ++i) CHECK(!query.latest(start + 250ms * i));
  CHECK(chronyd.answer() == 2);
  CHECK(query.latest(start + 3s));  // the answer to the second request; the first one's was skipped
}

TEST_CASE("without chronyd no call waits and no answer comes") {
  std::uint16_t port = 0;
  {
    const Chronyd gone;
    port = gone.port();
  }
  ChronyQuery query(port);
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 100; ++i) CHECK(!query.latest(start + 1s * i));
  query.wait();
  CHECK(std::chrono::steady_clock::now() - begin < 5s);
}
