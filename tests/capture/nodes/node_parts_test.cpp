// SPDX-License-Identifier: Apache-2.0
// The parts of NodeResponder, each tested alone.
#include "tests/capture/test_node.h"

#include "kinalign/capture/nodes/node_responder.h"

#include <doctest/doctest.h>

namespace kinalign {

TEST_CASE("an answer table knows the last 256, each for the first time once") {
  AnswerTable table;
  GivenAnswer found;
  CHECK(table.find(0, 0, found) == EchoVerdict::unknown);
  for (std::uint32_t i = 0; i < 300; ++i) table.add({i - 100, i, {}, host_s(i), i});
  CHECK(table.find(199, 299, found) == EchoVerdict::taken);
  CHECK(found.t3 == host_s(299));
  CHECK(table.find(199, 299, found) == EchoVerdict::repeated);
  CHECK(table.find(199, 298, found) == EchoVerdict::unknown);
  CHECK(table.find(200, 300, found) == EchoVerdict::unknown);
  CHECK(table.find(199 - 255, 44, found) == EchoVerdict::taken);
  CHECK(table.find(199 - 256, 43, found) == EchoVerdict::stale);
}

TEST_CASE("the pace of answers: all up to 30 a second, then every second, third, …") {
  for (const int rate : {1, 15, 30, 31, 45, 60, 100, 200, 1000}) {
    CAPTURE(rate);
    AnswerPace pace;
    int answers = 0;
    for (int k = 0; k < 20 * rate; ++k) {
      const HostTime now = host_s(static_cast<double>(k) / rate);
      if (pace.ask(now) && k >= 10 * rate) ++answers;
    }
    CHECK(answers <= 10 * 30);
    CHECK(answers >= 10 * std::min(rate, 15));
    if (rate <= 30) CHECK(answers == 10 * rate);
  }
}

TEST_CASE("a counter of 32 bits is unwrapped only where its node counts in 32 bits") {
  NodeCounter counter;
  constexpr std::int64_t turn = std::int64_t{1} << 32;
  counter.take(turn - 1'000'000, host_s(0));
  CHECK(counter.unwrap(500, host_s(1)) == turn + 500);
  CHECK(counter.unwrap(500, host_s(100)) == 500);  // the number began anew
  CHECK(counter.unwrap(turn + 500, host_s(100)) == turn + 500);
  CHECK(NodeCounter::unwrap_before(turn - 200, turn + 500) == turn - 200);
  CHECK(NodeCounter::unwrap_before(400, turn + 500) == turn + 400);
}

TEST_CASE("64 nodes are kept, a 65th waits until one was silent for a minute") {
  TestDesk host;
  std::vector<TestNode> nodes;
  for (std::uint32_t i = 0; i < 65; ++i) nodes.emplace_back(i, 1);
  const auto from = [](std::uint32_t i) { return address_of(static_cast<std::uint8_t>(i)); };
  for (std::uint32_t i = 0; i < 64; ++i) {
    REQUIRE(host.exchange(nodes[i], from(i), 0.0).verdict == NodeVerdict::accepted);
  }
  host.events();
  CHECK(host.exchange(nodes[64], from(64), 1.0).verdict == NodeVerdict::no_room);
  CHECK(host.exchange(nodes[64], from(64), 1.1).verdict == NodeVerdict::no_room);
  CHECK(host.events() == std::vector{NodeEvent::Kind::too_many});  // reported only once in a while
  for (std::uint32_t i = 1; i < 64; ++i) host.exchange(nodes[i], from(i), 61.0);
  CHECK(host.exchange(nodes[64], from(64), 62.0).verdict == NodeVerdict::accepted);
}

TEST_CASE("a replay of many old starts leaves room for the true one") {
  const LabKey lab{};
  TestDesk host(lab);
  double t = 0.0;
  for (std::uint32_t boot = 100; boot < 2000; ++boot, t += 0.001) {
    TestNode old(7, boot, lab);
    CHECK(host.exchange(old, address_of(static_cast<std::uint8_t>(boot % 200), 1), t).verdict !=
          NodeVerdict::accepted);
  }
  TestNode node(7, 1, lab);
  for (; t < 5.0; t += 0.1) host.exchange(node, address_of(250), t);
  CHECK(host.exchange(node, address_of(250), t).verdict == NodeVerdict::accepted);
}

TEST_CASE("an unknown address starts eight sessions at once") {
  const LabKey lab{};
  TestDesk host(lab);
  for (std::uint32_t i = 0; i < 20; ++i) {
    TestNode node(i, 1, lab);
    host.take(node.frame(host_s(0)), address_of(9, static_cast<std::uint16_t>(i)), host_s(0));
  }
  CHECK(host.count(NodeVerdict::held) == 8);
  CHECK(host.count(NodeVerdict::limited) == 12);
}

TEST_CASE("a reply is shorter than the shortest frame and says whether the host is locked") {
  const LabKey lab{};
  TestDesk host(lab);
  TestNode node(7, 1, lab);
  host.exchange(node, address_of(1), 0.0);
  host.exchange(node, address_of(1), 0.1);
  CHECK_FALSE(node.locked);
  host.responder.set_locked(0, true);
  const Bytes frame = node.frame(host_s(0.2));
  host.take(frame, address_of(1), host_s(0.2));
  const Bytes reply = host.reply(host_s(0.2));
  CHECK(reply.size() < frame.size());
  CHECK(node.take_reply(reply, host_s(0.2)));
  CHECK(node.locked);
  CHECK(host.reply(host_s(0.2)).empty());  // one each
}

TEST_CASE("a clockless node: T2, T3 and T6 are the host's own, copies are only compared") {
  const std::array<std::optional<LabKey>, 2> both{std::nullopt, LabKey{}};
  for (const auto& lab : both) {
    TestDesk host(lab);
    std::optional<MacKey> key;
    if (lab) key = node_key(*lab, 7);
    const auto bytes = [&](const auto& datagram) {
      Bytes out(100);
      out.resize(encode(datagram, key ? &*key : nullptr, out).size());
      return out;
    };
    for (std::uint32_t k = 0; k < 4; ++k) {
      ClocklessRequest request;
      request.origin = {7, 1, k};
      const NodeMessage asked = host.take(bytes(request), address_of(1), host_s(k));
      CHECK(asked.verdict == (lab && k == 0 ? NodeVerdict::held : NodeVerdict::accepted));
      const Bytes answer = host.reply(host_s(k + 0.25));
      CHECK(answer.size() <= bytes(request).size());
      Envelope envelope;
      ClocklessAnswer given;
      REQUIRE(open_envelope(answer, envelope) == NodeRefusal::none);
      REQUIRE(decode(envelope, key ? &*key : nullptr, given) == NodeRefusal::none);
      ClocklessConfirm confirm{given.origin, given.times};
      if (k == 3) confirm.times.t3_ns += 1'000'000'000;
      const NodeMessage message = host.take(bytes(confirm), address_of(1), host_s(k + 0.5));
      REQUIRE(message.clockless);
      CHECK(message.clockless->t2 == host_s(k));
      CHECK(message.clockless->t3 == host_s(k + 0.25));
      CHECK(one_way_delay(*message.clockless) == std::chrono::milliseconds(125));
      CHECK(host.reply(host_s(k + 0.5)).empty());
      CHECK(host.take(bytes(confirm), address_of(1), host_s(k + 0.6)).verdict ==
            NodeVerdict::unknown_answer);
    }
    CHECK(host.responder.counts().wrong_copies == 1);
  }
}

}  // namespace kinalign
