// SPDX-License-Identifier: Apache-2.0
// The recorder's counts of datagrams on its ports, over loopback: refused ones, lost ones, and the
// findings about them.
#include "tests/capture/recorded.h"
#include "tests/capture/test_node.h"
#include "tests/protocols/kinect/kinect_messages.h"
#include "tests/protocols/slimevr/slimevr_bytes.h"

#include "kinalign/capture/recorder/recording_session.h"
#include "kinalign/capture/recorder/stream_watch.h"
#include "kinalign/protocols/kinect/frames.h"
#include "kinalign/protocols/kinect/stream.h"
#include "kinalign/protocols/noitom/stream.h"
#include "kinalign/wire/little_endian_reader.h"

#include <doctest/doctest.h>

#include <memory>
#include <numeric>

using namespace kinalign;
using namespace std::chrono_literals;

TEST_CASE(
    "what was lost on the way from a tracker's address stays so, whoever shakes hands there") {
  LiveSession live({"imu=slimevr:udp:127.0.0.1:0"});
  const Client address;
  std::uint64_t sent = 0;
  const auto send = [&](const std::vector<std::uint8_t>& bytes) {
    address.send("127.0.0.1", live.port(), bytes);
    live.serve_until([&, n = ++sent] { return live.pieces() == n; });
  };
  for (const std::uint8_t name :
       std::array<std::uint8_t, 3>{1, 1, 2}) {  // the tracker's own restart, then another tracker
    send(handshake_packet({{2, 0, 0, 0, 0, name}}));
    for (const std::uint64_t heartbeat : {1, 5}) send(slime_datagram(0, heartbeat, {}));
  }
  live.finish();
  CHECK(live.session().streams().at(0).counts.order.lost == 9);
}

TEST_CASE("refused datagrams of trackers are counted, and reported if the user can act") {
  LiveSession live({"imu=slimevr:udp:127.0.0.1:0"});
  std::uint64_t sent = 0;
  const auto send = [&](const Client& from, const std::vector<std::uint8_t>& bytes) {
    from.send("127.0.0.1", live.port(), bytes);
    live.serve_until([&, n = ++sent] { return live.pieces() == n; });
  };
  const Client tracker, rubbish, twin;
  const auto handshake = handshake_packet({{2, 0, 0, 0, 0, 1}});
  send(tracker, handshake);
  for (const std::uint64_t heartbeat : {1, 1}) send(tracker, slime_datagram(0, heartbeat, {}));
  for (int i = 0; i < 5; ++i) send(rubbish, std::vector<std::uint8_t>(11));
  for (int i = 0; i < 3; ++i) send(twin, handshake);  // while the first one is at work
  Findings findings;
  live.serve_until([&] {
    append(findings, live.session().take_findings());
    return !findings.empty();
  });
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].what.found == "the MAC address of another active tracker");
  live.finish();
  const auto streams = live.session().streams();
  REQUIRE(streams.size() == 3);
  CHECK(streams[0].counts.refused == 0);  // the numbers of the first tracker; one came twice
  CHECK(streams[1].counts.refused == 5);
  CHECK(streams[2].counts.refused == 3);
}

TEST_CASE("the file states what each port received and lost") {
  LiveSession live({"mocap=noitom:udp:127.0.0.1:0", "kinect=kinect:udp:127.0.0.1:0"});
  const Client one;
  one.send("127.0.0.1", live.port(), bytes_of("one"));
  live.serve_until([&] { return live.pieces() == 1; });
  const auto payloads = live.finish().at("/counts/ports");
  REQUIRE(payloads.size() >= 2);
  CHECK(
      payloads[payloads.size() - 2] ==
      R"({"stream":"mocap","pieces":1,"bytes":3,"refused":0,"cut":0,"dropped":0,"links":0,"unsent":0})");
  CHECK(payloads.back().starts_with(R"({"stream":"kinect","pieces":0,)"));
}

