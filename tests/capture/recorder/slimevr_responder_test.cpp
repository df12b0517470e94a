// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/recorder/slimevr_responder.h"

#include "tests/protocols/slimevr/slimevr_bytes.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <map>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

using std::chrono::milliseconds;

constexpr SipHashKey secret{1, 2, 3};

NodeAddress address(std::uint8_t last, std::uint16_t port = 6969) {
  NodeAddress at;
  at.host = mapped_ipv4(std::array<std::uint8_t, 4>{192, 168, 1, last});
  at.port = port;
  return at;
}

SlimeMac mac(std::uint8_t last) { return {2, 0, 0, 0, 0, last}; }

/// A responder for trackers, and the time.
class Lab {
 public:
  SlimeResult receive(const NodeAddress& from, const Bytes& bytes) {
    bytes_ = bytes;
    return responder.receive({bytes_, from, now});
  }
  SlimeResult handshake(const NodeAddress& from, const SlimeMac& name, std::uint8_t protocol = 22) {
    return receive(from, handshake_packet({name, protocol}));
  }
  std::vector<SlimeSending> sent() { return responder.take_sendings(); }
  const SlimeDevice& device(const NodeAddress& at) const {
    const SlimeDevice* found = responder.device_at(at);
    REQUIRE(found != nullptr);
    return *found;
  }
  SlimeResponder responder{secret};
  HostTime now{1000s};

 private:
  Bytes bytes_;
};

Bytes rotation(std::uint64_t number, std::uint8_t sensor = 0, std::uint8_t type = 1) {
  return slime_datagram(17, number, joined({{sensor, type}, Bytes(12), {0x3f, 0x80, 0, 0}, {0}}));
}

Bytes bytes_of(const SlimeSending& sending) {
  return {sending.answer.datagram().begin(), sending.answer.datagram().end()};
}

using Verdict = SlimeVerdict;

}  // namespace

TEST_CASE("a tracker's handshake is answered, and its data is accepted from then on") {
  Lab lab;
  CHECK(lab.handshake(address(7), mac(1)).verdict == Verdict::accepted);
  const auto sent = lab.sent();
  REQUIRE(sent.size() == 1);
  CHECK(sent[0].to == address(7));
  CHECK(sent[0].answer.size == 64);
  CHECK(sent[0].answer.bytes[0] == 3);
  CHECK(lab.receive(address(7), rotation(1, 2)).verdict == Verdict::accepted);
  CHECK(lab.device(address(7)).mac == mac(1));
}

TEST_CASE("an address without a handshake is unknown and gets no answer") {
  Lab lab;
  CHECK(lab.receive(address(7), rotation(1)).verdict == Verdict::unknown);
  CHECK(lab.receive(address(7), slime_datagram(22, 1, {0})).verdict == Verdict::unknown);
  lab.handshake(address(7), mac(1));
  CHECK(lab.receive(address(7, 7000), rotation(1)).verdict == Verdict::unknown);
  CHECK(lab.sent().size() == 1);
}

TEST_CASE("sensor infos are acknowledged with their status, feature flags answered") {
  Lab lab;
  lab.handshake(address(7), mac(1));
  lab.sent();
  const Bytes infos = joined({{4, 15, 0, 1, 4}, {4, 15, 1, 2, 4}, {8, 15, 40, 1, 4, 0, 0, 0, 5}});
  lab.receive(address(7), slime_datagram(101, 1, infos));
  auto sent = lab.sent();
  REQUIRE(sent.size() == 3);
  CHECK(bytes_of(sent[0]) == Bytes{0, 0, 0, 15, 0, 1});
  CHECK(bytes_of(sent[1]) == Bytes{0, 0, 0, 15, 1, 2});
  lab.receive(address(7), slime_datagram(22, 2, {1}));
  sent = lab.sent();
  REQUIRE(sent.size() == 1);
  CHECK(bytes_of(sent[0]) == Bytes{0, 0, 0, 22, 0, 0, 0, 0, 0, 0, 0, 0, 3});
}

TEST_CASE("order is by packet number: duplicate and late packets are distinguished") {
  Lab lab;
  lab.handshake(address(7), mac(1));
  CHECK(lab.receive(address(7), rotation(5)).verdict == Verdict::accepted);
  CHECK(lab.receive(address(7), rotation(5)).verdict == Verdict::duplicate);
  CHECK(lab.receive(address(7), rotation(8)).verdict == Verdict::accepted);
  CHECK(lab.receive(address(7), rotation(6)).verdict == Verdict::late);
  lab.receive(address(7), rotation(9));
  CHECK(lab.device(address(7)).numbers.counts().lost == 1);
  CHECK(lab.device(address(7)).numbers.counts().received == 5);
}

