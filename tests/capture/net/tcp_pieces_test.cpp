// SPDX-License-Identifier: Apache-2.0
#include "tests/capture/recorded.h"

#include "kinalign/capture/net/pieces.h"

#include <doctest/doctest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

/// A device whose queue is full: a client that connects gets no answer.
class FullDevice {
 public:
  FullDevice() : listener_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    address_.sin_family = AF_INET;
    address_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address_;
    auto* at = reinterpret_cast<sockaddr*>(&address_);
    REQUIRE(::bind(listener_, at, sizeof address_) == 0);
    REQUIRE(::listen(listener_, 0) == 0);
    REQUIRE(::getsockname(listener_, at, &size) == 0);
    for (int& guest : guests_) {
      guest = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
      (void)::connect(guest, at, sizeof address_);
    }
  }
  FullDevice(const FullDevice&) = delete;
  FullDevice& operator=(const FullDevice&) = delete;
  ~FullDevice() {
    for (const int guest : guests_) ::close(guest);
    ::close(listener_);
  }
  std::uint16_t port() const { return ntohs(address_.sin_port); }

 private:
  int listener_;
  sockaddr_in address_{};
  std::array<int, 4> guests_{};
};

/// The system's clocks, set later by some time.
struct LateClocks : SystemClocks {
  Duration late{0};
  HostTime raw() override { return SystemClocks::raw() + late; }
  Time utc() override { return SystemClocks::utc() + late; }
};

}  // namespace

TEST_CASE("an unanswered connection is given up within seconds, and tried again") {
  const FullDevice device;
  SystemClocks clocks;
  HostAxis axis(clocks);
  auto pieces = TcpPieces::connect("127.0.0.1", device.port());
  REQUIRE(pieces);
  const auto drain = [&] { pieces->drain(axis, [](const Piece&) {}); };
  const auto fds = [&] {
    std::vector<int> all;
    pieces->add_fds(all);
    return all;
  };
  drain();
  REQUIRE(fds().size() == 1);
  const HostTime begun = axis.now();
  pollfd waiting{fds().front(), POLLIN, 0};
  CHECK(::poll(&waiting, 1, 20'000) == 1);  // the system has given up the connection
  CHECK(axis.now() - begun < std::chrono::seconds(10));
  drain();
  drain();
  CHECK(fds().size() == 1);  // another device
  CHECK(pieces->counts().links == 0);
}

TEST_CASE("buffered bytes of a connection are read in small pieces, each with its own stamp") {
  LateClocks clocks;
  HostAxis axis(clocks);
  auto pieces = TcpPieces::listen("127.0.0.1", 0);
  REQUIRE(pieces);
  const Connection device(pieces->port());
  device.send(std::string(20'000, 'x'));
  std::size_t bytes = 0;
  pieces->drain(axis, [&](const Piece& piece) {
    CHECK(piece.bytes.size() <= 4096);
    bytes += piece.bytes.size();
  });
  CHECK(bytes == 20'000);
}

TEST_CASE("bytes of a connection have the kernel's stamp, however late they are read") {
  auto pieces = TcpPieces::listen("127.0.0.1", 0);
  REQUIRE(pieces);
  const auto seems_to_take = [&] {
    LateClocks clocks;
    HostAxis axis(clocks);
    const Connection device(pieces->port());
    device.send("said before the connection was taken");
    const HostTime sent = axis.now();  // or received already, as loopback does it in the same call
    clocks.late = 10min;
    std::vector<HostTime> arrivals;
    pieces->drain(axis, [&](const Piece& piece) { arrivals.push_back(piece.arrival); });
    REQUIRE(arrivals.size() == 1);
    return arrivals[0] - sent;
  };
  // The kernel begins to stamp a moment after the first socket has asked for stamps. A datagram
  // that comes before that is stamped when it is read.
  Duration took = seems_to_take();
  for (int i = 0; i < 20 && took > 5min; ++i) {
    std::this_thread::sleep_for(10ms);
    took = seems_to_take();
  }
  CHECK(took < 5min);
}
