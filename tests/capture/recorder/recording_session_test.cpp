// SPDX-License-Identifier: Apache-2.0
// Whole recordings over loopback: what devices send stands in the file.
#include "kinalign/capture/recorder/recording_session.h"

#include "tests/capture/recorded.h"

#include "kinalign/protocols/marks/mark_call.h"
#include "kinalign/protocols/noitom/frame.h"
#include "kinalign/recording/survey.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <poll.h>

#include <algorithm>
#include <atomic>
#include <thread>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

using Machine = RecordingMachine;

DeviceOptions device(const std::string& text) { return *parse_device(text); }

template <class Holds>
void serve_until(RecordingSession& session, const Holds& holds) {
  while (!holds()) session.turn(10ms);  // CTest's own limit ends a test that hangs
}

/// A disk that begins no file for some seconds, or until it is let go.
struct StandsStill : PosixFiles {
  std::atomic<bool> still{true};
  int open(const char* path, int flags, mode_t mode) override {
    for (int ms = 0; still && ms < 5000; ++ms) std::this_thread::sleep_for(1ms);
    return PosixFiles::open(path, flags, mode);
  }
};

std::vector<std::uint8_t> noitom_frame(std::uint32_t index) {
  NoitomFrame frame;
  frame.name = "Char00";
  frame.frame_index = index;
  frame.displacement = true;
  frame.values.assign(354, 1.0F);
  std::vector<std::uint8_t> bytes;
  REQUIRE(append_noitom(frame, bytes));
  return bytes;
}

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
  std::vector<std::string> names{"b.mcap", "a.mcap"};  // as they seem to be free, the last first
  (*session)->start({[&] {
    const std::string name = names.back();
    if (names.size() > 1) names.pop_back();
    return folder / name;
  }});
  finish(**session);
  CHECK((*session)->newest_take()->disk.status().paths ==
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
    return (*session)->newest_take()->disk.status().waiting_bytes > 0;
  });  // a chunk
  CHECK((*session)->newest_take()->disk.status().paths.empty());
  files.still = false;
  finish(**session);
  CHECK((*session)->newest_take()->disk.status().dropped == 0);
  CHECK(payloads_in(folder.read("a.mcap")).at("/mocap/raw").size() == 20);
}

