// SPDX-License-Identifier: Apache-2.0
// The nodes' port on loopback: real sockets, the kernel's filter, and one clock for each node.
#include "kinalign/capture/nodes/node_receiver.h"

#include "tests/capture/loopback.h"
#include "tests/capture/test_node.h"

#include "kinalign/capture/nodes/node_filter.h"
#include "kinalign/clock/live/live_clock.h"

#include <doctest/doctest.h>
#include <poll.h>

#include <algorithm>

namespace kinalign {

namespace {

using namespace std::chrono_literals;

const LabKey lab{7};

/// A node whose counter is a thousand seconds ahead of the raw clock.
TestNode node_ahead(std::uint32_t id = 7) {
  TestNode node(id, 1, lab);
  node.drift = 0.0;
  node.offset_s = 1000.0;
  return node;
}

NodeReceiver open_receiver(ClockReader& clocks, const std::string& address) {
  NodeReceiverOptions options;
  options.addresses = {address};
  options.responder.lab_key = lab;
  auto opened = NodeReceiver::open(options, clocks);
  REQUIRE(opened);
  return std::move(*opened);
}

/// A receiver, a node, and the socket from which the node sends.
template <class Clocks = SystemClocks>
struct Bench {
  explicit Bench(const std::string& address = "127.0.0.1")
      : to(address == "0.0.0.0" ? "127.0.0.1" : address),
        receiver(open_receiver(clocks, address)),
        client(to == "::1" ? AF_INET6 : AF_INET) {}

  std::uint16_t port() const { return receiver.sockets()[0].port(); }
  /// Waits until a datagram has come, at most two seconds; gives whether one came.
  bool serve() {
    pollfd waiting{receiver.fd(), POLLIN, 0};
    const bool came = ::poll(&waiting, 1, 2000) > 0;
    receiver.drain();
    return came;
  }
  void send(const Bytes& bytes) const { client.send(to, port(), bytes); }
  /// Exchanges frames and takes the replies: fewer than 30, so that all are answered in any second.
  void talk(int frames) { talk(node, frames); }
  void talk(TestNode& who, int frames) {
    for (int k = 0; k < frames; ++k) {
      send(who.frame(clocks.raw()));
      serve();
      const auto came = client.receive();
      REQUIRE(came);
      REQUIRE(who.take_reply(came->bytes, clocks.raw()));
    }
  }

  std::string to;
  Clocks clocks;
  NodeReceiver receiver;
  TestNode node = node_ahead();
  Client client;
};

/// The system's clocks, with an added sleep of the host or an added time.
class OddClocks : public SystemClocks {
 public:
  HostTime raw() override { return SystemClocks::raw() + later; }
  Duration asleep() override { return SystemClocks::asleep() + slept; }
  Duration later{0}, slept{0};
};

/// Clocks that move on by `reading` between the readings of the wall clock and of the raw clock.
class SlowClocks : public SystemClocks {
 public:
  HostTime raw() override { return SystemClocks::raw() + later_; }
  Time utc() override {
    const Time read = SystemClocks::utc() + later_;
    later_ += reading;
    return read;
  }
  Duration reading{0};