TEST_CASE(
    "Axis Studio's compressed port is told of while recording, once a host, with what to do") {
  LiveSession live({"mocap=noitom:udp:127.0.0.1:0"});
  const std::string compressed =
      std::string("CCCC\x28\0\0\0\x1f\x8b\x08\0", 12) + std::string(36, 'Z');
  const Client one, two;
  one.send("127.0.0.1", live.port(), bytes_of(compressed));
  live.serve_until([&] { return live.pieces() == 1; });
  Findings findings;
  live.serve_until([&] {
    append(findings, live.session().take_findings());
    return !findings.empty();
  });
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].what.file.starts_with("mocap from 127.0.0.1:"));
  CHECK(findings[0].what.expected == "plain BVH frames");
  CHECK(findings[0].repair.starts_with("switch the capture program to plain BVH broadcast"));
  two.send("127.0.0.1", live.port(), bytes_of(compressed));
  live.serve_until([&] { return live.pieces() == 2; });
  live.finish();
  CHECK(live.session().take_findings().empty());
}

TEST_CASE("a Kinect's frame that lacks a part is no frame of the counts") {
  LiveSession live({"kinect=kinect:udp:127.0.0.1:0"});
  KinectFrame six;
  six.origin = {2, 0x5eedf00d, 0};
  six.bodies.resize(6);
  for (std::size_t b = 0; b < 6; ++b) six.bodies[b].id = b + 1;
  KinectFrame one = six;
  one.bodies.resize(1);
  ++one.origin.sequence;
  const Client sender;
  sender.send("127.0.0.1", live.port(), encode_kinect_binary(kinect_parts(six).front()));
  sender.send("127.0.0.1", live.port(), encode_kinect_binary(one));
  live.serve_until([&] { return live.pieces() == 2; });
  live.finish();
  CHECK(live.session().streams().at(0).counts.frames == 1);
}

TEST_CASE("a datagram of rubbish is refused once, however much of it there is") {
  for (const std::string protocol : {"noitom", "xsens", "kinect"}) {
    CAPTURE(protocol);
    LiveSession live({"mocap=" + protocol + ":udp:127.0.0.1:0"});
    const Client sender;
    for (std::uint64_t k = 1; k <= 3; ++k) {
      std::string rubbish(400, static_cast<char>(0x90 + k));
      for (std::size_t i = 0; i < rubbish.size(); i += 40) rubbish.replace(i, 4, "KANK");
      sender.send("127.0.0.1", live.port(), bytes_of(rubbish));
      live.serve_until([&] { return live.pieces() == k; });
    }
    live.finish();
    const SenderCounts counts = live.session().streams().at(0).counts;
    CHECK(counts.messages == 3);
    CHECK(counts.frames == 0);
    CHECK(counts.refused >= 1);
    CHECK(counts.refused <= 3);
  }
}

TEST_CASE("dropped Kinect frames are counted by cause") {
  LiveSession live({"kinect=kinect:udp:127.0.0.1:0"});
  const Client sender;
  const auto send = [&](std::uint32_t session, std::uint32_t sequence) {
    KinectFrame frame;
    frame.origin = {2, session, sequence};
    sender.send("127.0.0.1", live.port(), encode_kinect_binary(frame));
  };
  send(1, 7);
  send(2, 1);
  send(1, 8);  // a frame of session 1, which is over
  live.serve_until([&] { return live.pieces() == 3; });
  live.finish();
  const SenderCounts counts = live.session().streams().at(0).counts;
  CHECK(counts.frames == 2);
  CHECK(counts.order.late == 1);
  CHECK(counts.refused == 0);
}

