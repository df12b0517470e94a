// SPDX-License-Identifier: Apache-2.0
// The recorder's answers on its devices' ports, over loopback, and the contents of the file
// afterwards.
#include "tests/capture/recorded.h"
#include "tests/capture/test_node.h"
#include "tests/protocols/kinect/kinect_lines.h"

#include "kinalign/capture/recorder/recording_session.h"
#include "kinalign/protocols/kinect/binary.h"
#include "kinalign/protocols/kinect/stream.h"
#include "kinalign/protocols/marks/mark_call.h"

#include <doctest/doctest.h>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

constexpr KinectOrigin sensor_2{2, 0x5eedf00d, 0};

std::vector<std::uint8_t> ping_bytes(std::uint32_t number, std::optional<KinectPong> heard,
                                     bool as_line) {
  KinectPing ping{sensor_2, 1'000'000 + number * 1000, std::nullopt};
  ping.origin.sequence = number;
  if (heard) ping.echo = KinectEcho{heard->pong_sequence, heard->nonce, ping.sent_ticks - 10};
  if (!as_line) return encode_kinect_binary(ping);
  std::string line = encode_kinect_line(ping);
  line.pop_back();  // in a datagram the line end may be missing
  return bytes_of(line);
}

}  // namespace

TEST_CASE("a Kinect's pings are answered over UDP, and each exchange stands in the file") {
  for (const bool as_line : {false, true}) {
    CAPTURE(as_line);
    LiveSession live({"kinect=kinect:udp:127.0.0.1:0"});
    const Client sender;
    std::optional<KinectPong> heard;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const auto bytes = ping_bytes(i, heard, as_line);
      sender.send("127.0.0.1", live.port(), bytes);
      live.serve_until([&] { return live.pieces() == i + 1; });
      const auto came = sender.receive();
      REQUIRE(came);
      CHECK(came->bytes.size() <= bytes.size());
      KinectMessage message;
      REQUIRE(decode_kinect_datagram(came->bytes, message) == KinectRefusal::none);
      REQUIRE(std::holds_alternative<KinectPong>(message));
      heard = std::get<KinectPong>(message);
      CHECK(heard->origin.sequence == i);
      CHECK((came->bytes.front() == '{') == as_line);
    }
    const auto payloads = live.finish();
    CHECK(payloads.at("/kinect/raw").size() == 3);
    REQUIRE(payloads.at("/kinect/exchange").size() == 3);
    const auto last = to_exchange(payloads.at("/kinect/exchange")[2]);
    REQUIRE(last);
    CHECK(last->exchange.boot == 0x5eedf00dU);
    CHECK(last->exchange.n_tx == NodeTime{100200us});
    REQUIRE(last->exchange.echo);
    CHECK(last->exchange.echo->n_rx == NodeTime{100199us});
    const auto second = to_exchange(payloads.at("/kinect/exchange")[1]);
    CHECK(last->exchange.echo->h_tx >= second->exchange.h_rx);
    CHECK(last->exchange.echo->h_tx <= last->exchange.h_rx);
  }
}

TEST_CASE("pings of a Kinect that begins sessions too often are refused, and counted") {
  LiveSession live({"kinect=kinect:udp:127.0.0.1:0"});
  const Client sender;
  for (std::uint32_t session = 1; session <= 10; ++session) {
    sender.send("127.0.0.1", live.port(), encode_kinect_binary(KinectPing{{2, session, 0}, 5, {}}));
    live.serve_until([&] { return live.pieces() == session; });
  }
  CHECK(live.finish().at("/kinect/exchange").size() == 8);
  CHECK(live.session().streams().at(0).counts.refused == 2);
}

TEST_CASE("exchanges of two Kinects stand beside what each of them sent") {
  LiveSession live({"kinect=kinect:udp:127.0.0.1:0"});
  const Client one, two;
  one.send("127.0.0.1", live.port(), ping_bytes(0, std::nullopt, false));
  live.serve_until([&] { return live.pieces() == 1; });
  two.send("127.0.0.1", live.port(), ping_bytes(1, std::nullopt, false));
  live.serve_until([&] { return live.pieces() == 2; });
  const auto payloads = live.finish();
  CHECK(payloads.at("/kinect/exchange").size() == 1);
  CHECK(payloads.at("/kinect/exchange/2").size() == 1);
  CHECK(payloads.at("/kinect/raw/2").size() == 1);
}