namespace {

std::string call(Mark::Kind kind, int id) {
  return encode_mark_call({kind, "", std::nullopt, std::to_string(id)});
}

/// Of the marks in a file, "start 1".
std::vector<std::string> marks_in(const std::map<std::string, std::vector<std::string>>& payloads) {
  std::vector<std::string> found;
  const auto marks = payloads.find("/marks");
  if (marks == payloads.end()) return found;
  for (const std::string& text : marks->second) {
    const auto json = nlohmann::json::parse(text);
    found.push_back(json.at("kind").get<std::string>() + " " + json.value("id", ""));
  }
  return found;
}

/// The newest that a file's counts say of the suit's port.
std::uint64_t pieces_in(const std::map<std::string, std::vector<std::string>>& payloads) {
  std::uint64_t pieces = 0;
  for (const std::string& text : payloads.at("/counts/ports")) {
    const auto json = nlohmann::json::parse(text);
    if (json.at("stream") == "mocap") pieces = json.at("pieces");
  }
  return pieces;
}

/// Takes by marks on one port and a suit on another; files a0.mcap, a1.mcap, ...
class ByMarks {
 public:
  explicit ByMarks(FileSystem& files) {
    RecordingSession::Options options;
    options.lab.devices = {device("mocap=noitom:udp:127.0.0.1:0"),
                           device("other=noitom:udp:127.0.0.1:0")};
    options.lab.record.pre_roll_s = 0.0;
    options.marks_port = options.trigger_port = 0;
    auto session = RecordingSession::open(options, {files, ports_clock_, nodes_clock_});
    REQUIRE(session);
    session_ = *std::move(session);
    session_->obey_marks({[this] { return folder_ / "a" + std::to_string(named_++) + ".mcap"; }},
                         RecordingSession::Starts::each);
  }
  RecordingSession& session() { return *session_; }
  void say(const std::vector<std::uint8_t>& frame) {
    client_.send("127.0.0.1", session_->ports().front().second, frame);
    const std::uint64_t before = session_->streams().empty() ? 0 : frames();
    serve_until(*session_, [&] { return !session_->streams().empty() && frames() > before; });
  }
  void call_all(const std::vector<std::string>& calls) {
    for (const std::string& text : calls) {
      client_.send("127.0.0.1", session_->ports().at(2).second, bytes_of(text));
    }
  }
  void trigger(const std::string& text) {
    client_.send("127.0.0.1", session_->ports().at(3).second, bytes_of(text));
  }
  /// Frames that nobody waits for.
  void flood(std::uint32_t from, std::uint32_t to) {
    for (std::uint32_t i = from; i < to; ++i) {
      client_.send("127.0.0.1", session_->ports().front().second, noitom_frame(i));
    }
  }
  void say_other(std::uint32_t index) {
    client_.send("127.0.0.1", session_->ports().at(1).second, noitom_frame(index));
  }
  /// Surely earlier and later than all else.
  template <class Send>
  static void apart(Send send) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    send();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  /// Once, as soon as the session has asked for the time so often: before it waits for something to
  /// come, behind that, and when it has read the first device's port.
  void when_asked(int times, std::function<void()> send) {
    ports_clock_.when_asked = std::move(send);
    ports_clock_.still = times;
  }
  void mark(Mark::Kind kind, int id) {
    call_all({call(kind, id)});
    serve_until(*session_, [&] { return !session_->take_marks().empty(); });
  }
  using Payloads = std::map<std::string, std::vector<std::string>>;
  /// Of the next take, in their order.
  std::optional<Payloads> next() {
    const auto take = session_->next_take();
    if (!take) return std::nullopt;
    serve_until(*session_, [&] { return take->disk.status().finished; });
    const std::string name = "a" + std::to_string(asked_++) + ".mcap";
    REQUIRE(take->disk.status().paths == std::vector{folder_ / name});
    return payloads_in(folder_.read(name));
  }
  std::vector<Payloads> payloads() {
    std::vector<Payloads> all;
    while (auto one = next()) all.push_back(*std::move(one));
    return all;
  }

 private:
  std::uint64_t frames() { return session_->streams().at(0).counts.messages; }

  FreshFolder folder_;
  int named_ = 0, asked_ = 0;
  struct AskedClocks : SystemClocks {
    HostTime raw() override {
      if (when_asked && --still == 0) std::exchange(when_asked, nullptr)();
      return SystemClocks::raw();
    }
    std::function<void()> when_asked;
    int still = 0;
  };
  AskedClocks ports_clock_;
  SystemClocks nodes_clock_;
  Client client_;
  std::unique_ptr<RecordingSession> session_;
};

}  // namespace

TEST_CASE("marks that come while a disk stands still begin and end takes of their own") {
  StandsStill files;
  ByMarks lab(files);
  for (int take = 0; take < 3; ++take) {
    lab.mark(Mark::Kind::start, 2 * take);
    lab.say(noitom_frame(static_cast<std::uint32_t>(take)));
    lab.mark(Mark::Kind::stop, 2 * take + 1);
    lab.say(noitom_frame(100));  // between takes
  }
  files.still = false;
  const auto payloads = lab.payloads();
  REQUIRE(payloads.size() == 3);
  for (std::size_t take = 0; take < 3; ++take) {
    const auto frame = noitom_frame(static_cast<std::uint32_t>(take));
    const std::string id = std::to_string(2 * take), next = std::to_string(2 * take + 1);
    CHECK(marks_in(payloads[take]) == std::vector{"start " + id, "stop " + next});
    REQUIRE(!payloads[take].at("/mocap/raw").empty());
    CHECK(payloads[take].at("/mocap/raw").back() == std::string(frame.begin(), frame.end()));
  }
}