 private:
  Duration later_{0};
};

/// The node of each clock event that the receiver reports.
std::vector<std::uint32_t> tellers(NodeReceiver& receiver) {
  std::vector<std::uint32_t> ids;
  for (const auto& told : receiver.take_clock_events()) {
    if (ids.empty() || ids.back() != told.node_id) ids.push_back(told.node_id);
  }
  return ids;
}

}  // namespace

TEST_CASE("a node's clock is certified after a few frames, and its stamps hold the truth") {
  Bench bench;
  bench.node.battery_mv = 3700;
  int certified = 0;
  bool holds = true;
  bench.receiver.watch([&](const NodeArrival&, const NodeMessage& message, LiveClock* clock) {
    if (clock == nullptr) return;
    const auto stamp = clock->host_from_node(message.exchange->boot, message.exchange->n_tx);
    if (!stamp || stamp->certainty != Certainty::certified) return;
    ++certified;
    // The truth of TestNode::counter_us, which is cut to whole microseconds.
    const HostTime truth{message.exchange->n_tx.time_since_epoch() - std::chrono::seconds(1000)};
    holds = holds && *stamp->earliest <= truth + std::chrono::microseconds(1) &&
            truth <= *stamp->latest;
  });
  bench.talk(28);
  CHECK(certified > 20);
  CHECK(holds);
  CHECK(bench.node.locked);
  const auto status = bench.receiver.status();
  REQUIRE(status.size() == 1);
  CHECK(status[0].node_id == 7);
  CHECK(status[0].battery_mv == 3700);
  CHECK(status[0].lost == 0);
  CHECK(status[0].accepted == 27);
  CHECK(status[0].stamp->certainty == Certainty::certified);
}

TEST_CASE("the kernel drops invalid datagrams and counts them") {
  Bench bench;
  Bytes wrong_length = bench.node.frame(bench.clocks.raw()), wrong_magic = wrong_length,
        newer = wrong_length;
  wrong_length.push_back(0);
  wrong_magic[3] = 'd';
  newer[4] = 9;
  for (const Bytes& bytes :
       {wrong_length, wrong_magic, Bytes(27), Bytes(0), Bytes(1411), Bytes(60'000)}) {
    bench.send(bytes);
  }
  bench.send(newer);
  bench.talk(1);
  CHECK(bench.receiver.dropped() == 6);
  CHECK(bench.receiver.counts().verdicts.total() == 2);
  CHECK(bench.receiver.counts().newest_version == 9);
}

TEST_CASE("unknown senders that fill the open socket cost a known node no frame") {
  for (const std::string address : {"127.0.0.1", "0.0.0.0", "::1"}) {
    if (address == "::1" && !has_ipv6_loopback()) continue;
    CAPTURE(address);
    Bench bench(address);
    bench.talk(3);
    const Client stranger(bench.to == "::1" ? AF_INET6 : AF_INET);
    const Bytes well_formed = TestNode(1000, 1).frame(bench.clocks.raw());
    for (int sent = 0; sent < 200'000 && bench.receiver.dropped() == 0; ++sent) {
      stranger.send(bench.to, bench.port(), well_formed);
    }
    REQUIRE(bench.receiver.dropped() > 0);  // nothing more goes in
    const auto accepted = [&] { return bench.receiver.status()[0].accepted; };
    const std::uint64_t before = accepted();
    for (int k = 0; k < 10; ++k) bench.send(bench.node.frame(bench.clocks.raw()));
    while (accepted() < before + 10 && bench.serve()) continue;
    CHECK(accepted() == before + 10);
  }
}

TEST_CASE("a frame that many would answer is counted, and not looked into") {
  Bench bench("0.0.0.0");
  bench.client.send("127.255.255.255", bench.port(), bench.node.frame(bench.clocks.raw()));
  bench.serve();
  CHECK(bench.receiver.not_unicast() == 1);
  CHECK(bench.receiver.counts().verdicts.total() == 0);
}

TEST_CASE("a batch is answered before the clocks are updated, each frame with its own readings") {
  Bench bench;
  bench.talk(2);
  std::vector<Duration> ages;
  bench.receiver.watch([&](const NodeArrival&, const NodeMessage& message, LiveClock*) {
    REQUIRE(bench.client.receive());  // its answer is there, or never comes
    for (const NodeReading& reading : message.readings)
      ages.push_back(message.exchange->n_tx - reading.n);
  });
  for (std::uint32_t age_us = 1; age_us <= 3; ++age_us) {
    bench.node.samples.resize(age_us);
    bench.node.samples.back().age_us = age_us;
    bench.send(bench.node.frame(bench.clocks.raw()));
  }
  while (ages.size() < 6 && bench.serve()) continue;
  using std::chrono::microseconds;
  CHECK(ages == std::vector<Duration>{microseconds(1), microseconds(1), microseconds(2),
                                      microseconds(1), microseconds(2), microseconds(3)});
}

TEST_CASE("frames are reported in the order of arrival, however slowly clocks are read") {
  Bench<SlowClocks> bench;
  bench.talk(2);
  std::vector<HostTime> arrivals;
  bench.receiver.watch([&](const NodeArrival&, const NodeMessage& message, LiveClock*) {
    arrivals.push_back(message.exchange->h_rx);
  });
  for (const Duration each : {Duration(10s), Duration(0s)}) {
    bench.clocks.reading = each;
    bench.send(bench.node.frame(bench.clocks.raw()));
    const std::size_t before = arrivals.size();
    while (arrivals.size() == before && bench.serve()) continue;
  }
  REQUIRE(arrivals.size() == 2);
  CHECK(arrivals[0] <= arrivals[1]);
  for (const auto& told : bench.receiver.take_clock_events()) {
    CHECK(told.event.kind != ClockEvent::Kind::host_backwards);
  }
}

TEST_CASE(
    "fault 19 host_suspend: clocks are learnt again, and events of the earlier clocks are kept") {
  Bench<OddClocks> bench;
  const auto talk_as = [&](std::uint32_t id) {
    TestNode node = node_ahead(id);
    bench.talk(node, 3);
  };
  for (std::uint32_t id = 1; id <= NodeTable::most_streams; ++id) talk_as(id);
  bench.clocks.slept = std::chrono::hours(1);
  bench.clocks.later = std::chrono::hours(1);
  bench.receiver.tick();
  // The stamp was of the clock before the sleep; a look at it does not end the stream.
  CHECK_FALSE(bench.receiver.status()[0].stamp);
  talk_as(100);  // takes the stream of the first node
  const auto ids = tellers(bench.receiver);
  CHECK(std::count(ids.begin(), ids.end(), 1) == 1);
  CHECK(std::count(ids.begin(), ids.end(), 64) == 1);
  CHECK(std::count(ids.begin(), ids.end(), 100) == 1);
  const auto status = bench.receiver.status();
  CHECK(status.front().node_id == 2);
  CHECK(status.back().node_id == 100);
  CHECK(status.back().stream == 0);
}

TEST_CASE("lost events and pairs are counted, whichever list is full") {
  Bench<OddClocks> bench;
  for (int i = 0; i < 66; ++i) {
    bench.clocks.later += 1s;
    bench.receiver.tick();
    bench.receiver.take_host_events();  // the events that the wall clock seems to have stepped
  }
  std::uint64_t missed = 66 - 64;  // pairs of clock readings
  CHECK(bench.receiver.missed_events() == missed);
  for (std::uint32_t boot = 1; boot <= 68; ++boot) {
    if (boot > 1) bench.node.reboot(boot, bench.clocks.raw());
    bench.talk(2);
  }
  missed += 68 - 64;  // the node's own events that it started, ...
  missed += 68 - 64;  // ... and its clock's
  CHECK(bench.receiver.missed_events() == missed);
  bench.receiver.take_pairs();
  bench.receiver.take_node_events();
  bench.clocks.slept = std::chrono::hours(1);
  bench.clocks.later += std::chrono::hours(1);
  bench.receiver.tick();
  bench.talk(2);  // its clock is replaced
  CHECK(bench.receiver.missed_events() == missed);
}

TEST_CASE("a node that takes the stream of another has a clock of its own") {
  Bench<OddClocks> bench;
  for (std::uint32_t id = 1; id <= NodeTable::most_streams; ++id) {
    TestNode node = node_ahead(id);
    bench.talk(node, 2);
  }
  tellers(bench.receiver);
  bench.clocks.later = std::chrono::hours(1);
  TestNode node = node_ahead(100);
  bench.talk(node, 3);
  CHECK(tellers(bench.receiver) == std::vector<std::uint32_t>{100});
}

TEST_CASE("nodes are listed by their ids, in whatever order they joined") {
  Bench bench;
  for (const std::uint32_t id : {9U, 3U, 12U}) {
    TestNode node = node_ahead(id);
    bench.talk(node, 2);
  }
  std::vector<std::uint32_t> ids;
  for (const NodeStatus& status : bench.receiver.status()) ids.push_back(status.node_id);
  CHECK(ids == std::vector<std::uint32_t>{3, 9, 12});
}

TEST_CASE("fault 40 ipv6_only: the same over IPv6") {
  if (!has_ipv6_loopback()) return;
  Bench bench("::1");
  bench.send(Bytes(60));  // filtered on this port too
  bench.talk(5);
  CHECK(bench.receiver.dropped() == 1);
  CHECK(bench.receiver.counts().verdicts[NodeVerdict::accepted] == 4);
}

TEST_CASE("pairs of raw and wall clock are logged once a second") {
  Bench bench;
  for (int i = 0; i < 100; ++i) bench.receiver.tick();
  CHECK(bench.receiver.take_pairs().size() == 1);
  CHECK(bench.receiver.take_pairs().empty());
}

}  // namespace kinalign
