// SPDX-License-Identifier: Apache-2.0
// Every fault that a node or a stranger can cause at NodeResponder (the numbers are those of
// docs/faults.md, which the clock's scenarios use too). Tests of who is who:
// node_sessions_test.cpp.
#include "tests/capture/test_node.h"

#include "kinalign/capture/nodes/node_responder.h"
#include "kinalign/clock/live/live_clock.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace kinalign {

namespace {

using Kind = NodeEvent::Kind;
using Verdict = NodeVerdict;

const LabKey lab = [] {
  LabKey key{};
  for (std::size_t i = 0; i < key.size(); ++i) key[i] = static_cast<std::uint8_t>(i);
  return key;
}();
const NodeAddress home = address_of(20), elsewhere = address_of(21);

/// Exchanges some seconds of frames at 15 frames/s, and gives those that were accepted; `beside` is
/// called after each frame.
template <class Beside>
std::vector<ClockStamp> stamps_with(TestDesk& host, TestNode& node, Beside beside) {
  LiveClock clock;
  std::vector<ClockStamp> stamps;
  for (int k = 0; k < 300; ++k) {
    const double t = k / 15.0;
    const Bytes frame = node.frame(host_s(t));
    const NodeMessage message = host.take(frame, home, host_s(t + 0.001));
    const Bytes reply = host.reply(host_s(t + 0.0011));
    if (!reply.empty()) node.take_reply(reply, host_s(t + 0.002));
    if (message.exchange) {
      clock.push(*message.exchange);
      if (auto stamp = clock.host_from_node(message.exchange->boot, message.exchange->n_tx)) {
        stamps.push_back(*stamp);
      }
    }
    beside(frame, t + 0.01);
  }
  return stamps;
}

bool same(const std::vector<ClockStamp>& a, const std::vector<ClockStamp>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.time == y.time && x.earliest == y.earliest && x.latest == y.latest &&
           x.certainty == y.certainty;
  });
}

}  // namespace

TEST_CASE("fault 6 counter_wrap32: a narrow counter is unwrapped through four hours") {
  TestDesk host(lab);
  TestNode node(7, 1, lab);
  node.narrow = true;
  node.offset_s = -86'400.0 + 3000.0;  // the first wrap comes after 21 min
  std::optional<NodeTime> last;
  bool rises = true, echoes_agree = true;
  for (int k = 0; k < 4 * 3600; ++k) {
    const NodeMessage message = host.exchange(node, home, k + 0.5);
    if (message.verdict != Verdict::accepted) continue;
    const Exchange& exchange = *message.exchange;
    if (last) rises &= std::abs(seconds(exchange.n_tx - *last) - 1.0) < 0.001;
    if (exchange.echo)
      echoes_agree &= std::abs(seconds(exchange.n_tx - exchange.echo->n_rx) - 0.998) < 0.001;
    last = exchange.n_tx;
  }
  CHECK(rises);
  CHECK(echoes_agree);
  CHECK(last->time_since_epoch() > std::chrono::hours(4));
  CHECK(host.count(EchoVerdict::future) == 0);
}

TEST_CASE("a counter that no node reaches in 31 years is refused") {
  for (const int bits : {49, 50}) {
    TestDesk host;
    TestNode node(7, 1);
    node.offset_s = -86'400.0 + std::ldexp(1e-6, bits);
    CHECK(host.exchange(node, home, 0.0).verdict ==
          (bits < 50 ? Verdict::accepted : Verdict::wrong_counter));
  }
}

TEST_CASE("fault 10 duplicate: counted, and the stamps are those of a clean run") {
  TestDesk clean(lab), twice(lab);
  TestNode a(7, 1, lab), b(7, 1, lab);
  const auto expected = stamps_with(clean, a, [](const Bytes&, double) {});
  const auto found = stamps_with(twice, b, [&](const Bytes& frame, double t) {
    CHECK(twice.take(frame, home, host_s(t)).verdict == Verdict::duplicate);
    CHECK(twice.reply(host_s(t)).empty());
  });
  CHECK(twice.count(Verdict::duplicate) == 300);
  CHECK(expected.size() > 290);
  CHECK(same(expected, found));
}