TEST_CASE("a Kinect's pings are answered over its connection, wherever that is cut") {
  LiveSession live({"kinect=kinect:tcp-listen:127.0.0.1:0"});
  const Connection sender(live.port());
  KinectPing ping{sensor_2, 5, std::nullopt};
  const std::string text = encode_kinect_line(ping);
  sender.send(text.substr(0, 50));
  live.serve_until([&] { return live.pieces() == 1; });
  sender.send(text.substr(50));
  live.serve_until([&] { return live.pieces() == 2; });
  const std::string came = sender.receive();
  KinectMessage message;
  REQUIRE(decode_kinect_line(came, message) == KinectRefusal::none);
  CHECK(std::get<KinectPong>(message).origin == sensor_2);
  CHECK(live.finish().at("/kinect/exchange").size() == 1);
}

TEST_CASE("a SlimeVR tracker's handshake is answered, it is pinged, and all it said is recorded") {
  LiveSession live({"imu=slimevr:udp:127.0.0.1:0"});
  const Client tracker;
  std::vector<std::uint8_t> handshake(64);
  handshake[3] = 3;
  tracker.send("127.0.0.1", live.port(), handshake);
  live.serve_until([&] { return live.pieces() == 1; });
  const auto answer = tracker.receive();
  REQUIRE(answer);
  CHECK(answer->bytes.size() <= handshake.size());
  CHECK(std::string(answer->bytes.begin() + 1, answer->bytes.begin() + 13) == "Hey OVR =D 5");
  for (const std::uint8_t number :
       std::array<std::uint8_t, 3>{1, 3, 2}) {  // heartbeats; one of them was overtaken
    tracker.send("127.0.0.1", live.port(), {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, number});
  }
  live.serve_until([&] { return live.pieces() == 4; });
  bool pinged = false;
  while (!pinged) {  // a second after the handshake, within CTest's limit
    live.session().turn(100ms);
    const auto came = tracker.receive();
    pinged = came && came->bytes.size() == 16 && came->bytes[3] == 10;
  }
  const auto payloads = live.finish();
  CHECK(payloads.at("/imu/raw").size() == 4);
  const SenderCounts counts = live.session().streams().at(0).counts;
  CHECK(counts.order.late == 1);
}

TEST_CASE("a tracker that calls to all is answered by a host that has the port open for all") {
  LiveSession live({"imu=slimevr:udp:0.0.0.0:0"});
  const Client tracker;
  std::vector<std::uint8_t> handshake(64);
  handshake[3] = 3;
  tracker.send("127.255.255.255", live.port(), handshake);
  live.serve_until([&] { return live.pieces() == 1; });
  const auto answer = tracker.receive();
  REQUIRE(answer);
  CHECK(answer->from == "127.0.0.1");
}

TEST_CASE("a stranger gets no more from the trackers' port than the answer to a handshake") {
  LiveSession live({"imu=slimevr:udp:127.0.0.1:0"});
  const Client stranger;
  stranger.send("127.0.0.1", live.port(), std::vector<std::uint8_t>(12));  // a heartbeat
  live.serve_until([&] { return live.pieces() == 1; });
  CHECK(!stranger.receive());
  CHECK(live.finish().at("/imu/raw").size() == 1);
}

