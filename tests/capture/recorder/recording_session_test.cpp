// SPDX-License-Identifier: Apache-2.0
// Whole recordings over loopback: the data that devices send are in the file.
#include "kinalign/capture/recorder/recording_session.h"

#include "tests/capture/recorder/sessions.h"
#include "tests/recording/survey_recording.h"

#include "kinalign/protocols/marks/mark_call.h"
#include "kinalign/recording/survey.h"

#include <doctest/doctest.h>
#include <poll.h>

#include <algorithm>
#include <thread>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

using Machine = RecordingMachine;

}  // namespace

TEST_CASE("datagrams of several senders stand in the file, each sender's on a channel") {
  const FreshFolder folder;
  Machine machine;
  RecordingSession::Options options;
  options.lab.devices = {device("mocap=noitom:udp:127.0.0.1:0")};
  auto session = RecordingSession::open(options, machine.parts());
  REQUIRE(session);
  const std::uint16_t port = (*session)->ports().front().second;
  const Client one, two;
  start(**session, folder / "a.mcap", "03", "S1A02");
  for (int i = 0; i < 50; ++i) {
    one.send("127.0.0.1", port, bytes_of("one " + std::to_string(i)));
    serve_until(**session, [&] {
      return (*session)->port_counts().front().second.pieces == std::uint64_t(i) * 2 + 1;
    });
    two.send("127.0.0.1", port, bytes_of("two " + std::to_string(i)));
    serve_until(**session, [&] {
      return (*session)->port_counts().front().second.pieces == std::uint64_t(i) * 2 + 2;
    });
  }
  const auto streams = (*session)->streams();
  REQUIRE(streams.size() == 2);
  CHECK(streams[0].counts.messages == 50);
  CHECK(streams[0].stream == "mocap");
  finish(**session);
  const auto payloads = payloads_in(folder.read("a.mcap"));
  REQUIRE(payloads.at("/mocap/raw").size() == 50);
  REQUIRE(payloads.at("/mocap/raw/2").size() == 50);
  CHECK(payloads.at("/mocap/raw")[49] == "one 49");
  CHECK(payloads.at("/mocap/raw/2")[0] == "two 0");
  CHECK(!payloads.at("/clock/host").empty());
}

TEST_CASE("what a device says over TCP stands in the file byte for byte, also after it returned") {
  const FreshFolder folder;
  Machine machine;
  RecordingSession::Options options;
  options.lab.devices = {device("kinect=kinect:tcp-listen:127.0.0.1:0")};
  auto session = RecordingSession::open(options, machine.parts());
  REQUIRE(session);
  const std::uint16_t port = (*session)->ports().front().second;
  start(**session, folder / "a.mcap");
  std::string sent;
  for (int life = 0; life < 2; ++life) {
    const Connection device_itself(port);
    const std::string text(100'000, static_cast<char>('a' + life));
    std::thread sender([&] { device_itself.send(text); });
    sent += text;
    serve_until(**session,
                [&] { return (*session)->port_counts().front().second.bytes == sent.size(); });
    sender.join();
  }
  finish(**session);
  std::string found;
  for (const auto& [topic, payloads] : payloads_in(folder.read("a.mcap"))) {
    if (!topic.starts_with("/kinect")) continue;
    for (const std::string& payload : payloads) found += payload;
  }
  CHECK(found == sent);
}

TEST_CASE("a device is let in where as many connections as there may be stand idle") {
  LiveSession live({"kinect=kinect:tcp-listen:127.0.0.1:0"});
  std::vector<std::unique_ptr<Connection>> idle;
  for (std::uint64_t k = 1; k <= 8; ++k) {
    idle.push_back(std::make_unique<Connection>(live.port()));
    idle.back()->send("vanished\n");
    live.serve_until([&] { return live.pieces() == k; });
  }
  const auto counts = [&] { return live.session().port_counts().front().second; };
  const Connection too_soon(live.port());
  live.serve_until([&] { return counts().refused == 1; });
  const auto begun = std::chrono::steady_clock::now();
  live.serve_until([&] { return std::chrono::steady_clock::now() - begun > 3200ms; });
  const Connection returned(live.port());
  returned.send("back\n");
  live.serve_until([&] { return live.pieces() == 9; });
  CHECK(counts().refused == 1);
}

TEST_CASE("each connection to a device that serves has a channel of its own") {
  const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in own{};
  own.sin_family = AF_INET;
  own.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof own;
  REQUIRE(::bind(listener, reinterpret_cast<const sockaddr*>(&own), sizeof own) == 0);
  REQUIRE(::listen(listener, 1) == 0);
  REQUIRE(::getsockname(listener, reinterpret_cast<sockaddr*>(&own), &size) == 0);
  LiveSession live({"kinect=kinect:tcp:127.0.0.1:" + std::to_string(ntohs(own.sin_port))});
  std::uint64_t pieces = 0;
  for (const std::string text : {"{\"half a mess", "whole"}) {
    pollfd waiting{listener, POLLIN, 0};
    live.serve_until([&] { return ::poll(&waiting, 1, 0) == 1; });
    const int device_itself = ::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC);
    REQUIRE(::write(device_itself, text.data(), text.size()) == static_cast<ssize_t>(text.size()));
    ++pieces;
    live.serve_until([&] { return live.pieces() == pieces; });
    ::close(device_itself);
  }
  ::close(listener);
  const auto streams = live.session().streams();
  REQUIRE(streams.size() == 2);
  CHECK(streams[0].sender == streams[1].sender);
  const auto payloads = live.finish();
  CHECK(payloads.at("/kinect/raw").size() == 1);
  CHECK(payloads.at("/kinect/raw/2") == std::vector<std::string>{"whole"});
}