TEST_CASE("of marks that come at once each stands in the take that it begins or ends") {
  PosixFiles files;
  ByMarks lab(files);
  using Kind = Mark::Kind;
  lab.call_all({call(Kind::start, 1), call(Kind::stop, 2), call(Kind::start, 3),
                call(Kind::start, 4), call(Kind::stop, 5)});
  std::size_t heard = 0;
  serve_until(lab.session(), [&] { return (heard += lab.session().take_marks().size()) == 5; });
  const auto payloads = lab.payloads();
  REQUIRE(payloads.size() == 2);
  CHECK(marks_in(payloads[0]) == std::vector<std::string>{"start 1", "stop 2"});
  CHECK(marks_in(payloads[1]) == std::vector<std::string>{"start 3", "start 4", "stop 5"});
}

TEST_CASE("a mark of the keyboard stands behind those that came to a port before it") {
  PosixFiles files;
  ByMarks lab(files);
  using Kind = Mark::Kind;
  lab.mark(Kind::start, 1);
  lab.apart([&] { lab.call_all({call(Kind::stop, 2), call(Kind::start, 3)}); });
  lab.session().mark({{Kind::stop, "", std::nullopt, "4"}, "keyboard", ""}, lab.session().now());
  const auto payloads = lab.payloads();
  REQUIRE(payloads.size() == 2);
  CHECK(marks_in(payloads[1]) == std::vector<std::string>{"start 3", "stop 4"});
}

TEST_CASE("marks of several ports are obeyed in the order of their arrival") {
  PosixFiles files;
  ByMarks lab(files);
  lab.mark(Mark::Kind::start, 1);
  lab.trigger(R"(<CaptureStop RESULT="SUCCESS"><PacketID VALUE="2"/></CaptureStop>)");
  lab.mark(Mark::Kind::start, 3);
  lab.mark(Mark::Kind::stop, 4);
  const auto payloads = lab.payloads();
  REQUIRE(payloads.size() == 2);
  CHECK(marks_in(payloads[1]) == std::vector<std::string>{"start 3", "stop 4"});
}

TEST_CASE("what had reached the machine when a mark ends a take stands in its file") {
  PosixFiles files;
  ByMarks lab(files);
  lab.mark(Mark::Kind::start, 1);
  constexpr std::uint32_t sent = 150;  // more than a turn reads
  lab.flood(0, sent);
  lab.mark(Mark::Kind::stop, 2);
  const auto payloads = lab.payloads();
  REQUIRE(payloads.size() == 1);
  const std::uint64_t dropped = lab.session().port_counts().front().second.dropped;
  CHECK(payloads[0].at("/mocap/raw").size() + dropped == sent);
  CHECK(payloads[0].at("/mocap/raw").size() > 128);
}

TEST_CASE("what arrives behind a stop is the next take's, whenever it is read") {
  PosixFiles files;
  ByMarks lab(files);
  const auto flood = [&](std::uint32_t from, std::uint32_t to) {
    lab.apart([&] { lab.flood(from, to); });
  };
  lab.mark(Mark::Kind::start, 1);
  flood(0, 40);
  lab.call_all({call(Mark::Kind::stop, 2)});
  flood(40, 50);
  lab.call_all({call(Mark::Kind::start, 3)});
  flood(50, 80);
  lab.mark(Mark::Kind::stop, 4);
  const auto payloads = lab.payloads();
  REQUIRE(payloads.size() == 2);
  const auto frames = [&](std::size_t take) { return payloads[take].at("/mocap/raw"); };
  CHECK(frames(0).size() == 40);
  CHECK(frames(1).size() == 40);
  const auto first = noitom_frame(40);
  CHECK(frames(1).front() == std::string(first.begin(), first.end()));
}

