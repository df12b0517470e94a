// SPDX-License-Identifier: Apache-2.0
// A node's handling of arriving datagrams, and of a link that fails.
#include "tests/firmware/bench.h"

using namespace kinalign;

namespace {

NodeSettings keyed() {
  NodeSettings with = settings;
  with.has_key = true;
  with.key = node_key;
  return with;
}

/// Gives the node a datagram now.
void arrive(Bench& bench, Bytes datagram) {
  bench.board.arriving.push_back(std::move(datagram));
  bench.node.poll();
}

std::uint64_t refused(Bench& bench, NodeRefusal why) {
  return bench.node.counts().replies.refused[static_cast<std::size_t>(why)];
}

}  // namespace

TEST_CASE("the next frame echoes a reply, with the counter read first when it had arrived") {
  Bench bench;
  bench.run(60'000);
  bench.board.arriving.push_back(reply_to(bench.last(), 900));
  bench.board.calls.clear();
  const std::uint64_t arrived = bench.board.now_us;
  bench.node.poll();
  CHECK(bench.board.calls.substr(0, 2) == "rc");
  bench.run(100'000);
  CHECK(bench.last().has_echo);
  CHECK(bench.last().echo == ReplyEcho{900, 0xbeef0000 + 900, arrived + 1});
  bench.run(100'000);
  CHECK(!bench.last().has_echo);  // each reply is echoed once
}

TEST_CASE("the newest of several replies is echoed") {
  Bench bench;
  bench.run(360'000);
  arrive(bench, reply_to(bench.frame(1), 900));
  arrive(bench, reply_to(bench.frame(2), 901));
  arrive(bench, reply_to(bench.frame(0), 899));
  bench.run(100'000);
  CHECK(bench.last().echo.reply_sequence == 901);
  CHECK(bench.node.counts().replies.not_newer == 1);
}

TEST_CASE("a reply that comes back a second time is ignored") {
  Bench bench;
  bench.run(60'000);
  const Bytes reply = reply_to(bench.last(), 900);
  arrive(bench, reply);
  bench.run(100'000);
  arrive(bench, reply);
  bench.run(100'000);
  CHECK(!bench.last().has_echo);
  CHECK(bench.node.counts().replies.not_newer == 1);
}

TEST_CASE("a restarted host is accepted at once, whatever its reply sequence") {
  Bench bench;
  bench.run(60'000);
  arrive(bench, reply_to(bench.last(), 900'000));
  bench.run(100'000);
  arrive(bench, reply_to(bench.last(), 0));
  bench.run(100'000);
  CHECK(bench.last().has_echo);
  CHECK(bench.last().echo.reply_sequence == 0);
}

TEST_CASE(
    "fault 24 falseticker: replies with no MAC, a wrong one or numbers made up change nothing") {
  Bench bench(keyed());
  bench.run(60'000);
  const NodeFrame frame = bench.last();
  MacKey wrong = node_key;
  wrong[0] ^= 1;
  arrive(bench, reply_to(frame, 900));
  arrive(bench, reply_to(frame, 900, &wrong));
  NodeFrame other = frame;
  other.origin.boot_id ^= 1;
  arrive(bench, reply_to(other, 900, &node_key));
  other = frame;
  other.origin.node_id = 8;
  arrive(bench, reply_to(other, 900, &node_key));
  other = frame;
  other.origin.sequence += 1;
  arrive(bench, reply_to(other, 900, &node_key));
  bench.run(100'000);
  CHECK(!bench.last().has_echo);
  CHECK(bench.board.shown.back().sync == SyncLight::unanswered);
  CHECK(refused(bench, NodeRefusal::no_mac) == 1);
  CHECK(refused(bench, NodeRefusal::wrong_mac) == 1);
  const AnswerCounts counts = bench.node.counts().replies;
  CHECK(counts.other_boot == 1);
  CHECK(counts.other_node == 1);
  CHECK(counts.unknown_frame == 1);
  CHECK(counts.accepted == 0);
}

TEST_CASE("a host with the key is accepted") {
  Bench bench(keyed());
  bench.run(60'000);
  arrive(bench, reply_to(bench.last(), 900, &node_key));
  bench.run(100'000);
  CHECK(bench.last().has_echo);
}

TEST_CASE("rubbish is counted by its cause") {
  Bench bench;
  bench.run(60'000);
  Bytes reply = reply_to(bench.last(), 900);
  arrive(bench, {});
  arrive(bench, Bytes(10, 0));
  arrive(bench, Bytes(1500, 0));
  arrive(bench, bench.board.sent[0]);  // the node's own frame, sent back to it
  reply.back() ^= 1;
  arrive(bench, reply);
  CHECK(refused(bench, NodeRefusal::too_short) == 2);
  CHECK(refused(bench, NodeRefusal::bad_magic) == 1);
  CHECK(refused(bench, NodeRefusal::bad_crc) == 1);
  CHECK(refused(bench, NodeRefusal::wrong_length) == 1);  // cut: longer than any reply
  CHECK(bench.node.counts().replies.accepted == 0);
}

TEST_CASE("a flood does not hold up frames") {
  Bench bench;
  for (int i = 0; i < 100'000; ++i) bench.board.arriving.emplace_back(44);
  bench.run(1'000'000);
  CHECK(bench.board.sent.size() == 10);
  CHECK(bench.board.arriving.size() > 80'000);
}

TEST_CASE("a frame that the radio does not take loses its number and nothing else") {
  Bench bench;
  bench.run(60'000);
  arrive(bench, reply_to(bench.last(), 900));
  bench.board.radio_takes = false;
  bench.run(200'000);
  bench.board.radio_takes = true;
  bench.run(100'000);
  REQUIRE(bench.board.sent.size() == 2);
  CHECK(bench.last().origin.sequence == 3);
  CHECK(bench.last().has_echo);
  CHECK(bench.last().sample_count == 30);
  CHECK(bench.node.counts().frames.send_fails == 2);
}

TEST_CASE("without a link no frame is started, and samples wait") {
  Bench bench;
  bench.run(60'000);
  bench.node.set_link(false);
  bench.run(2'000'000);
  CHECK(bench.board.sent.size() == 1);
  CHECK(bench.board.shown.back().link_up == false);
  CHECK(bench.node.idle_us(bench.board.now_us) > 0);
  bench.node.set_link(true);
  bench.run(2'000'000);
  std::size_t samples = 0;
  for (std::size_t i = 0; i < bench.board.sent.size(); ++i) samples += bench.frame(i).sample_count;
  CHECK(bench.frame(1).origin.sequence == 1);
  CHECK(samples >= 400);  // 406 were taken; those of the last tick or two are not sent yet
  CHECK(bench.node.counts().samples.dropped == 0);
}

TEST_CASE("what is too old for the room there is, is dropped and counted") {
  for (const bool link : {false, true}) {  // the link is lost, or it is up but takes no datagrams
    CAPTURE(link);
    Bench bench;
    bench.node.set_link(link);
    bench.board.radio_takes = false;
    bench.run(10'000'000);
    const SampleCounts counts = bench.node.counts().samples;
    CHECK(counts.taken == 1000);
    CHECK(counts.dropped >= 1000 - SampleRing::capacity - max_node_samples);
    CHECK(counts.dropped <= 1000 - SampleRing::capacity + max_node_samples);
    bench.node.set_link(true);
    bench.board.radio_takes = true;
    bench.run(100'000);
    const std::uint32_t oldest_us = bench.frame(0).samples[0].age_us;
    CHECK(oldest_us < 10'000 * (SampleRing::capacity + max_node_samples + 10));
    CHECK(oldest_us > 10'000 * (SampleRing::capacity - 1));
  }
}

TEST_CASE("lights: link, answers, lock, battery, and no answer for three seconds") {
  FakeBoard board;
  board.now_us = 3'600'000'000;
  board.battery_mv = 4000;
  Node node(board, settings);
  node.poll();
  REQUIRE(board.shown.size() == 1);
  CHECK(board.shown.back() == Lights{});
  node.set_link(true);
  node.poll();
  board.now_us += 60'000;
  node.poll();
  const auto frame = decoded<NodeFrame>(board.sent.back());
  CHECK(board.shown.back() == Lights{true, SyncLight::unanswered, BatteryLight::good});
  board.arriving.push_back(reply_to(frame, 0, nullptr, true));
  node.poll();
  CHECK(board.shown.back() == Lights{true, SyncLight::locked, BatteryLight::good});
  board.battery_mv = 3400;
  board.now_us += 100'000;
  node.poll();
  CHECK(board.shown.back() == Lights{true, SyncLight::locked, BatteryLight::low});
  board.arriving.push_back(reply_to(decoded<NodeFrame>(board.sent.back()), 1));
  node.poll();
  CHECK(board.shown.back().sync == SyncLight::answered);
  const std::size_t shown = board.shown.size();
  node.poll();
  CHECK(board.shown.size() == shown);  // no change, no call
  board.now_us += 3'000'001;
  node.poll();
  CHECK(board.shown.back().sync == SyncLight::unanswered);
}
