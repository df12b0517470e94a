// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/ntp/time_server.h"

#include "tests/capture/loopback.h"
#include "tests/ntp_client.h"

#include <doctest/doctest.h>

#include <atomic>
#include <thread>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

/// A server on a thread of its own, until the end of the test case.
class Running {
 public:
  explicit Running(TimeServerOptions options) {
    options.port = 0;
    auto opened = TimeServer::open(options);
    REQUIRE(opened);
    server_.emplace(std::move(*opened));
    thread_ = std::thread([this] { server_->serve([this] { return !stop_; }); });
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  ~Running() { stop(); }

  std::uint16_t port() const { return server_->sockets().front().port(); }
  /// Stops the server, and gives its counts.
  const NtpCounts& stop() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    return server_->counts();
  }

 private:
  std::optional<TimeServer> server_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

TimeServerOptions local_reference() {
  TimeServerOptions options;
  options.local_stratum = 10;
  return options;
}

std::vector<std::uint8_t> request(std::uint8_t first) {
  std::vector<std::uint8_t> bytes(48);
  bytes[0] = first;
  bytes[40] = 0xab;
  return bytes;
}

}  // namespace

TEST_CASE("fault 40 ipv6_only, dual_stack_same_node: one port answers on both kinds of address") {
  Running running(local_reference());
  std::vector<std::pair<int, std::string>> ways{{AF_INET, "127.0.0.1"}, {AF_INET, "127.0.0.77"}};
  if (has_ipv6_loopback()) ways.emplace_back(AF_INET6, "::1");
  for (const auto& [family, to] : ways) {
    const Client client(family);
    client.send(to, running.port(), request(0x23));
    const auto came = client.receive();
    REQUIRE(came);
    CHECK(came->from == to);
    const auto answer = ntp_answer_in(came->bytes, NtpStamp{0xab00000000000000});
    REQUIRE(answer);
    CHECK(ntp_difference(answer->receive, answer->transmit) >= 0ns);
    CHECK(ntp_difference(answer->receive, answer->transmit) < 1s);
  }
  CHECK(running.stop()[NtpOutcome::answered] == ways.size());
}

TEST_CASE("what is refused gets no answer and is counted; the server goes on") {
  Running running(local_reference());
  const Client client;
  client.send("127.0.0.1", running.port(), request(0x26));
  client.send("127.0.0.1", running.port(), {1, 2, 3});
  client.send("127.0.0.1", running.port(), std::vector<std::uint8_t>(65'507, 0x23));
  client.send("127.0.0.1", running.port(), {});
  client.send("127.0.0.1", running.port(), request(0x1b));
  const auto came = client.receive();
  REQUIRE(came);
  CHECK(came->bytes[0] == 0x1c);  // the only answer, of version 3
  const NtpCounts& counts = running.stop();
  CHECK(counts[NtpOutcome::answered] == 1);
  CHECK(counts[NtpOutcome::wrong_mode] == 1);
  CHECK(counts[NtpOutcome::too_short] == 2);
  CHECK(counts[NtpOutcome::wrong_trailer] == 1);
  CHECK(counts.total() == 5);
}

TEST_CASE("an address that is not this host's is refused before anything is served") {
  TimeServerOptions options;
  options.addresses = {"127.0.0.1", "192.0.2.77"};
  options.port = 0;
  const auto server = TimeServer::open(options);
  REQUIRE(!server);
  CHECK(server.error().found == "no network interface with this address");
}

TEST_CASE("several addresses share one port") {
  TimeServerOptions options = local_reference();
  options.addresses = {"127.0.0.3", "127.0.0.4"};
  Running running(options);
  for (const std::string to : {"127.0.0.3", "127.0.0.4"}) {
    const Client client;
    client.send(to, running.port(), request(0x23));
    CHECK(client.receive());
  }
}