TEST_CASE("frames of a session that is over are late, whichever sender plays them back") {
  LiveSession live({"kinect=kinect:udp:127.0.0.1:0"});
  const Client first, second, stranger;
  std::uint64_t sent = 0;
  const auto send = [&](const Client& from, std::uint32_t session, std::uint32_t sequence) {
    KinectFrame frame;
    frame.origin = {2, session, sequence};
    frame.device_ticks = frame.sent_ticks = 1000 * session + sequence;
    from.send("127.0.0.1", live.port(), encode_kinect_binary(frame));
    live.serve_until([&, n = ++sent] { return live.pieces() == n; });
  };
  for (std::uint32_t k = 0; k < 40; ++k) send(first, 1, k);
  for (std::uint32_t k = 0; k < 10; ++k) send(second, 2, k);
  for (std::uint32_t k = 0; k < 40; ++k) send(stranger, 1, k);
  send(second, 2, 10);
  live.finish();
  SenderCounts sum;
  for (const StreamStatus& stream : live.session().streams()) {
    sum.frames += stream.counts.frames;
    sum.order += stream.counts.order;
  }
  CHECK(sum.frames == 51);
  CHECK(sum.order.late == 40);
  CHECK(sum.order.restarts == 1);
  CHECK(sum.order.lost == 0);
}

TEST_CASE("two Kinects with one id: the newest session is counted, and a finding names both once") {
  LiveSession live({"kinect=kinect:udp:127.0.0.1:0"});
  const Client first, second;
  const auto send = [&](const Client& from, std::uint32_t session, std::uint32_t sequence) {
    KinectFrame frame;
    frame.origin = {2, session, sequence};
    frame.device_ticks = frame.sent_ticks = 333'333 * std::int64_t{sequence};
    from.send("127.0.0.1", live.port(), encode_kinect_binary(frame));
  };
  for (std::uint32_t k = 0; k < 50; ++k) {
    send(first, 111, k);
    if (k != 30) send(second, 222, k);
    live.serve_until([&] { return live.pieces() == 2 * (k + 1) - (k >= 30 ? 1 : 0); });
  }
  Findings findings;
  live.serve_until([&] {
    append(findings, live.session().take_findings());
    return !findings.empty();
  });
  live.finish();
  append(findings, live.session().take_findings());
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].what.expected == "one sender of Kinect sensor 2");
  CHECK(findings[0].what.found.find(" in session 111, 127.0.0.1:") != std::string::npos);
  const auto streams = live.session().streams();
  REQUIRE(streams.size() == 2);
  CHECK(streams[0].counts.frames == 1);
  CHECK(streams[0].counts.order.late == 49);
  CHECK(streams[1].counts.frames == 49);
  CHECK(streams[1].counts.order.lost == 1);
  CHECK(streams[1].counts.order.late == 0);
  CHECK(streams[1].counts.order.restarts == 1);
}

TEST_CASE("a Kinect that restarts with its old session on another connection is a restart") {
  LiveSession live({"kinect=kinect:tcp-listen:127.0.0.1:0"});
  std::uint64_t sent = 0;
  const auto send = [&](const Connection& way, std::uint32_t sequence, std::int64_t ticks) {
    KinectFrame frame;
    frame.origin = {2, 1, sequence};
    frame.device_ticks = frame.sent_ticks = ticks;
    way.send(std::string(text_of(encode_kinect_binary(frame))));
    live.serve_until([&, n = ++sent] { return live.pieces() == n; });
  };
  const Connection first(live.port());
  send(first, 5000, 5000);
  const Connection second(live.port());
  for (std::uint32_t k = 0; k < 30; ++k) send(second, k, 6000 + k);
  live.finish();
  const SenderCounts counts = live.session().streams().at(1).counts;
  CHECK(counts.frames == 30);
  CHECK(counts.order.restarts == 1);
  CHECK(counts.order.duplicates == 0);
}

