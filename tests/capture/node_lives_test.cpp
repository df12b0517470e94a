// SPDX-License-Identifier: Apache-2.0
// What tells nodes and their starts apart (the numbers are those of the list of faults that the
// clock's scenarios use too). What else goes wrong: node_faults_test.cpp.
#include "tests/capture/test_node.h"

#include "kinalign/capture/node_desk.h"

#include <doctest/doctest.h>

#include <array>
#include <map>

namespace kinalign {

namespace {

using Kind = NodeEvent::Kind;
using Verdict = NodeVerdict;

const LabKey lab{7};
const NodeAddress home = address_of(20), elsewhere = address_of(21);

}  // namespace

TEST_CASE("fault 2 reboot_same_id: a counter that begins anew is a new life, once it echoes") {
  TestDesk host(lab);
  TestNode node(7, 1, lab);
  for (int k = 0; k < 100; ++k) host.exchange(node, home, 0.1 * k);
  const BootKey first = host.exchange(node, home, 10.0).exchange->boot;
  node.reboot(1, host_s(10.5));
  CHECK(host.exchange(node, home, 10.6).verdict == Verdict::replayed);
  const NodeNews second = host.exchange(node, home, 10.7);
  REQUIRE(second.verdict == Verdict::accepted);
  CHECK(second.exchange->boot != first);
  CHECK((second.exchange->boot & 0xffff'ffffU) == 1);
  CHECK(host.events() == std::vector{Kind::joined, Kind::restarted});
  CHECK(is_warning(Kind::restarted));
}

TEST_CASE("fault 2 reboot_same_id: a new life that outlasts the one before is still one node") {
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
        const NodeNews news = host.exchange(node, home, 0.1 * k);
        if (news.exchange) ++frames[news.stream][news.exchange->boot];
      }
      CHECK(host.events() == std::vector{Kind::joined, Kind::restarted});
      REQUIRE(frames.size() == 1);
      CHECK(frames.begin()->second.size() == 1);
      CHECK(frames.begin()->second.begin()->second >= 298);  // the first is held
    }
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
  for (; k < 300; ++k) host.exchange(node, home, 0.1 * k);  // where the earlier life was
  CHECK(host.events() == std::vector{Kind::joined, Kind::restarted, Kind::moved});
  CHECK(host.count(Verdict::accepted) == 298);
}

TEST_CASE("fault 3 reboot_storm: ten starts in twenty seconds are ten lives of one stream") {
  TestDesk host(lab);
  TestNode node(7, 100, lab);
  std::map<BootKey, int> frames;
  std::size_t stream = 0;
  for (int k = 0; k < 300; ++k) {
    if (k % 30 == 0) node.reboot(100 + static_cast<unsigned>(k), host_s(k / 15.0));
    const NodeNews news = host.exchange(node, home, k / 15.0);
    if (news.verdict != Verdict::accepted) continue;
    ++frames[news.exchange->boot];
    stream = news.stream;
  }
  CHECK(frames.size() == 10);
  CHECK(host.desk.stream(stream).lives == 10);
  CHECK(host.count(Verdict::held) == 10);
}

TEST_CASE("fault 29 two_nodes_one_id: two streams and a warning, never merged") {
  TestDesk host(lab);
  TestNode a(7, 1, lab), b(7, 2, lab);
  b.offset_s += 100;
  std::map<BootKey, std::map<std::size_t, int>> frames;
  for (int k = 0; k < 60; ++k) {
    const NodeNews first = host.exchange(a, home, 0.1 * k);
    if (first.exchange) ++frames[first.exchange->boot][first.stream];
    if (k < 20) continue;
    const NodeNews second = host.exchange(b, elsewhere, 0.1 * k + 0.05);
    if (second.exchange) ++frames[second.exchange->boot][second.stream];
  }
  // b takes the place of a until a is heard again, which then has one of its own
  CHECK(host.events() == std::vector{Kind::joined, Kind::started, Kind::twins});
  CHECK(is_warning(Kind::twins));
  REQUIRE(frames.size() == 2);
  CHECK(frames[2].size() == 1);
  CHECK(frames[1].size() == 2);
  CHECK(host.count(Verdict::earlier_life) == 1);  // before it had heard what was answered since
}

TEST_CASE("fault 29 two_nodes_one_id: one boot id too, told apart by counter and address") {
  TestDesk host(lab);
  TestNode a(7, 1, lab), b(7, 1, lab);
  b.offset_s += 100;
  std::map<std::size_t, std::map<BootKey, int>> frames;
  for (int k = 0; k < 60; ++k) {
    const NodeNews first = host.exchange(a, home, 0.1 * k);
    const NodeNews second = host.exchange(b, elsewhere, 0.1 * k + 0.05);
    if (k < 10) continue;
    REQUIRE(first.verdict == Verdict::accepted);
    REQUIRE(second.verdict == Verdict::accepted);
    ++frames[first.stream][first.exchange->boot];
    ++frames[second.stream][second.exchange->boot];
  }
  CHECK(frames.size() == 2);
  for (const auto& [stream, boots] : frames) CHECK(boots.size() == 1);
}

TEST_CASE("fault 30 node_id_change: a new stream, with a note who it was") {
  TestDesk host(lab);
  TestNode seven(7, 1, lab), nine(9, 2, lab);
  for (int k = 0; k < 5; ++k) host.exchange(seven, home, 0.1 * k);
  for (int k = 20; k < 25; ++k) host.exchange(nine, home, 0.1 * k);
  const auto events = host.desk.take_events();
  REQUIRE(events.size() == 3);
  CHECK(events[2].kind == Kind::renamed);
  CHECK(events[2].node_id == 9);
  CHECK(events[2].other_id == 7);
  CHECK(events[2].stream != events[0].stream);
}

TEST_CASE("fault 31 address_change: the same life of the same stream") {
  TestDesk host(lab);
  TestNode node(7, 1, lab);
  host.exchange(node, home, 0.0);
  const NodeNews before = host.exchange(node, home, 0.1);
  const NodeNews after = host.exchange(node, elsewhere, 0.2);
  REQUIRE(after.verdict == Verdict::accepted);
  CHECK(after.stream == before.stream);
  CHECK(after.exchange->boot == before.exchange->boot);
  CHECK(host.events() == std::vector{Kind::joined, Kind::moved});
}

TEST_CASE("fault 32 late_node, node_leaves, node_returns: after ten minutes it is the same life") {
  TestDesk host(lab);
  TestNode node(7, 1, lab);
  host.exchange(node, home, 300.0);
  const BootKey life = host.exchange(node, home, 300.1).exchange->boot;
  host.desk.tick(host_s(305.0));
  host.desk.tick(host_s(311.0));
  host.desk.tick(host_s(320.0));
  const NodeNews back = host.exchange(node, home, 900.0);
  REQUIRE(back.verdict == Verdict::accepted);
  CHECK(back.exchange->boot == life);
  CHECK(host.events() == std::vector{Kind::joined, Kind::left, Kind::returned});
}

TEST_CASE("fault 40 ipv6_only, dual_stack_same_node: one stream") {
  TestDesk host(lab);
  TestNode node(7, 1, lab);
  NodeAddress six;
  six.host = {0xfd, 0, 0, 1};
  six.port = 4000;
  host.exchange(node, six, 0.0);
  const NodeNews before = host.exchange(node, six, 0.1);
  const NodeNews after = host.exchange(node, home, 0.2);
  CHECK(before.exchange->boot == after.exchange->boot);
  CHECK(before.stream == after.stream);
}

TEST_CASE("fault 12 replay: captures of former lives, sent on and on, keep no node out") {
  std::vector<std::array<Bytes, 2>> captured;  // of each life an early frame, and a late one
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
         ++i) {  // from its own host, which anybody can say
      const NodeAddress from{home.host, static_cast<std::uint16_t>(6000 + i)};
      host.take(captured[i][1], from, host_s(t));
      host.take(captured[i][0], from, host_s(t));
    }
    if (k < 100) continue;
    accepted += host.exchange(node, home, t + 0.02).verdict == Verdict::accepted ? 1 : 0;
  }
  CHECK(accepted > 450);  // of 500: it is in within two seconds
}

}  // namespace kinalign