TEST_CASE("fault 11 reorder: frames 40 ms late are taken, each once") {
  TestDesk host(lab);
  TestNode node(7, 1, lab);
  for (int k = 0; k < 10; ++k) host.exchange(node, home, 0.02 * k);
  const Bytes early = node.frame(host_s(0.3)), late = node.frame(host_s(0.32));
  CHECK(host.take(late, home, host_s(0.33)).verdict == Verdict::accepted);
  const NodeMessage message = host.take(early, home, host_s(0.34));
  CHECK(message.verdict == Verdict::accepted);
  const NodeSession& session = host.responder.session_of(host.responder.stream(message.stream));
  CHECK(static_cast<std::int64_t>(message.frame) + 1 == session.sequences.newest());
  CHECK(host.take(early, home, host_s(0.35)).verdict == Verdict::duplicate);
}

TEST_CASE("fault 12 replay: a capture of this run, and one of an earlier run, move nothing") {
  TestDesk clean(lab), attacked(lab);
  TestNode a(7, 1, lab), b(7, 1, lab), yesterday(7, 99, lab);
  const auto expected = stamps_with(clean, a, [](const Bytes&, double) {});
  std::vector<Bytes> capture;
  yesterday.echo() = ReplyEcho{3, 0xdeadbeef, 1000};
  const auto found = stamps_with(attacked, b, [&](const Bytes& frame, double t) {
    capture.push_back(frame);
    // The old frames also come from the node's own address.
    const NodeAddress from = t < 10 ? elsewhere : home;
    const Verdict old = attacked.take(capture[capture.size() / 2], from, host_s(t)).verdict;
    CHECK(old != Verdict::accepted);
    CHECK(attacked.take(yesterday.frame(host_s(t)), from, host_s(t)).verdict != Verdict::accepted);
  });
  CHECK(same(expected, found));
  CHECK(attacked.count(Verdict::held) > 0);
  CHECK(attacked.count(Verdict::accepted) == clean.count(Verdict::accepted));
}

TEST_CASE("fault 24 falseticker: what is no reply of ours is no reply to the node") {
  TestDesk host(lab);
  TestNode node(7, 1, lab);
  host.exchange(node, home, 0.0);
  // The node's own frame, sent back to it.
  CHECK_FALSE(node.take_reply(node.frame(host_s(0.1)), host_s(0.1)));
  host.take(node.frame(host_s(0.2)), home, host_s(0.2));
  Bytes forged = host.reply(host_s(0.2));
  forged[35] ^= 1;  // h_tx
  CHECK_FALSE(node.take_reply(forged, host_s(0.2)));
}

TEST_CASE("fault 25 spoofed_frame: no MAC, a wrong one, another node's: each by its cause") {
  LabKey other = lab;
  other[0] ^= 1;
  const MacKey eight = node_key(lab, 8);
  TestDesk host(lab), open;
  TestNode bare(7, 1), wrong(7, 1, other), posing(7, 1);
  posing.set_key(eight);  // a correct MAC of another node
  // The frames are also wrong in the points that are checked after the MAC: the counter is beyond
  // any real one, and the sender is another. They must still be refused because of the MAC.
  for (TestNode* node : {&bare, &wrong, &posing}) node->offset_s = 1e11;
  const auto refused_as = [](TestDesk& responder, TestNode& node, NodeRefusal refusal) {
    const std::uint64_t before = responder.count(refusal);
    CHECK(responder.take(node.frame(host_s(0)), home, host_s(0)).verdict == Verdict::refused);
    CHECK(responder.reply(host_s(0)).empty());
    return responder.count(refusal) == before + 1;
  };
  CHECK(refused_as(host, bare, NodeRefusal::no_mac));
  CHECK(refused_as(host, wrong, NodeRefusal::wrong_mac));
  CHECK(refused_as(host, posing, NodeRefusal::wrong_mac));
  CHECK(refused_as(open, wrong, NodeRefusal::no_key));
  TestNode own(8, 1, lab);
  Bytes renamed = own.frame(host_s(0));  // only the number was changed
  renamed[11] = 7;
  CHECK(host.take(renamed, home, host_s(0)).verdict == Verdict::refused);
  CHECK(host.count(NodeRefusal::bad_crc) == 1);
  // They are dropped before they are parsed further: they are counted as refused, and no sender is
  // held or known.
  CHECK(host.count(Verdict::refused) == 4);
  CHECK(host.responder.counts().verdicts.total() == 4);
  CHECK_FALSE(host.responder.stream(0).used);
  CHECK(host.events() == std::vector{Kind::wrong_key});  // one a second
}