TEST_CASE(
    "what a Kinect lost between two connections is counted, and between two ports of its own") {
  const auto bytes = [](std::uint32_t sequence, std::uint32_t session) {
    KinectFrame frame;
    frame.origin = {2, session, sequence};
    return encode_kinect_binary(frame);
  };
  const auto lost = [](LiveSession& live) {
    std::uint64_t sum = 0;
    for (const StreamStatus& stream : live.session().streams()) sum += stream.counts.order.lost;
    return sum;
  };
  LiveSession by_tcp({"kinect=kinect:tcp-listen:127.0.0.1:0"});
  LiveSession by_udp({"kinect=kinect:udp:127.0.0.1:0"});
  std::uint64_t sent = 0;
  for (const std::uint32_t sequence : {1U, 5U, 6U}) {  // 2 to 4 were lost
    ++sent;
    const Connection connection(by_tcp.port());
    connection.send(std::string(text_of(bytes(sequence, 1))));
    by_tcp.serve_until([&] { return by_tcp.pieces() == sent; });
    const Client port;
    port.send("127.0.0.1", by_udp.port(), bytes(sequence, 1));
    by_udp.serve_until([&] { return by_udp.pieces() == sent; });
  }
  const Client restarted;
  restarted.send("127.0.0.1", by_udp.port(), bytes(100, 2));
  by_udp.serve_until([&] { return by_udp.pieces() == sent + 1; });
  by_tcp.finish();
  by_udp.finish();
  CHECK(lost(by_tcp) == 3);
  CHECK(lost(by_udp) == 3);
}

namespace {

using Payloads = std::map<std::string, std::vector<std::string>>;

/// The restarts in the last /counts message of each Kinect's sender.
std::vector<std::uint64_t> restarts_told(const Payloads& payloads) {
  std::map<std::string, std::uint64_t> by_topic;
  for (const std::string& json : payloads.at("/counts")) {
    const auto counted = to_counted_sender(json);
    REQUIRE(counted);
    by_topic[counted->topic] = counted->counts.order.restarts;
  }
  std::vector<std::uint64_t> told;
  told.reserve(by_topic.size());
  for (const auto& [topic, count] : by_topic) told.push_back(count);
  return told;
}

std::uint64_t restarts_by_frames(const Payloads& payloads) {
  KinectFrameJoiner joiner;
  std::vector<JoinedKinectFrame> frames;
  for (const auto& [topic, messages] : payloads) {
    if (!topic.starts_with("/kinect/raw")) continue;
    for (const std::string& message : messages) {
      KinectMessage decoded;
      REQUIRE(decode_kinect_datagram(octets(message), decoded) == KinectRefusal::none);
      joiner.take(std::get<KinectFrame>(decoded), frames);
    }
  }
  return joiner.counts().frames.restarts;
}

/// Two frames of a session.
std::array<std::vector<std::uint8_t>, 2> kinect_session(std::uint32_t session) {
  std::array<std::vector<std::uint8_t>, 2> frames;
  for (std::uint32_t sequence = 0; sequence < 2; ++sequence) {
    KinectFrame one;
    one.origin = {2, session, sequence};
    frames[sequence] = encode_kinect_binary(one);
  }
  return frames;
}

/// Three sessions; `sender` gives the sender of each.
template <class Sender>
void check_restarts(LiveSession& live, std::size_t senders, const Sender& sender) {
  std::uint64_t sent = 0;
  for (const std::uint32_t session : {11U, 12U, 13U}) {
    const auto send = sender();
    for (const auto& bytes : kinect_session(session)) {
      send(bytes);
      live.serve_until([&, n = sent + 1] { return live.pieces() == n; });
      ++sent;
    }
  }
  const auto payloads = live.finish();
  const auto told = restarts_told(payloads);
  CHECK(told.size() == senders);
  CHECK(std::accumulate(told.begin(), told.end(), std::uint64_t{0}) == 2);
  CHECK(restarts_by_frames(payloads) == 2);
}

}  // namespace

TEST_CASE("a restarted Kinect sender is a restart, in the counts and in the frames") {
  using Bytes = std::vector<std::uint8_t>;
  LiveSession one_port({"kinect=kinect:udp:127.0.0.1:0"});
  const Client same;
  check_restarts(one_port, 1, [&] {
    return [&](const Bytes& bytes) { same.send("127.0.0.1", one_port.port(), bytes); };
  });
  LiveSession ports({"kinect=kinect:udp:127.0.0.1:0"});
  check_restarts(ports, 3, [&] {
    return [&, fresh = std::make_shared<Client>()](const Bytes& bytes) {
      fresh->send("127.0.0.1", ports.port(), bytes);
    };
  });
  LiveSession connections({"kinect=kinect:tcp-listen:127.0.0.1:0"});
  check_restarts(connections, 3, [&] {
    return [fresh = std::make_shared<Connection>(connections.port())](const Bytes& bytes) {
      fresh->send(std::string(text_of(bytes)));
    };
  });
}