TEST_CASE("a name that another recorder takes first is left to it") {
  const FreshFolder folder;
  RecordingMachine machine;
  RecordingSession::Options options;
  options.lab.devices.push_back(*parse_device("kinect=kinect:udp:127.0.0.1:0"));
  auto session = RecordingSession::open(std::move(options), machine.parts());
  REQUIRE(session);
  folder.write("a.mcap", "another's");
  // Names that seemed free when they were chosen; the last is tried first.
  std::vector<std::string> names{"b.mcap", "a.mcap"};
  (*session)->start({[&] {
    const std::string name = names.back();
    if (names.size() > 1) names.pop_back();
    return folder / name;
  }});
  finish(**session);
  CHECK((*session)->takes().back()->disk.status().paths ==
        std::vector<std::string>{folder / "b.mcap"});
  CHECK(folder.read("a.mcap") == "another's");
}

TEST_CASE("while a disk takes its time to begin a take's file, what comes is received and kept") {
  const FreshFolder folder;
  StandsStill files;
  SystemClocks ports_clock, nodes_clock;
  RecordingSession::Options options;
  options.lab.devices = {device("mocap=noitom:udp:127.0.0.1:0")};
  options.lab.record.pre_roll_s = 0.0;
  auto session = RecordingSession::open(options, {files, ports_clock, nodes_clock});
  REQUIRE(session);
  const std::uint16_t port = (*session)->ports().front().second;
  const Client one;
  start(**session, folder / "a.mcap");
  const auto came = [&] { return (*session)->port_counts().front().second.pieces; };
  for (std::uint32_t index = 1; index <= 20; ++index) {
    one.send("127.0.0.1", port, noitom_frame(index));
    serve_until(**session, [&] { return came() == index; });
  }
  serve_until(**session, [&] {
    return (*session)->takes().back()->disk.status().waiting_bytes > 0;
  });  // a chunk
  CHECK((*session)->takes().back()->disk.status().paths.empty());
  files.still = false;
  finish(**session);
  CHECK((*session)->takes().back()->disk.status().dropped == 0);
  CHECK(payloads_in(folder.read("a.mcap")).at("/mocap/raw").size() == 20);
}

TEST_CASE("after a take that began by a mark no start begins another one unless it was asked for") {
  LiveSession live({"mocap=noitom:udp:127.0.0.1:0"});
  RecordingSession& session = live.session();
  const auto mark = [&](Mark::Kind kind) {
    session.mark({Mark{kind, "", std::nullopt, ""}, "keyboard", ""}, session.now());
  };
  mark(Mark::Kind::stop);
  CHECK(session.recording());  // the recording was not begun by a mark, so a mark does not end it
  live.finish();
  session.obey_marks({[] { return std::string("/none/a.mcap"); }}, RecordingSession::Starts::next);
  mark(Mark::Kind::start);
  CHECK(session.recording());
  mark(Mark::Kind::stop);
  CHECK(!session.recording());
  mark(Mark::Kind::start);
  CHECK(!session.recording());
}

TEST_CASE("what had reached the machine when a take is ended stands in the file") {
  RecordingSession::Options options;
  options.marks_port = 0;
  LiveSession live({"mocap=noitom:udp:127.0.0.1:0"}, options);
  const Client one;
  // More than one turn reads; the session counts what the kernel has no room for.
  constexpr int sent = 1000;
  for (int i = 0; i < sent; ++i) one.send("127.0.0.1", live.port(), bytes_of(std::to_string(i)));
  one.send("127.0.0.1", live.session().ports().back().second,
           bytes_of(encode_mark_call({Mark::Kind::stop, "", std::nullopt, "1"})));
  const auto payloads = live.finish();
  const auto& raw = payloads.at("/mocap/raw");
  CHECK(raw.size() + live.session().port_counts().front().second.dropped == sent);
  CHECK(raw.size() > 100);
  CHECK(payloads.at("/marks").size() == 1);
}