TEST_CASE(
    "who sends trackers' ports something else is told of once, and a tracker that is not let in is "
    "not") {
  LiveSession live({"imu=slimevr:udp:127.0.0.1:0"});
  const Client other, another, tracker;
  for (std::uint64_t i = 0; i < 25; ++i) {
    other.send("127.0.0.1", live.port(), bytes_of("KNCT frames that are not a tracker's"));
    another.send("127.0.0.1", live.port(), bytes_of("short"));
    // A heartbeat of a tracker whose handshake went elsewhere.
    std::vector<std::uint8_t> heartbeat(12);
    heartbeat[11] = static_cast<std::uint8_t>(i);
    tracker.send("127.0.0.1", live.port(), heartbeat);
    live.serve_until([&] { return live.pieces() == 3 * (i + 1); });
  }
  live.finish();
  const Findings findings = live.session().take_findings();
  REQUIRE(findings.size() == 1);  // one finding for the host
  CHECK(findings[0].severity == Severity::warning);
  CHECK(findings[0].what.expected == "frames of slimevr");
  CHECK(findings[0].what.found == "25 messages without such a frame");
  const auto streams = live.session().streams();
  REQUIRE(streams.size() == 3);
  CHECK(streams[0].counts.frames == 0);
  CHECK(streams[2].counts.frames == 25);
  CHECK(streams[2].counts.refused == 25);
}

TEST_CASE("what comes to the nodes' port and is no node's is told of once; stray ones are not") {
  LiveSession live({"imu=nodes:udp:127.0.0.1:0"});
  const Client suit;
  const auto send = [&](int datagrams) {
    for (int i = 0; i < datagrams; ++i) {
      suit.send("127.0.0.1", live.port(), bytes_of(std::string(100, 's')));
    }
  };
  const auto dropped = [&] { return live.session().port_counts().front().second.dropped; };
  const auto seconds_on = [&] {
    const auto begun = std::chrono::steady_clock::now();
    live.serve_until([&] { return std::chrono::steady_clock::now() - begun > 2100ms; });
  };
  send(19);
  seconds_on();
  CHECK(dropped() == 19);
  CHECK(live.session().take_findings().empty());
  send(1);
  seconds_on();
  CHECK(dropped() == 20);
  send(30);
  seconds_on();
  const Findings findings = live.session().take_findings();
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].severity == Severity::warning);
  CHECK(to_string(findings[0].what) == "imu: expected only frames of nodes at port " +
                                           std::to_string(live.port()) +
                                           ", found 20 other datagrams");
}

TEST_CASE("that the host's wall clock was set is told while recording") {
  struct SetClocks : SystemClocks {
    bool was_set = false;
    bool wall_was_set() override { return std::exchange(was_set, false); }
  };
  const FreshFolder folder;
  PosixFiles files;
  SetClocks clocks;
  SystemClocks nodes_clock;
  RecordingSession::Options options;
  options.lab.devices = {*parse_device("mocap=noitom:udp:127.0.0.1:0")};
  auto session = RecordingSession::open(options, {files, clocks, nodes_clock});
  REQUIRE(session);
  start(**session, folder / "a.mcap");
  (*session)->turn(0ms);
  CHECK((*session)->take_clock_events().empty());
  clocks.was_set = true;
  finish(**session);
  const auto events = (*session)->take_clock_events();
  REQUIRE(events.size() == 1);
  CHECK(events[0].kind == HostClockEvent::Kind::wall_stepped);
}

