// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/ntp/ntp_responder.h"

#include "tests/capture/test_node.h"
#include "tests/ntp_client.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <set>
#include <string>
#include <vector>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

const Time arrival = utc_time(1'790'000'000'000'000'000);
constexpr HostTime host_start{1h};
constexpr SipHashKey key{1, 2, 3};

std::vector<std::uint8_t> request(std::uint8_t first = 0x23) {
  std::vector<std::uint8_t> bytes(48);
  bytes[0] = first;
  bytes[47] = 77;
  return bytes;
}

HostAddress address(const std::string& text) { return parse_network(text)->prefix; }

/// A responder and a request to it that is answered.
struct Bench {
  NtpResponder responder{key, {}};
  std::vector<std::uint8_t> bytes = request();
  NtpAsked asked{.bytes = bytes,
                 .from = address("192.0.2.1"),
                 .from_port = 40'000,
                 .to = address("192.0.2.9"),
                 .to_port = 123,
                 .received = arrival};
  std::array<std::uint8_t, 48> answer{};

  NtpOutcome respond(Duration later = 0s) {
    return responder.respond(asked, arrival + 20us, host_start + later, answer);
  }
  NtpOutcome respond_to(const std::vector<std::uint8_t>& other) {
    asked.bytes = other;
    return respond();
  }
};

}  // namespace

TEST_CASE("a request is answered with its own stamp and the server's two") {
  Bench bench;
  NtpServerState state;
  state.leap = NtpLeap::none;
  state.stratum = 10;
  bench.responder.set_state(state);
  CHECK(bench.respond() == NtpOutcome::answered);
  const auto answer = ntp_answer_in(bench.answer, NtpStamp{77});
  REQUIRE(answer);
  CHECK(answer->stratum == 10);
  CHECK(time_from_ntp(answer->receive, arrival) == arrival);
  CHECK(time_from_ntp(answer->transmit, arrival) == arrival + 20us);
}

TEST_CASE("each cause of refusal is distinguished, and none writes an answer") {
  Bench bench;
  CHECK(bench.respond_to({}) == NtpOutcome::too_short);
  CHECK(bench.respond_to(std::vector<std::uint8_t>(47, 0x23)) == NtpOutcome::too_short);
  CHECK(bench.respond_to(request(0x03)) == NtpOutcome::wrong_version);
  CHECK(bench.respond_to(request(0x2b)) == NtpOutcome::wrong_version);
  for (const unsigned mode : {0U, 1U, 2U, 4U, 5U, 6U, 7U}) {
    CHECK(bench.respond_to(request(static_cast<std::uint8_t>(0x20U | mode))) ==
          NtpOutcome::wrong_mode);
  }
  auto longer = request();
  longer.resize(1500);
  CHECK(bench.respond_to(longer) == NtpOutcome::wrong_trailer);
  CHECK(bench.answer == std::array<std::uint8_t, 48>{});
}

TEST_CASE("a node's datagram is distinguished from a client's with a similar first byte") {
  Bench bench;
  TestNode node(7, 1);
  CHECK(bench.respond_to(node.frame(host_s(0.0))) == NtpOutcome::from_node);
  node.samples.resize(3);
  std::vector<std::uint8_t> damaged = node.frame(host_s(0.0));
  CHECK(bench.respond_to(damaged) == NtpOutcome::from_node);
  damaged[40] ^= 1U;
  CHECK(bench.respond_to(damaged) == NtpOutcome::wrong_trailer);
}

TEST_CASE("a request that was cut on arrival is not judged by the part that came") {
  Bench bench;
  bench.asked.cut = true;
  CHECK(bench.respond() == NtpOutcome::wrong_trailer);
}

TEST_CASE("no answer goes to port 0, to the server itself or to a broadcast request") {
  Bench bench;
  bench.asked.from_port = 0;
  CHECK(bench.respond() == NtpOutcome::from_port_0);
  bench.asked.from_port = 123;
  CHECK(bench.respond() == NtpOutcome::answered);  // an old client's port, another address
  bench.asked.from = bench.asked.to;
  CHECK(bench.respond() == NtpOutcome::from_itself);
  bench.asked.from_port = 40'000;
  CHECK(bench.respond() == NtpOutcome::answered);  // a client on this host
  bench.asked.unicast = false;
  CHECK(bench.respond() == NtpOutcome::not_unicast);
}