TEST_CASE("a take's counts begin with it") {
  const FreshFolder folder;
  Machine machine;
  RecordingSession::Options options;
  options.lab.devices = {device("mocap=noitom:udp:127.0.0.1:0")};
  options.lab.record.pre_roll_s = 0.0;
  auto session = RecordingSession::open(options, machine.parts());
  REQUIRE(session);
  const std::uint16_t port = (*session)->ports().front().second;
  const Client one;
  std::uint64_t sent = 0;
  const auto say = [&](std::uint32_t index) {
    one.send("127.0.0.1", port, noitom_frame(index));
    ++sent;
  };
  const auto came = [&] { return (*session)->port_counts().front().second.pieces; };
  start(**session, folder / "a.mcap");
  for (const std::uint32_t index : {1U, 5U}) say(index);  // 2 to 4 lost
  serve_until(**session, [&] { return came() == 2; });
  finish(**session);
  CHECK((*session)->streams().at(0).counts.order.lost == 3);
  start(**session, folder / "b.mcap");
  CHECK((*session)->streams().at(0).counts.messages == 0);
  for (const std::uint32_t index : {6U, 8U}) say(index);  // 7 lost
  serve_until(**session, [&] { return came() == 2; });
  finish(**session);
  PosixFiles files;
  const auto survey = survey_recording(files, folder / "b.mcap");
  REQUIRE(survey);
  REQUIRE(survey->senders.size() == 1);
  CHECK(survey->senders[0].topic == "/mocap/raw");
  CHECK(survey->senders[0].counts.messages == 2);
  CHECK(survey->senders[0].counts.order.lost == 1);
  REQUIRE(survey->ports.size() == 1);
  CHECK(survey->ports[0].counts.pieces == 2);
}

TEST_CASE("a take's counts are those of the messages in its file, whatever its pre-roll reaches") {
  for (const double pre_roll_s : {0.0, 0.3, 5.0}) {
    CAPTURE(pre_roll_s);
    const FreshFolder folder;
    Machine machine;
    RecordingSession::Options options;
    options.lab.devices = {device("mocap=noitom:udp:127.0.0.1:0")};
    options.lab.record.pre_roll_s = pre_roll_s;
    auto session = RecordingSession::open(options, machine.parts());
    REQUIRE(session);
    const std::uint16_t port = (*session)->ports().front().second;
    const Client one;
    std::uint32_t sent = 0;
    const auto say_for = [&](Duration length) {
      const HostTime end = (*session)->now() + length;
      while ((*session)->now() < end) {
        one.send("127.0.0.1", port, noitom_frame(sent++));
        (*session)->turn(2ms);
      }
    };
    for (const std::string name : {"a.mcap", "b.mcap"}) {
      say_for(900ms);
      start(**session, folder / name);
      say_for(200ms);
      finish(**session);
      PosixFiles files;
      const auto survey = survey_recording(files, folder / name);
      REQUIRE(survey);
      REQUIRE(survey->senders.size() == 1);
      const auto raw =
          std::find_if(survey->channels.begin(), survey->channels.end(),
                       [](const auto& channel) { return channel.channel.topic == "/mocap/raw"; });
      REQUIRE(raw != survey->channels.end());
      CHECK(survey->senders[0].counts.messages == raw->messages);
      CHECK(survey->senders[0].counts.frames == raw->messages);
      CHECK(survey->ports.at(0).counts.pieces == raw->messages);
    }
  }
}

TEST_CASE("a second take needs a name of its own, and has its own file") {
  const FreshFolder folder;
  Machine machine;
  RecordingSession::Options options;
  options.lab.devices = {device("mocap=noitom:udp:127.0.0.1:0")};
  auto session = RecordingSession::open(options, machine.parts());
  REQUIRE(session);
  start(**session, folder / "a.mcap");
  finish(**session);
  start(**session, folder / "a.mcap");
  (*session)->takes().back()->disk.give_up();
  finish(**session);
  CHECK((*session)->takes().back()->disk.status().refused->file == folder / "a.mcap");
  CHECK((*session)->takes().back()->disk.status().paths.empty());
  start(**session, folder / "b.mcap");
  finish(**session);
  CHECK(read_mcap(folder.read("a.mcap")).closed);
  CHECK(read_mcap(folder.read("b.mcap")).closed);
}

TEST_CASE("what a sender's own numbers miss is counted while recording, and in the file") {
  const FreshFolder folder;
  Machine machine;
  RecordingSession::Options options;
  options.lab.devices = {device("mocap=noitom:udp:127.0.0.1:0")};
  auto session = RecordingSession::open(options, machine.parts());
  REQUIRE(session);
  const std::uint16_t port = (*session)->ports().front().second;
  const Client one;
  start(**session, folder / "a.mcap");
  std::uint64_t sent = 0;
  for (const std::uint32_t index : {10U, 11U, 14U, 13U, 14U, 15U}) {  // 12 lost, 13 late, 14 twice
    one.send("127.0.0.1", port, noitom_frame(index));
    ++sent;
    serve_until(**session, [&] { return (*session)->port_counts().front().second.pieces == sent; });
  }
  finish(**session);
  const SenderCounts counts = (*session)->streams().at(0).counts;
  CHECK(counts.frames == 6);
  CHECK(counts.order.lost == 1);
  CHECK(counts.order.late == 1);
  CHECK(counts.order.duplicates == 1);
  const auto payloads = payloads_in(folder.read("a.mcap"));
  REQUIRE(!payloads.at("/counts").empty());
  CHECK(payloads.at("/counts").back().find(R"("lost":1,"late":1,"duplicates":1)") !=
        std::string::npos);
  CHECK(payloads.at("/mocap/raw").size() == 6);  // all datagrams that came, accepted or not
}