TEST_CASE(
    "fault 25 spoofed_frame: a node with a wrong key is reported, a flood only now and then") {
  TestDesk host(lab);
  LabKey other = lab;
  other[0] ^= 1;
  TestNode wrong(7, 1, other), bare(8, 1);
  for (int k = 0; k < 700; ++k) host.take(wrong.frame(host_s(0.1 * k)), home, host_s(0.1 * k));
  auto events = host.responder.take_events();
  REQUIRE(events.size() == 1);  // one in ten minutes
  CHECK(events[0].kind == Kind::wrong_key);
  CHECK(events[0].node_id == 7);
  CHECK(events[0].address == home);
  CHECK(events[0].refusal == NodeRefusal::wrong_mac);
  for (int k = 700; k < 900; ++k)
    host.take(bare.frame(host_s(0.1 * k)), elsewhere, host_s(0.1 * k));
  events = host.responder.take_events();
  REQUIRE(events.size() == 1);  // at 70 s
  CHECK(events[0].node_id == 8);
  CHECK(events[0].refusal == NodeRefusal::no_mac);
  for (std::uint32_t id = 0; id < 10'000; ++id) {
    const HostTime at = host_s(90.0 + 0.002 * id);
    host.take(TestNode(id, 1, other).frame(at), home, at);
  }
  CHECK(host.responder.take_events().size() == 2);
}

