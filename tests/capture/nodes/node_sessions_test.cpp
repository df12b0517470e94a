// SPDX-License-Identifier: Apache-2.0
// How nodes and their starts are told apart (numbers as in docs/faults.md). Tests of other faults:
// node_faults_test.cpp.
#include "tests/capture/test_node.h"

#include "kinalign/capture/nodes/node_responder.h"
#include "kinalign/capture/nodes/node_table.h"
#include "kinalign/clock/live/live_clock.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>

namespace kinalign {

namespace {

using Kind = NodeEvent::Kind;
using Verdict = NodeVerdict;

const LabKey lab{7};
const NodeAddress home = address_of(20), elsewhere = address_of(21);

}  // namespace

TEST_CASE("fault 2 reboot_same_id: a counter that restarts is a new session, once it echoes") {
  TestDesk host(lab);
  TestNode node(7, 1, lab);
  for (int k = 0; k < 100; ++k) host.exchange(node, home, 0.1 * k);
  const BootKey first = host.exchange(node, home, 10.0).exchange->boot;
  node.reboot(1, host_s(10.5));
  CHECK(host.exchange(node, home, 10.6).verdict == Verdict::replayed);
  const NodeMessage second = host.exchange(node, home, 10.7);
  REQUIRE(second.verdict == Verdict::accepted);
  CHECK(second.exchange->boot != first);
  CHECK((second.exchange->boot & 0xffff'ffffU) == 1);
  CHECK(host.events() == std::vector{Kind::joined, Kind::restarted});
  CHECK(is_warning(Kind::restarted));
}

TEST_CASE("fault 2 reboot_same_id: a new session longer than the previous one is still one node") {
  for (const auto& key : {std::optional(lab), std::optional<LabKey>()}) {
    for (const double back_s : {15.0, 1.5}) {  // all of its counter, or a step of it
      CAPTURE(key.has_value());
      CAPTURE(back_s);
      TestDesk host(key);
      TestNode node(7, 1, key);
      int k = 0;
      for (; k < 100; ++k) host.exchange(node, home, 0.1 * k);
      if (back_s > 10) node.reboot(1, host_s(10.0));
      if (back_s < 10) node.offset_s -= back_s;
      std::map<std::size_t, std::map<BootKey, int>> frames;
      for (; k < 400; ++k) {
        const NodeMessage message = host.exchange(node, home, 0.1 * k);
        if (message.exchange) ++frames[message.stream][message.exchange->boot];
      }
      CHECK(host.events() == std::vector{Kind::joined, Kind::restarted});
      REQUIRE(frames.size() == 1);
      CHECK(frames.begin()->second.size() == 1);
      CHECK(frames.begin()->second.begin()->second >= 298);  // the first frame is held
    }
  }
}

TEST_CASE("fault 2 reboot_same_id: a counter that may have wrapped is recognised by its numbers") {
  for (const double uptime_s : {4265.0, 4280.0, 4294.0, 4296.0, 8589.9, 8591.0}) {
    CAPTURE(uptime_s);
    TestDesk host(lab);
    TestNode node(7, 1, lab);
    node.offset_s = -86'400.0 + uptime_s - 10.0;
    for (int k = 0; k < 100; ++k) host.exchange(node, home, 0.1 * k);
    node.reboot(1, host_s(10.0));
    int taken = 0;
    for (int k = 0; k < 100; ++k) {
      taken += host.exchange(node, home, 10.1 + 0.1 * k).verdict == Verdict::accepted ? 1 : 0;
    }
    CHECK(taken >= 80);  // a frame that seems to be at most a second old counts as a duplicate
    CHECK(host.events() == std::vector{Kind::joined, Kind::restarted});
  }
}

TEST_CASE("fault 2 reboot_same_id: nor do its other ports make two nodes of it") {
  TestDesk host(lab);
  TestNode node(7, 1, lab);
  const NodeAddress other_port = address_of(20, 4001);
  int k = 0;
  for (; k < 100; ++k) host.exchange(node, home, 0.1 * k);
  node.reboot(1, host_s(10.0));
  for (; k < 250; ++k) host.exchange(node, other_port, 0.1 * k);
  for (; k < 300; ++k) host.exchange(node, home, 0.1 * k);  // the address of the earlier session
  CHECK(host.events() == std::vector{Kind::joined, Kind::restarted, Kind::moved});
  CHECK(host.count(Verdict::accepted) == 298);
}

TEST_CASE("fault 3 reboot_storm: ten starts in twenty seconds are ten sessions of one stream") {
  TestDesk host(lab);
  TestNode node(7, 100, lab);
  std::map<BootKey, int> frames;
  std::size_t stream = 0;
  for (int k = 0; k < 300; ++k) {
    if (k % 30 == 0) node.reboot(100 + static_cast<unsigned>(k), host_s(k / 15.0));
    const NodeMessage message = host.exchange(node, home, k / 15.0);
    if (message.verdict != Verdict::accepted) continue;
    ++frames[message.exchange->boot];
    stream = message.stream;
  }
  CHECK(frames.size() == 10);
  CHECK(host.responder.stream(stream).sessions == 10);
  CHECK(host.count(Verdict::held) == 10);
}

TEST_CASE("replies go where the newest frame came from, not where a late one did") {
  TestDesk host;
  TestNode node(7, 1);
  for (int k = 0; k < 20; ++k) host.exchange(node, home, 0.1 * k);
  const Bytes late = node.frame(host_s(2.0));
  host.exchange(node, elsewhere, 2.1);
  CHECK(host.take(late, home, host_s(2.11)).verdict == Verdict::accepted);
  CHECK(host.responder.session_of(host.responder.stream(0)).address == elsewhere);
}

TEST_CASE("four starts of a node without echoes are held, each for at least a second") {
  NodeTable table;
  const auto start = [](std::uint32_t node, std::uint32_t boot, double t) {
    return NodeSign{node,      boot, address_of(20, static_cast<std::uint16_t>(4000 + boot)),
                    host_s(t), 0,    1000};
  };
  for (std::uint32_t boot = 1; boot <= 4; ++boot) REQUIRE(table.hold(start(7, boot, 0.1 * boot)));
  CHECK(table.hold(start(7, 5, 0.5)) == nullptr);
  CHECK(table.hold(start(7, 5, 1.09)) == nullptr);
  CHECK(table.hold(start(8, 1, 1.09)) != nullptr);  // another node has a stream of its own
  CHECK(table.hold(start(7, 5, 1.11)) != nullptr);
  CHECK(table.session_of(start(7, 1, 1.11)) == nullptr);  // the oldest stream was given up for it
  for (std::uint32_t boot = 2; boot <= 5; ++boot) CHECK(table.session_of(start(7, boot, 1.11)));
}

TEST_CASE("fault 29 two_nodes_one_id: two streams and a warning, never merged") {
  // Two nodes with one number are told apart by their boot id, or if that is the same, too, by
  // counter and address.
  for (const std::uint32_t boot_of_b : {2U, 1U}) {
    CAPTURE(boot_of_b);
    TestDesk host(lab);
    TestNode a(7, 1, lab), b(7, boot_of_b, lab);
    b.offset_s += 100;
    std::map<BootKey, std::string> of_boot;  // the nodes whose frames had each boot key
    std::map<std::size_t, std::string> of_stream;
    std::map<std::size_t, LiveClock> clocks;
    std::vector<NodeEvent> events;
    int taken = 0;
    const auto exchange = [&](TestNode& node, char name, const NodeAddress& from, double t) {
      const NodeMessage message = host.exchange(node, from, t);
      for (const NodeEvent& event : host.responder.take_events()) events.push_back(event);
      if (!message.exchange) return;
      ++taken;
      std::string& boot = of_boot[message.exchange->boot];
      if (boot.find(name) == std::string::npos) boot += name;
      std::string& stream = of_stream[message.stream];
      if (t >= 4.0 && stream.find(name) == std::string::npos) stream += name;
      LiveClock& clock = clocks[message.stream];
      clock.push(*message.exchange);
      if (t < 4.0) return;
      const auto stamp = clock.host_from_node(message.exchange->boot, message.exchange->n_tx);
      REQUIRE(stamp);
      CHECK(stamp->certainty == Certainty::certified);
      CHECK(std::chrono::abs(stamp->time - host_s(t)) < std::chrono::milliseconds(1));
    };
    for (int k = 0; k < 100; ++k) {
      exchange(a, 'a', home, 0.1 * k);
      if (k >= 20) exchange(b, 'b', elsewhere, 0.1 * k + 0.05);
    }
    for (const auto& [boot, nodes] : of_boot) CHECK(nodes.size() == 1);
    int of_a = 0, of_b = 0;  // each has a stream once both were heard for two seconds
    for (const auto& [stream, nodes] : of_stream) {
      of_a += nodes == "a" ? 1 : 0;
      of_b += nodes == "b" ? 1 : 0;
      CHECK(nodes.size() <= 1);
    }
    CHECK(of_a == 1);
    CHECK(of_b == 1);
    CHECK(taken >= 180 - 3);  // each is held at first, and one frame is of an earlier session
    // Node b takes the place of node a until a is heard again; then a gets a stream of its own.
    std::vector<Kind> kinds;
    for (const NodeEvent& event : events) kinds.push_back(event.kind);
    CHECK(kinds ==
          std::vector{Kind::joined, boot_of_b == 1 ? Kind::restarted : Kind::started, Kind::twins});
    CHECK(is_warning(Kind::twins));
    CHECK(host.count(Verdict::earlier_session) ==
          1);  // before it had received the answers since then
    for (auto& [stream, clock] : clocks) {
      for (const ClockEvent& event : clock.take_events()) {
        // No clock got a counter value of the other node.
        CHECK(event.kind == ClockEvent::Kind::new_boot);
      }
    }
  }
}

TEST_CASE("fault 30 node_id_change: a new stream, with a note about the earlier id") {
  TestDesk host(lab);
  TestNode seven(7, 1, lab), nine(9, 2, lab);
  for (int k = 0; k < 5; ++k) host.exchange(seven, home, 0.1 * k);
  for (int k = 20; k < 25; ++k) host.exchange(nine, home, 0.1 * k);
  const auto events = host.responder.take_events();
  REQUIRE(events.size() == 3);
  CHECK(events[2].kind == Kind::renamed);
  CHECK(events[2].node_id == 9);
  CHECK(events[2].other_id == 7);
  CHECK(events[2].stream != events[0].stream);
}

TEST_CASE("fault 31 address_change: the same session of the same stream") {
  TestDesk host(lab);
  TestNode node(7, 1, lab);
  host.exchange(node, home, 0.0);
  const NodeMessage before = host.exchange(node, home, 0.1);
  const NodeMessage after = host.exchange(node, elsewhere, 0.2);
  REQUIRE(after.verdict == Verdict::accepted);
  CHECK(after.stream == before.stream);
  CHECK(after.exchange->boot == before.exchange->boot);
  CHECK(host.events() == std::vector{Kind::joined, Kind::moved});
}

TEST_CASE("fault 31 address_change: the rate limit follows, that of a node and that of strangers") {
  const auto answers_of = [](bool moves) {
    TestDesk host(lab);
    TestNode node(7, 1, lab);
    for (int k = 0; k < 500; ++k) {
      host.exchange(node, moves && k / 5 % 2 == 1 ? elsewhere : home, 0.01 * k);
    }
    CHECK(host.count(Verdict::accepted) == 499);
    return host.responder.counts().answers;
  };
  // A node that moves has the rate limit of one node, 30 a second.
  CHECK(answers_of(true) == answers_of(false));
  CHECK(answers_of(true) <= 5 * 30);

  TestDesk host(lab);
  TestNode node(7, 1, lab);
  for (int k = 0; k < 5; ++k) host.exchange(node, home, 0.1 * k);
  Verdict of_stranger = Verdict::held;
  // Frames of new starts use up the address's allowed answers.
  for (std::uint32_t boot = 2; boot < 20; ++boot) {
    of_stranger =
        host.take(TestNode(8, boot, lab).frame(host_s(0.5)), elsewhere, host_s(0.5)).verdict;
  }
  CHECK(of_stranger == Verdict::limited);
  CHECK(host.exchange(node, elsewhere, 0.6).verdict == Verdict::accepted);
  // A new node at the address of a known node is not treated as a stranger.
  TestNode begins(9, 1, lab);
  CHECK(host.exchange(begins, elsewhere, 0.7).verdict == Verdict::held);
  CHECK(host.exchange(begins, elsewhere, 0.8).verdict == Verdict::accepted);
}

TEST_CASE(
    "fault 32 late_node, node_leaves, node_returns: after ten minutes it is the same session") {
  TestDesk host(lab);
  TestNode node(7, 1, lab);
  host.exchange(node, home, 300.0);
  const BootKey session = host.exchange(node, home, 300.1).exchange->boot;
  host.responder.tick(host_s(305.0));
  host.responder.tick(host_s(311.0));
  host.responder.tick(host_s(320.0));
  const NodeMessage back = host.exchange(node, home, 900.0);
  REQUIRE(back.verdict == Verdict::accepted);
  CHECK(back.exchange->boot == session);
  CHECK(host.events() == std::vector{Kind::joined, Kind::left, Kind::returned});
}

TEST_CASE("fault 32 node_returns: the same piece if its counter agrees within 100 ppm of the gap") {
  // 100 ppm of ten minutes are 60 ms. The node's crystal is 20 ppm off, and the clock has learnt
  // that.
  for (const double wrong_s : {0.0, 0.1, -0.1}) {
    CAPTURE(wrong_s);
    TestDesk host(lab);
    TestNode node(7, 1, lab);
    LiveClock clock;
    const auto exchange = [&](double t) {
      const NodeMessage message = host.exchange(node, home, t);
      if (!message.exchange) return std::optional<ClockStamp>();
      clock.push(*message.exchange);
      return clock.host_from_node(message.exchange->boot, message.exchange->n_tx);
    };
    for (int k = 0; k < 600; ++k) exchange(0.1 * k);
    const ClockOrigin piece = clock.piece()->origin();
    static_cast<void>(clock.take_events());
    host.responder.tick(host_s(300.0));
    node.offset_s += wrong_s;
    const auto first = exchange(660.0);
    REQUIRE(first);
    for (int k = 1; k < 200; ++k) exchange(660.0 + 0.1 * k);
    CHECK(host.events() == std::vector{Kind::joined, Kind::left, Kind::returned});
    CHECK(host.count(Verdict::held) == 1);
    const auto events = clock.take_events();
    if (wrong_s == 0.0) {
      // Its floors are known from ten minutes ago, so the only events are that they are measured
      // anew.
      for (const ClockEvent& event : events) CHECK(event.kind == ClockEvent::Kind::route);
      CHECK(clock.piece()->origin().node == piece.node);
      CHECK(first->certainty == Certainty::certified);
      CHECK(*first->earliest <= host_s(660.0));
      CHECK(*first->latest >= host_s(660.0));
      CHECK(*first->latest - *first->earliest < std::chrono::milliseconds(62));
    } else {
      CHECK(std::count_if(events.begin(), events.end(), [](const ClockEvent& event) {
              return event.kind == ClockEvent::Kind::step;
            }) == 1);
      CHECK(clock.piece()->origin().node != piece.node);
    }
    const auto last = exchange(680.0);
    CHECK(last->certainty == Certainty::certified);
    CHECK(*last->earliest <= host_s(680.0));
    CHECK(*last->latest >= host_s(680.0));
  }
}

TEST_CASE("fault 32 node_returns: with another boot id it is another session") {
  TestDesk host(lab);
  TestNode node(7, 1, lab);
  for (int k = 0; k < 10; ++k) host.exchange(node, home, 0.1 * k);
  host.responder.tick(host_s(300.0));
  node.reboot(2, host_s(600.0));
  CHECK(host.exchange(node, home, 601.0).verdict == Verdict::held);
  const NodeMessage back = host.exchange(node, home, 601.1);
  REQUIRE(back.verdict == Verdict::accepted);
  CHECK(back.exchange->boot == 2);
  CHECK(host.responder.stream(back.stream).sessions == 2);
}

TEST_CASE("fault 40 ipv6_only, dual_stack_same_node: one stream") {
  TestDesk host(lab);
  TestNode node(7, 1, lab);
  NodeAddress six;
  six.host = {0xfd, 0, 0, 1};
  six.port = 4000;
  host.exchange(node, six, 0.0);
  const NodeMessage before = host.exchange(node, six, 0.1);
  const NodeMessage after = host.exchange(node, home, 0.2);
  CHECK(before.exchange->boot == after.exchange->boot);
  CHECK(before.stream == after.stream);
}

TEST_CASE("fault 12 replay: captures of earlier sessions, sent on and on, keep no node out") {
  std::vector<std::array<Bytes, 2>> captured;  // for each session an early frame and a late one
  for (std::uint32_t boot = 1; boot <= 4; ++boot) {
    TestNode node(7, boot, lab);
    captured.push_back({node.frame(host_s(1.0)), node.frame(host_s(31.0))});
  }
  TestDesk host(lab);
  TestNode node(7, 55, lab);
  for (int k = 0; k < 100; ++k) host.exchange(node, home, 100.0 + 0.05 * k);
  node.reboot(56, host_s(105.0));
  int accepted = 0;
  for (int k = 0; k < 600; ++k) {
    const double t = 105.0 + 0.05 * k;
    for (std::uint8_t i = 0; i < captured.size();
         ++i) {  // the address is the node's own, which anybody can forge
      const NodeAddress from{home.host, static_cast<std::uint16_t>(6000 + i)};
      host.take(captured[i][1], from, host_s(t));
      host.take(captured[i][0], from, host_s(t));
    }
    if (k < 100) continue;
    accepted += host.exchange(node, home, t + 0.02).verdict == Verdict::accepted ? 1 : 0;
  }
  CHECK(accepted > 450);  // 500 frames were sent: the node is accepted within two seconds
}

}  // namespace kinalign