TEST_CASE("fault 17 host_step: a clock stepped while the request waited gives no answer") {
  Bench bench;
  CHECK(bench.responder.respond(bench.asked, arrival + 1h, host_start, bench.answer) ==
        NtpOutcome::clock_stepped);
}

TEST_CASE("an address is limited whatever port it asks from, and others are not") {
  Bench bench;
  for (int i = 0; i < 8; ++i) {
    ++bench.asked.from_port;
    CHECK(bench.respond() == NtpOutcome::answered);
  }
  CHECK(bench.respond() == NtpOutcome::limited);
  bench.asked.from = address("192.0.2.2");
  CHECK(bench.respond() == NtpOutcome::answered);
  bench.asked.from = address("192.0.2.1");
  CHECK(bench.respond() == NtpOutcome::limited);
  CHECK(bench.respond(2s) == NtpOutcome::answered);
}

TEST_CASE("an IPv6 network of 64 bits is one client") {
  Bench bench;
  for (int i = 0; i < 8; ++i) {
    bench.asked.from = address("2001:db8::" + std::to_string(i));
    CHECK(bench.respond() == NtpOutcome::answered);
  }
  bench.asked.from = address("2001:db8::ffff");
  CHECK(bench.respond() == NtpOutcome::limited);
  bench.asked.from = address("2001:db8:0:1::1");
  CHECK(bench.respond() == NtpOutcome::answered);
}

TEST_CASE("what is refused costs its address nothing") {
  Bench bench;
  for (int i = 0; i < 100; ++i) CHECK(bench.respond_to(request(0x24)) == NtpOutcome::wrong_mode);
  CHECK(bench.respond_to(request()) == NtpOutcome::answered);
}

TEST_CASE("fault 27 kod: one in 16 refusals by the limit gets RATE") {
  Bench bench;
  NtpCounts counts;
  for (int i = 0; i < 8 + 160; ++i) ++counts[bench.respond()];
  CHECK(counts[NtpOutcome::answered] == 8);
  CHECK(counts[NtpOutcome::kissed] == 10);
  CHECK(counts[NtpOutcome::limited] == 150);
  CHECK(counts.total() == 168);
  const auto kiss = ntp_answer_in(bench.answer, NtpStamp{77});
  REQUIRE(kiss);
  CHECK(kiss->stratum == 0);
  CHECK(kiss->reference_id == ntp_code("RATE"));
}

TEST_CASE("an exempt network asks as often as it likes") {
  Bench bench;
  bench.responder = NtpResponder(key, {*parse_network("192.0.2.0/28"), *parse_network("fd00::/8")});
  for (int i = 0; i < 100; ++i) CHECK(bench.respond() == NtpOutcome::answered);
  bench.asked.from = address("192.0.2.16");
  for (int i = 0; i < 8; ++i) CHECK(bench.respond() == NtpOutcome::answered);
  CHECK(bench.respond() == NtpOutcome::limited);
}

TEST_CASE(
    "fault 26 garbage: any bytes are answered only where they are a client's, and with its stamp") {
  for (const auto seed : fresh_seeds(2000)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::vector<std::uint8_t> bytes(random() % 120);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    Bench bench;
    if (bench.respond_to(bytes) != NtpOutcome::answered) continue;
    REQUIRE(bytes.size() >= 48);
    CHECK((bytes[0] & 7U) == 3);
    CHECK((bench.answer[0] & 0x38U) == (bytes[0] & 0x38U));
    CHECK(std::equal(bytes.begin() + 40, bytes.begin() + 48, bench.answer.begin() + 24));
  }
}

TEST_CASE("each outcome has a name of its own") {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < ntp_outcomes; ++i) names.insert(name_of(static_cast<NtpOutcome>(i)));
  CHECK(names.size() == ntp_outcomes);
  CHECK(name_of(NtpOutcome::unsent) == "unsent");
}