TEST_CASE("marks from calls and broadcasts stand in the file once, and calls are answered") {
  RecordingSession::Options options;
  options.marks_port = 0;
  options.trigger_port = 0;
  LiveSession live({"mocap=noitom:udp:127.0.0.1:0"}, options);
  const auto port_of = [&](const std::string& name) {
    for (const auto& [known, port] : live.session().ports()) {
      if (known == name) return port;
    }
    return std::uint16_t{0};
  };
  const Client caller;
  const Mark start{Mark::Kind::start, "S1A02", 12500us, "b3f1-1"};
  for (const char* is : {"new", "repeat"}) {
    caller.send("127.0.0.1", port_of("marks"), bytes_of(encode_mark_call(start)));
    live.serve_until([&] { return live.session().mark_ports().front().counts().marks > 0; });
    live.session().turn(10ms);
    const auto came = caller.receive();
    REQUIRE(came);
    CHECK(std::string(came->bytes.begin(), came->bytes.end()) ==
          std::string(R"({"mark":"b3f1-1","is":")") + is + "\"}");
  }
  caller.send("127.0.0.1", port_of("marks"), bytes_of("{}"));
  const std::string broadcast =
      R"(<CaptureStop><Name VALUE="dance"/><PacketID VALUE="33363"/></CaptureStop>)";
  caller.send("127.0.0.1", port_of("trigger"), bytes_of(broadcast));
  caller.send("127.0.0.1", port_of("trigger"), bytes_of(broadcast));
  const auto& ports = live.session().mark_ports();
  live.serve_until([&] { return ports.back().counts().repeats == 1; });
  CHECK(ports.front().counts().marks == 1);
  CHECK(ports.front().counts().repeats == 1);
  CHECK(ports.front().counts().refused.at("wrong_schema") == 1);
  live.session().mark({{Mark::Kind::t_pose, "", std::nullopt, ""}, "keyboard", ""},
                      live.session().now());
  const auto heard = live.session().take_marks();
  REQUIRE(heard.size() == 3);
  CHECK(heard[0].first.mark == start);
  CHECK(live.session().take_marks().empty());
  const auto payloads = live.finish().at("/marks");
  REQUIRE(payloads.size() == 3);
  const auto first = to_mark(payloads[0]);
  REQUIRE(first);
  CHECK(first->mark == start);
  CHECK(first->source == "call");
  CHECK(first->sender.starts_with("127.0.0.1:"));
  CHECK(to_mark(payloads[1])->mark.kind == Mark::Kind::stop);
  CHECK(to_mark(payloads[1])->source == "trigger");
  CHECK(to_mark(payloads[2])->source == "keyboard");
}

TEST_CASE("what a port for marks refuses is told by its cause, the first of each, and answered") {
  MarkPort call = *MarkPort::open(MarkPort::Form::call, 0);
  MarkPort trigger = *MarkPort::open(MarkPort::Form::trigger, 0);
  SystemClocks clocks;
  HostAxis axis(clocks);
  const Client caller;
  const auto refused = [&](MarkPort& port, const std::string& text) {
    caller.send("127.0.0.1", port.port(), bytes_of(text));
    const std::uint64_t before = port.port_counts().refused;
    while (port.port_counts().refused == before) port.drain(axis, [](const auto&, HostTime) {});
    const Findings found = port.take_findings();
    return found.empty() ? "" : to_string(found.front().what);
  };
  const std::string pause = R"({"schema":"kinalign.mark/1","kind":"pause","id":"7"})";
  const std::string said = refused(call, pause);
  CHECK(
      said.starts_with("port of marks: expected a kind: start, stop, t_pose or text, found "
                       "{\"schema\":\"kinalign.mark/1\",\"kind\":\"paus... from 127.0.0.1:"));
  CHECK(said.ends_with(": wrong_kind"));
  const auto came = caller.receive();
  REQUIRE(came);
  CHECK(std::string(came->bytes.begin(), came->bytes.end()) == R"({"mark":"7","is":"wrong_kind"})");
  CHECK(refused(call, pause).empty());  // already reported
  CHECK(caller.receive());              // and answered again
  CHECK(
      refused(call, "no mark").starts_with("port of marks: expected a JSON object, found no mark"));
  CHECK(!caller.receive());
  CHECK(
      refused(trigger, "<Pause></Pause>")
          .starts_with("port of trigger: expected a CaptureStart or CaptureStop, found <Pause></"));
  CHECK(!caller.receive());
  CHECK(call.counts().refused ==
        std::map<std::string, std::uint64_t>{{"bad_json", 1}, {"wrong_kind", 2}});
}