TEST_CASE("a restarted tracker is counted again from 0, and its old datagrams block nothing") {
  Lab lab;
  lab.handshake(address(7), mac(1));
  const SlimeDevice* device = &lab.device(address(7));
  lab.receive(address(7), rotation(50'000));
  lab.now += 3s;
  lab.handshake(address(7), mac(1));
  CHECK(&lab.device(address(7)) == device);
  CHECK(lab.receive(address(7), rotation(1)).verdict == Verdict::accepted);
  lab.receive(address(7), rotation(50'001));  // a late datagram of the run before
  CHECK(lab.receive(address(7), rotation(2)).verdict == Verdict::accepted);
  CHECK(lab.receive(address(7), rotation(3)).verdict == Verdict::accepted);
  CHECK(device->numbers.counts().received == 4);
}

TEST_CASE("a device is its MAC, and moves with it once its old address is silent") {
  Lab lab;
  lab.handshake(address(7), mac(1));
  const SlimeDevice* device = &lab.device(address(7));
  lab.now += 999ms;
  CHECK(lab.handshake(address(8), mac(1)).verdict == Verdict::duplicate_mac);
  CHECK(lab.receive(address(7), rotation(1)).verdict == Verdict::accepted);
  lab.now += 1s;
  CHECK(lab.handshake(address(8), mac(1)).verdict == Verdict::accepted);
  CHECK(&lab.device(address(8)) == device);
  CHECK(lab.receive(address(7), rotation(2)).verdict == Verdict::unknown);
  CHECK(lab.receive(address(8), rotation(3)).verdict == Verdict::accepted);
  // The messages of the old address stay counted there.
  CHECK(device->numbers.counts().received == 1);
}

TEST_CASE("without a MAC the address is the name, port and all") {
  Lab lab;
  lab.handshake(address(7, 1000), {});
  lab.handshake(address(7, 1001), {});
  const SlimeDevice* one = &lab.device(address(7, 1000));
  CHECK(one != &lab.device(address(7, 1001)));
  lab.handshake(address(7, 1000), {});
  CHECK(&lab.device(address(7, 1000)) == one);
  CHECK(!one->mac);
}

TEST_CASE("an address belongs to the tracker that sent its newest handshake") {
  Lab lab;
  lab.handshake(address(7), mac(1));
  CHECK(lab.handshake(address(7), mac(2)).verdict == Verdict::accepted);
  CHECK(lab.receive(address(7), rotation(1)).verdict == Verdict::accepted);
  CHECK(lab.device(address(7)).mac == mac(2));
}

TEST_CASE("a tracker at work gets a heartbeat each half second and a ping each second") {
  Lab lab;
  lab.handshake(address(7), mac(1));
  std::map<std::uint8_t, int> sent;
  std::uint64_t number = 0;
  for (int i = 0; i < 1000; ++i) {  // ten seconds at 100 Hz
    lab.now += 10ms;
    lab.receive(address(7), rotation(++number));
    if (i % 10 == 0) lab.responder.tick(lab.now);
    for (const auto& one : lab.sent()) {
      ++sent[one.answer.bytes[3]];
      if (one.answer.bytes[0] == 3 || one.answer.bytes[3] != 10) continue;
      lab.now += 4ms;
      CHECK(lab.receive(address(7), bytes_of(one)).verdict == Verdict::accepted);  // unchanged
    }
  }
  CHECK(sent[1] >= 16);
  CHECK(sent[1] <= 20);
  CHECK(sent[10] >= 9);
  CHECK(sent[10] <= 10);
}

TEST_CASE("an address never gets more bytes than it sent since its handshake") {
  for (const auto seed : fresh_seeds(30)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    Lab lab;
    std::map<std::uint8_t, std::size_t> came, went;
    for (int i = 0; i < 2000; ++i) {
      lab.now += milliseconds(random() % 200);
      const auto last = static_cast<std::uint8_t>(random() % 5);
      Bytes bytes = handshake_packet({mac(static_cast<std::uint8_t>(random() % 7)), 22});
      if (random() % 3 == 0) bytes.resize(12 + random() % (bytes.size() - 12));
      if (random() % 2 == 0) bytes = slime_datagram(15, random() % 50, {1, 1});
      if (random() % 4 == 0) bytes = slime_datagram(22, random() % 50, {1});
      if (random() % 4 == 0) bytes = slime_datagram(101, random() % 50, {2, 15, 0, 1, 15, 1, 0});
      came[last] += bytes.size();
      lab.receive(address(last), bytes);
      if (random() % 3 == 0) lab.responder.tick(lab.now);
      for (const auto& one : lab.sent()) went[one.to.host[15]] += one.answer.size;
      for (const auto& [to, size] : went) CHECK(size <= came[to]);
    }
  }
}

TEST_CASE("bytes from the old address give no credit to the new one") {
  Lab lab;
  lab.handshake(address(7), mac(1));
  for (std::uint64_t i = 1; i < 100; ++i) lab.receive(address(7), rotation(i));
  lab.now += 2s;
  lab.handshake(address(8), mac(1));
  lab.sent();
  lab.now += 500ms;
  lab.responder.tick(lab.now);  // 64 of the 67 bytes that it may be sent are used up
  CHECK(lab.sent().empty());
}

TEST_CASE("a tracker that falls silent after hours gets 4 KiB at most") {
  Lab lab;
  lab.handshake(address(7), mac(1));
  for (std::uint64_t i = 1; i < 2000; ++i) lab.receive(address(7), rotation(i));
  lab.sent();
  std::size_t bytes = 0;
  for (int i = 0; i < 1000; ++i) {
    lab.now += 500ms;
    lab.responder.tick(lab.now);
    for (const auto& one : lab.sent()) bytes += one.answer.size;
  }
  CHECK(bytes <= 4096);
  CHECK(bytes > 4096 - 16);
}

TEST_CASE("an idle tracker that returns what it gets keeps its heartbeats") {
  Lab lab;
  lab.handshake(address(7), mac(1));
  std::uint64_t number = 0;
  int heartbeats = 0;
  lab.sent();
  lab.receive(address(7), slime_datagram(15, ++number, {0, 1, 4, 0, 0, 0, 0, 0}));
  for (int i = 0; i < 100; ++i) {
    lab.now += 100ms;
    lab.responder.tick(lab.now);
    for (const auto& one : lab.sent()) {
      if (one.answer.bytes[3] == 10) lab.receive(address(7), bytes_of(one));
      if (one.answer.bytes[3] != 1) continue;
      ++heartbeats;
      lab.receive(address(7), slime_datagram(0, ++number, {}));
    }
  }
  CHECK(heartbeats >= 18);
}

TEST_CASE("a handshake of nothing but a head has no answer, being shorter than any") {
  Lab lab;
  CHECK(lab.receive(address(7), slime_datagram(3, 0, {})).verdict == Verdict::accepted);
  CHECK(lab.sent().empty());
  CHECK(lab.receive(address(8), slime_datagram(3, 0, {0})).verdict == Verdict::accepted);
  REQUIRE(lab.sent().size() == 1);
}

TEST_CASE("handshakes with many MACs from one address are limited, a known tracker's are not") {
  Lab lab;
  SlimeVerdicts verdicts;
  for (std::uint8_t i = 0; i < 50; ++i) {
    ++verdicts[lab.handshake(address(9, 1000 + i), mac(i)).verdict];
  }
  CHECK(verdicts[Verdict::accepted] == 8);
  CHECK(verdicts[Verdict::limited] == 42);
  CHECK(lab.handshake(address(10), mac(100)).verdict == Verdict::accepted);
  for (int i = 0; i < 50; ++i) {
    CHECK(lab.handshake(address(10), mac(100)).verdict == Verdict::accepted);
  }
}

TEST_CASE("sixty-four devices and no more, until one was silent for a minute") {
  Lab lab;
  for (std::uint8_t i = 0; i < 64; ++i) {
    lab.now += 10ms;
    CHECK(lab.handshake(address(i), mac(i)).verdict == Verdict::accepted);
  }
  CHECK(lab.handshake(address(200), mac(200)).verdict == Verdict::no_room);
  CHECK(lab.handshake(address(201), mac(201)).verdict == Verdict::no_room);
  lab.now += 59s;
  lab.receive(address(0), rotation(1));
  lab.now += 500ms;
  CHECK(lab.handshake(address(202), mac(202)).verdict ==
        Verdict::accepted);  // the place of tracker 1
  CHECK(lab.receive(address(1), rotation(1)).verdict == Verdict::unknown);
  CHECK(lab.receive(address(0), rotation(2)).verdict == Verdict::accepted);
}

TEST_CASE("a full table and a MAC that is used twice are findings, a tracker that moves is not") {
  SlimeVerdicts verdicts;
  for (const auto verdict : {Verdict::unknown, Verdict::duplicate_mac, Verdict::duplicate_mac}) {
    ++verdicts[verdict];
  }
  CHECK(findings_of(verdicts, "imu").empty());
  ++verdicts[Verdict::duplicate_mac];
  ++verdicts[Verdict::no_room];
  const Findings findings = findings_of(verdicts, "imu from 192.168.1.7:6969");
  REQUIRE(findings.size() == 2);
  CHECK(to_string(findings[0].what) ==
        "imu from 192.168.1.7:6969: expected at most 64 trackers, found another tracker");
  CHECK(to_string(findings[1].what) ==
        "imu from 192.168.1.7:6969: expected a MAC address of its own, found the MAC address of "
        "another active tracker");
  CHECK(refused(verdicts) == 5);
}

TEST_CASE("the battery's voltage is the newest that the tracker sent") {
  Lab lab;
  lab.handshake(address(7), mac(1));
  lab.receive(address(7), slime_datagram(12, 1, {0x40, 0x70, 0, 0, 0x3f, 0, 0, 0}));
  CHECK(lab.device(address(7)).battery_volts == 3.75F);
}

TEST_CASE("the number of waiting datagrams is limited") {
  Lab lab;
  lab.handshake(address(7), mac(1));
  for (std::uint64_t i = 1; i < 5000; ++i) {
    lab.receive(address(7), slime_datagram(22, i, {1}));
  }
  CHECK(lab.sent().size() == 1024);
  CHECK(lab.sent().empty());
}

TEST_CASE("a datagram below 12 bytes is too short") {
  Lab lab;
  CHECK(lab.receive(address(7), Bytes(11)).verdict == Verdict::too_short);
}