TEST_CASE(
    "what arrives behind each of several stops is no more the ended take's, read all at once") {
  PosixFiles files;
  ByMarks lab(files);
  lab.mark(Mark::Kind::start, 0);
  std::uint32_t sent = 0;
  for (int take = 0; take < 3; ++take) {
    lab.apart([&] { lab.flood(sent, sent + 10); });
    lab.apart([&] { lab.call_all({call(Mark::Kind::stop, 3 * take + 1)}); });
    lab.apart([&] { lab.flood(sent + 10, sent + 15); });
    lab.apart([&] { lab.call_all({call(Mark::Kind::start, 3 * take + 2)}); });
    sent += 15;
  }
  lab.mark(Mark::Kind::stop, 100);
  const auto payloads = lab.payloads();
  REQUIRE(payloads.size() == 4);
  for (std::size_t take = 0; take < 4; ++take) {
    const auto ended = payloads[take].find("/mocap/raw");
    const std::vector<std::string> frames =
        ended == payloads[take].end() ? std::vector<std::string>() : ended->second;
    CAPTURE(take);
    CHECK(frames.size() == (take == 0 ? 10U : take == 3 ? 5U : 15U));
    CHECK(pieces_in(payloads[take]) == frames.size());
  }
}

TEST_CASE("a stop that arrives while devices are read parts what comes before it and behind") {
  for (const int times : {2, 3}) {
    CAPTURE(times);
    PosixFiles files;
    ByMarks lab(files);
    lab.mark(Mark::Kind::start, 1);
    lab.say(noitom_frame(0));
    lab.flood(1, 2);
    lab.say_other(1);
    lab.when_asked(times, [&] {
      lab.apart([&] { lab.call_all({call(Mark::Kind::stop, 2)}); });
      lab.apart([&] { lab.say_other(2); });
    });
    serve_until(lab.session(), [&] { return !lab.session().recording(); });
    lab.mark(Mark::Kind::start, 3);
    lab.mark(Mark::Kind::stop, 4);
    const auto payloads = lab.payloads();
    REQUIRE(payloads.size() == 2);
    CHECK(payloads[0].at("/mocap/raw").size() == 2);
    CHECK(payloads[0].at("/other/raw").size() == 1);
  }
}

TEST_CASE("more takes than may wait for the disk become one, and nothing is lost") {
  StandsStill files;
  ByMarks lab(files);
  constexpr int rounds = 2 * TakeQueue::most;
  for (int k = 0; k < rounds; ++k) {
    lab.mark(Mark::Kind::start, 2 * k);
    lab.say(noitom_frame(static_cast<std::uint32_t>(k)));
    lab.mark(Mark::Kind::stop, 2 * k + 1);
  }
  const Findings findings = lab.session().take_findings();
  REQUIRE(findings.size() == 1);
  CHECK(findings.front().what.expected == "at most 32 takes that wait for the disk");
  files.still = false;
  std::vector payloads{lab.next().value()};  // now another may wait
  int stops = 0;
  for (; lab.session().recording(); ++stops) lab.mark(Mark::Kind::stop, 2 * rounds + stops);
  for (auto& one : lab.payloads()) payloads.push_back(std::move(one));
  CHECK(payloads.size() == TakeQueue::most);
  std::size_t frames = 0, marks = 0;
  for (const auto& take : payloads) {
    frames += take.at("/mocap/raw").size();
    marks += take.at("/marks").size();
  }
  CHECK(frames == rounds);
  CHECK(marks == static_cast<std::size_t>(2 * rounds + stops));
}

TEST_CASE("after a take that began by a mark no start begins another one unless it was asked for") {
  LiveSession live({"mocap=noitom:udp:127.0.0.1:0"});
  RecordingSession& session = live.session();
  const auto mark = [&](Mark::Kind kind) {
    session.mark({Mark{kind, "", std::nullopt, ""}, "keyboard", ""}, session.now());
  };
  mark(Mark::Kind::stop);
  CHECK(session.recording());  // that one was not begun by a mark
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
  constexpr int sent = 1000;  // several turns' worth; what the kernel has no room for it counts
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
  (*session)->newest_take()->disk.give_up();
  finish(**session);
  CHECK((*session)->newest_take()->disk.status().refused->file == folder / "a.mcap");
  CHECK((*session)->newest_take()->disk.status().paths.empty());
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
  CHECK(payloads.at("/mocap/raw").size() == 6);  // all that came, whatever was thought of it
}