TEST_CASE("a port that can't be opened is told by whose it is") {
  const UdpSocket taken = *UdpSocket::open("127.0.0.1", 0);
  const std::string port = std::to_string(taken.port());
  RecordingMachine machine;
  const auto error_of = [&](const std::string& device, std::optional<std::uint16_t> marks) {
    RecordingSession::Options options;
    options.lab.devices = {*parse_device(device)};
    options.marks_port = marks;
    const auto session = RecordingSession::open(options, machine.parts());
    REQUIRE(!session);
    return to_string(session.error());
  };
  const std::string why = ": expected a UDP port to serve on at 127.0.0.1:" + port +
                          ", found a port that another program uses";
  CHECK(error_of("mocap=noitom:udp:127.0.0.1:" + port, std::nullopt) == "mocap" + why);
  CHECK(error_of("imu=nodes:udp:127.0.0.1:" + port, std::nullopt) == "imu" + why);
  CHECK(error_of("mocap=noitom:udp:127.0.0.1:0", taken.port()) ==
        "marks: expected a UDP port to serve on at 0.0.0.0:" + port +
            ", found a port that another program uses");
  const TcpPieces listening = *TcpPieces::listen("127.0.0.1", 0);
  const std::string tcp = std::to_string(listening.port());
  CHECK(error_of("mocap=noitom:tcp-listen:127.0.0.1:" + tcp, std::nullopt) ==
        "mocap: expected a TCP port to serve on at 127.0.0.1:" + tcp +
            ", found a port that another program uses");
}

TEST_CASE("a mark before a take stands in its pre-roll") {
  const FreshFolder folder;
  RecordingMachine machine;
  RecordingSession::Options options;
  options.lab.devices = {*parse_device("mocap=noitom:udp:127.0.0.1:0")};
  auto session = RecordingSession::open(options, machine.parts());
  REQUIRE(session);
  (*session)->mark({{Mark::Kind::start, "", std::nullopt, ""}, "keyboard", ""}, (*session)->now());
  start(**session, folder / "a.mcap");
  finish(**session);
  CHECK(payloads_in(folder.read("a.mcap")).at("/marks").size() == 1);
}

TEST_CASE(
    "what a node sends stands in the file, held, doubled and late frames too; exchanges are "
    "those of frames that were taken") {
  RecordingSession::Options options;
  options.node_responder.lab_key = LabKey{7};
  options.lab.devices = {*parse_device("imu=nodes:udp:127.0.0.1:0")};
  options.lab.devices.front().nodes = {{"7", "waist"}};
  LiveSession live({}, options);
  TestNode node(7, 1, LabKey{7});
  node.drift = 0.0;
  node.offset_s = 1000.0;
  node.battery_mv = 3700;
  SystemClocks clocks;
  const Client radio;
  std::uint64_t sent = 0;
  const auto send = [&](const Bytes& frame) {
    radio.send("127.0.0.1", live.port(), frame);
    ++sent;
    live.serve_until([&] { return live.pieces() == sent; });
  };
  const Bytes early = node.frame(clocks.raw());
  // The frame is held, because it has no echo yet.
  for (int k = 0; k < 3; ++k) send(node.frame(clocks.raw()));
  for (int k = 0; k < 3; ++k) {
    const auto reply = radio.receive();
    REQUIRE(reply);
    REQUIRE(node.take_reply(reply->bytes, clocks.raw()));
  }
  const Bytes taken = node.frame(clocks.raw());
  send(taken);
  send(taken);  // twice
  send(early);  // overtaken by four
  Bytes forged = node.frame(clocks.raw());
  forged[30] ^= 1U;
  send(forged);
  send(node.frame(clocks.raw()));
  const auto payloads = live.finish();
  const auto& raw = payloads.at("/imu/7/raw");
  // Three held, one accepted, then a duplicate, a late one and the last: the forged ones do not
  // count.
  CHECK(raw.size() == 7);
  CHECK(raw[5] == std::string(early.begin(), early.end()));
  CHECK(payloads.at("/imu/7/exchange").size() == 3);
  const auto streams = live.session().streams();
  REQUIRE(streams.size() == 1);
  CHECK(streams[0].node == "7");
  CHECK(streams[0].place == "waist");
  CHECK(streams[0].battery_volts == doctest::Approx(3.7));
  CHECK(streams[0].counts.messages == 7);
  CHECK(streams[0].counts.frames == 3);
  CHECK(streams[0].counts.order.duplicates == 1);
  CHECK(streams[0].counts.order.late == 1);
  CHECK(streams[0].counts.order.lost == 1);  // the number that the forged frame skipped
  CHECK(payloads.at("/counts").back().find(R"("node":"7")") != std::string::npos);
}