TEST_CASE("fault 28 flood_strangers: 50,000 packets a second take nothing from five nodes") {
  // Ten seconds of a flood from 10,000 addresses: frames without a MAC, with a wrong one, and
  // frames that nodes sent in earlier runs, whose MAC is correct.
  LabKey other = lab;
  other[0] ^= 1;
  std::vector<Bytes> sent;
  for (std::uint32_t i = 0; i < 48; ++i) {
    sent.push_back(TestNode(1 + i % 8, 100 + i).frame(host_s(0.0)));
    sent.push_back(TestNode(1 + i % 8, 100 + i, other).frame(host_s(0.0)));
    sent.push_back(TestNode(1 + i % 8, 100 + i, lab).frame(host_s(0.0)));
  }
  const auto served = [&](std::size_t strangers_each) {
    TestDesk host(lab);
    std::vector<TestNode> nodes;
    std::vector<LiveClock> clocks(5);
    for (std::uint32_t id = 1; id <= 5; ++id) nodes.emplace_back(id, id, lab);
    std::vector<ClockStamp> stamps;
    std::size_t flood = 0;
    for (int k = 0; k < 1100; ++k) {
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const double t = 0.01 * k + 0.002 * static_cast<double>(i);
        const NodeAddress from = address_of(static_cast<std::uint8_t>(20 + i));
        const NodeMessage message = host.exchange(nodes[i], from, t);
        CHECK(message.exchange.has_value() == (k > 0));  // the first is held
        if (message.exchange) {
          clocks[i].push(*message.exchange);
          const auto stamp =
              clocks[i].host_from_node(message.exchange->boot, message.exchange->n_tx);
          if (stamp) stamps.push_back(*stamp);
        }
        for (std::size_t s = 0; k >= 100 && s < strangers_each; ++s, ++flood) {
          const std::size_t who = flood % 10'000;
          const NodeAddress stranger{
              mapped_ipv4(std::array<std::uint8_t, 4>{10, 1, static_cast<std::uint8_t>(who / 250),
                                                      static_cast<std::uint8_t>(who % 250)}),
              static_cast<std::uint16_t>(1024 + flood % 50'000)};
          host.take(sent[flood % sent.size()], stranger, host_s(t + 0.0019));
          host.reply(host_s(t + 0.0019));
        }
      }
    }
    CHECK(flood == 5000 * strangers_each);
    return stamps;
  };
  const auto clean = served(0), flooded = served(100);
  CHECK(clean.size() > 5 * 1090);
  CHECK(same(clean, flooded));  // the error of each frame and echo is the same as without the fault
}

TEST_CASE("fault 33 echo_stale, echo_unknown: the echo is left out, the frame is kept") {
  TestDesk host(lab);
  TestNode node(7, 1, lab);
  host.exchange(node, home, 0.0);
  host.exchange(node, home, 0.1);
  const ReplyEcho first = *node.echo();
  for (int k = 2; k < 300; ++k) host.exchange(node, home, 0.1 * k);
  node.echo() = first;
  NodeMessage message = host.take(node.frame(host_s(30.0)), home, host_s(30.0));
  CHECK(message.verdict == Verdict::accepted);
  CHECK_FALSE(message.exchange->echo);
  CHECK(host.count(EchoVerdict::stale) == 1);
  node.echo() = ReplyEcho{100'000, 1, 1};
  message = host.take(node.frame(host_s(30.1)), home, host_s(30.1));
  CHECK(message.verdict == Verdict::accepted);
  node.echo() = ReplyEcho{298, 1, 1};  // the echo that was given, with another nonce
  message = host.take(node.frame(host_s(30.2)), home, host_s(30.2));
  CHECK_FALSE(message.exchange->echo);
  CHECK(host.count(EchoVerdict::unknown) == 2);
}

TEST_CASE("fault 34 echo_future: n_rx behind n_tx is left out and counted") {
  TestDesk host(lab);
  TestNode node(7, 1, lab);
  host.exchange(node, home, 0.0);
  host.exchange(node, home, 0.1);
  for (const std::uint64_t later : {std::uint64_t{1}, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
    node.echo()->n_rx_us =
        later == ~std::uint64_t{0} ? later : node.counter_us(host_s(0.2)) + later;
    const NodeMessage message = host.take(node.frame(host_s(0.2)), home, host_s(0.2));
    CHECK(message.verdict == Verdict::accepted);
    CHECK_FALSE(message.exchange->echo);
  }
  CHECK(host.count(EchoVerdict::future) == 3);
}

TEST_CASE("fault 35 bad_crc, truncated, unknown_newer_version: counted, and the version reported") {
  TestDesk host(lab);
  TestNode node(7, 1, lab);
  const Bytes frame = node.frame(host_s(0));
  Bytes damaged = frame, cut = frame, newer = frame;
  damaged[30] ^= 1;
  cut.pop_back();
  newer[4] = 3;
  for (const Bytes& bytes : {damaged, cut, newer, Bytes(27), Bytes(60)}) {
    CHECK(host.take(bytes, home, host_s(0)).verdict == Verdict::refused);
    CHECK(host.reply(host_s(0)).empty());
  }
  CHECK(host.count(NodeRefusal::bad_crc) == 1);
  CHECK(host.count(NodeRefusal::wrong_length) == 1);
  CHECK(host.count(NodeRefusal::unknown_version) == 1);
  CHECK(host.count(NodeRefusal::too_short) == 1);
  CHECK(host.count(NodeRefusal::bad_magic) == 1);
  const auto events = host.responder.take_events();
  REQUIRE(events.size() == 1);
  CHECK(events[0].kind == Kind::newer_version);
  CHECK(events[0].version == 3);
}

TEST_CASE("fault 36 sample_batch: each sample has its own counter, the exchange n_tx alone") {
  TestDesk host(lab);
  TestNode node(7, 1, lab);
  for (std::uint32_t i = 0; i < 10; ++i) {
    node.samples.emplace_back().age_us = 45'000 - 5000 * i;
  }
  host.exchange(node, home, 0.0);
  const NodeMessage message = host.exchange(node, home, 0.1);
  REQUIRE(message.readings.size() == 10);
  const NodeTime n_tx = message.exchange->n_tx;
  CHECK(n_tx == node_time(static_cast<std::int64_t>(node.counter_us(host_s(0.1)))));
  for (int i = 0; i < 10; ++i) {
    CHECK(n_tx - message.readings[static_cast<std::size_t>(i)].n ==
          std::chrono::milliseconds(45 - 5 * i));
  }
}

TEST_CASE("fault 37 firmware_overload: a sample sent 50 ms late is stamped when it was taken") {
  TestDesk host(lab), prompt_host(lab);
  TestNode node(7, 1, lab), prompt(7, 1, lab);
  node.samples.emplace_back().age_us = 50'000;
  prompt.samples.emplace_back();
  LiveClock clock, prompt_clock;
  const auto stamp_of = [](TestDesk& responder, TestNode& from, LiveClock& of, double t) {
    const NodeMessage message = responder.exchange(from, home, t);
    // The first frame is held, because the node has a key.
    if (!message.exchange) return std::optional<ClockStamp>();
    of.push(*message.exchange);
    return of.host_from_node(message.exchange->boot, message.readings[0].n);
  };
  for (int k = 0; k < 100; ++k) {
    const double t = k / 15.0;
    const auto late = stamp_of(host, node, clock, t);
    const auto at_once = stamp_of(prompt_host, prompt, prompt_clock, t);
    if (k < 3) continue;
    REQUIRE(late);
    const HostTime taken = host_s(t - 0.05);
    CHECK(late->certainty == Certainty::certified);
    CHECK(*late->earliest <= taken);
    CHECK(*late->latest >= taken);
    CHECK(std::chrono::abs(late->time - taken) < std::chrono::microseconds(100));
    const Duration width = *late->latest - *late->earliest;
    const Duration usual = *at_once->latest - *at_once->earliest;
    CHECK(std::chrono::abs(width - usual) < std::chrono::microseconds(10));  // 100 ppm of 50 ms
  }
}

TEST_CASE("fault 38 nan_inf_sample, zero_quaternion: kept as they are, marked, stamped") {
  TestDesk host(lab);
  TestNode node(7, 1, lab);
  NodeSample bad;
  bad.age_us = 100;
  bad.has_acceleration = bad.has_orientation = true;
  bad.acceleration = {std::numeric_limits<float>::quiet_NaN(), 0, INFINITY};
  node.samples = {bad};
  host.exchange(node, home, 0.0);
  const NodeMessage message = host.exchange(node, home, 0.1);
  REQUIRE(message.readings.size() == 1);
  CHECK(message.readings[0].faults.not_finite);
  CHECK(message.readings[0].faults.zero_orientation);
  CHECK(std::isnan(message.readings[0].sample.acceleration[0]));
  CHECK(message.exchange->n_tx - message.readings[0].n == std::chrono::microseconds(100));
}

TEST_CASE("fault 39 mac_key_rotation: the old key is good for 60 s, then not") {
  LabKey next = lab;
  next[31] ^= 1;
  TestDesk host(lab);
  TestNode node(7, 1, lab);
  host.exchange(node, home, 0.0);
  host.exchange(node, home, 0.1);
  host.responder.replace_key(next, host_s(1.0));
  node.drop_echo();
  CHECK(host.exchange(node, home, 2.0).verdict == Verdict::accepted);
  CHECK(node.echo());  // the node took the reply, which was sealed with the node's own key
  CHECK(host.responder.session_of(host.responder.stream(0)).old_key);
  CHECK(host.exchange(node, home, 60.9).verdict == Verdict::accepted);
  CHECK(host.responder.counts().old_key == 2);
  CHECK(host.exchange(node, home, 61.1).verdict == Verdict::refused);
  CHECK(host.count(NodeRefusal::wrong_mac) == 1);
  node.set_key(next);
  CHECK(host.exchange(node, home, 61.2).verdict == Verdict::accepted);
}

}  // namespace kinalign