TEST_CASE("a suit's datagram that is cut short costs one frame") {
  LiveSession live({"mocap=noitom:udp:127.0.0.1:0"});
  const Client suit;
  for (std::uint32_t k = 0; k < 6; ++k) {
    NoitomFrame frame;
    frame.frame_index = k;
    frame.values.assign(noitom_values(false, false), 1.0F);
    std::vector<std::uint8_t> bytes;
    append_noitom(frame, bytes);
    if (k == 1 || k == 3) bytes.resize(bytes.size() - 3);
    suit.send("127.0.0.1", live.port(), bytes);
    live.serve_until([&] { return live.pieces() == k + 1; });
  }
  live.finish();
  const SenderCounts counts = live.session().streams().at(0).counts;
  CHECK(counts.frames == 4);
  CHECK(counts.order.lost == 0);  // their numbers have come
  CHECK(counts.refused == 2);
}

TEST_CASE("a device that sends to another device's port is reported once while recording") {
  LiveSession live({"kinect=kinect:udp:127.0.0.1:0"});
  NoitomFrame frame;
  frame.values.assign(noitom_values(false, false), 0.0F);
  std::vector<std::uint8_t> bytes;
  append_noitom(frame, bytes);
  const Client suit;
  for (std::uint64_t k = 1; k <= 60; ++k) {
    suit.send("127.0.0.1", live.port(), bytes);
    live.serve_until([&] { return live.pieces() == k; });
  }
  Findings findings;
  live.serve_until([&] {
    append(findings, live.session().take_findings());
    return !findings.empty();
  });
  const auto of_frames = std::count_if(findings.begin(), findings.end(), [](const Finding& f) {
    return f.what.expected == "frames of kinect" &&
           f.repair == "check the port and the protocol that the device sends to";
  });
  CHECK(of_frames == 1);
}

TEST_CASE("without keys, nodes that are not let in get no channels, and are counted") {
  LiveSession live({"imu=nodes:udp:127.0.0.1:0"});
  SystemClocks clocks;
  const Client radio;
  for (std::uint32_t id = 1; id <= 70; ++id) {  // there is room for 64
    TestNode node(id, id);
    node.drift = 0.0;
    node.offset_s = 1000.0;
    radio.send("127.0.0.1", live.port(), node.frame(clocks.raw()));
    live.serve_until([&] { return live.pieces() == id; });
  }
  CHECK(live.session().streams().size() == 64);
  CHECK(live.session().port_counts().front().second.refused == 6);
  const auto payloads = live.finish();
  CHECK(payloads.contains("/imu/64/raw"));
  CHECK(!payloads.contains("/imu/65/raw"));
}

TEST_CASE("a suit's last frame counts, though over UDP no next one says that its end is its own") {
  NoitomFrame frame;
  frame.form = NoitomForm::new_header;
  frame.avatar = 1;
  frame.name = "Char01";
  frame.displacement = true;
  frame.values.assign(noitom_values(true, false), 1.0F);
  StreamWatch watch(Protocol::noitom, true);
  for (std::uint32_t k = 0; k < 4; ++k) {
    frame.frame_index = k;
    std::vector<std::uint8_t> bytes;
    append_noitom(frame, bytes);
    const std::string sent(bytes.begin(), bytes.end());
    const HostTime at{10ms * k};
    NewestKinectFrames newest;
    watch.feed(sent.substr(0, 1472), at, newest);
    watch.feed(sent.substr(1472), at + 1ms, newest);
  }
  CHECK(watch.counts().frames == 4);
}
