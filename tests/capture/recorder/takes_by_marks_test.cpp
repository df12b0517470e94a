// SPDX-License-Identifier: Apache-2.0
// Takes that marks begin and end: each message and each mark is in the take to which it belongs.
#include "tests/capture/recorder/sessions.h"

#include "kinalign/protocols/marks/mark_call.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <numeric>
#include <optional>
#include <random>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

using Kind = Mark::Kind;

std::string call(Kind kind, int id) {
  return encode_mark_call({kind, "", std::nullopt, std::to_string(id)});
}

/// The contents of one take's file.
struct TakeContents {
  std::vector<std::string> marks;  // kind and id: "start 1"
  std::vector<int> messages;       // numbers of the suit's messages, in their order
  std::uint64_t pieces = 0;        // newest count for the suit's port
};

TakeContents contents_of(const std::string& file) {
  auto payloads = payloads_in(file);
  TakeContents contents;
  for (const std::string& text : payloads["/marks"]) {
    const auto json = nlohmann::json::parse(text);
    contents.marks.push_back(json.at("kind").get<std::string>() + " " + json.value("id", ""));
  }
  for (const std::string& text : payloads["/mocap/raw"])
    contents.messages.push_back(std::stoi(text));
  for (const std::string& text : payloads["/counts/ports"]) {
    const auto json = nlohmann::json::parse(text);
    if (json.at("stream") == "mocap") contents.pieces = json.at("pieces");
  }
  return contents;
}

std::vector<int> numbers(int from, int to) {
  std::vector<int> all(static_cast<std::size_t>(to - from));
  std::iota(all.begin(), all.end(), from);
  return all;
}

/// A session with a suit's port and two ports for marks. Its takes are the files a0.mcap, a1.mcap,
/// ... The suit's messages are numbers.
class ByMarks {
 public:
  ByMarks(FileSystem& files, double pre_roll_s) {
    RecordingSession::Options options;
    options.lab.devices = {device("mocap=noitom:udp:127.0.0.1:0")};
    options.lab.record.pre_roll_s = pre_roll_s;
    options.marks_port = options.trigger_port = 0;
    auto session = RecordingSession::open(options, {files, ports_clock_, nodes_clock_});
    REQUIRE(session);
    session_ = *std::move(session);
    session_->obey_marks({[this] { return folder_ / "a" + std::to_string(named_++) + ".mcap"; }},
                         RecordingSession::Starts::each);
  }
  RecordingSession& session() { return *session_; }
  /// Sends further messages without waiting until they are recorded.
  void send(int messages) {
    for (int i = 0; i < messages; ++i) {
      client_.send("127.0.0.1", session_->ports().front().second,
                   bytes_of(std::to_string(sent_++)));
    }
  }
  int sent() const { return sent_; }
  void send_mark(Kind kind, int id) {
    client_.send("127.0.0.1", session_->ports().at(1).second, bytes_of(call(kind, id)));
  }
  void trigger(const std::string& text) {
    client_.send("127.0.0.1", session_->ports().at(2).second, bytes_of(text));
  }
  void mark(Kind kind, int id) {
    send_mark(kind, id);
    serve_until(*session_, [&] { return !session_->take_marks().empty(); });
  }
  /// The contents of the oldest take that is not yet read, once it has ended and is written.
  std::optional<TakeContents> next() {
    if (session_->takes().empty()) return std::nullopt;
    const auto take = session_->takes().front();
    serve_until(*session_, [&] { return take->disk.status().finished; });
    session_->release_take();
    const std::string name = "a" + std::to_string(read_++) + ".mcap";
    REQUIRE(take->disk.status().paths == std::vector{folder_ / name});
    return contents_of(folder_.read(name));
  }
  std::vector<TakeContents> takes() {
    std::vector<TakeContents> all;
    while (auto one = next()) all.push_back(*std::move(one));
    return all;
  }

 private:
  FreshFolder folder_;
  int named_ = 0, read_ = 0, sent_ = 0;
  SystemClocks ports_clock_, nodes_clock_;
  Client client_;
  std::unique_ptr<RecordingSession> session_;
};

}  // namespace

TEST_CASE("marks that come at once are each in the take that they begin or end") {
  PosixFiles files;
  ByMarks lab(files, 0.0);
  lab.send_mark(Kind::start, 1);
  lab.send_mark(Kind::stop, 2);
  lab.send_mark(Kind::start, 3);
  lab.send_mark(Kind::start, 4);
  lab.send_mark(Kind::stop, 5);
  std::size_t received = 0;
  serve_until(lab.session(), [&] { return (received += lab.session().take_marks().size()) == 5; });
  const auto takes = lab.takes();
  REQUIRE(takes.size() == 2);
  CHECK(takes[0].marks == std::vector<std::string>{"start 1", "stop 2"});
  CHECK(takes[1].marks == std::vector<std::string>{"start 3", "start 4", "stop 5"});
}

TEST_CASE("marks of several ports are obeyed in the order of their arrival") {
  PosixFiles files;
  ByMarks lab(files, 0.0);
  lab.mark(Kind::start, 1);
  lab.trigger(R"(<CaptureStop RESULT="SUCCESS"><PacketID VALUE="2"/></CaptureStop>)");
  std::this_thread::sleep_for(50ms);  // a loaded kernel may deliver it that late
  lab.mark(Kind::start, 3);
  lab.mark(Kind::stop, 4);
  const auto takes = lab.takes();
  REQUIRE(takes.size() == 2);
  CHECK(takes[1].marks == std::vector<std::string>{"start 3", "stop 4"});
}

TEST_CASE("all data that has arrived when a stop is read is in the take, and is counted there") {
  PosixFiles files;
  ByMarks lab(files, 0.0);
  lab.mark(Kind::start, 1);
  lab.send(150);  // more than one turn reads
  lab.mark(Kind::stop, 2);
  const auto takes = lab.takes();
  REQUIRE(takes.size() == 1);
  const std::uint64_t dropped = lab.session().port_counts().front().second.dropped;
  CHECK(takes[0].messages.size() + dropped == 150);
  CHECK(takes[0].messages.size() > 128);
  CHECK(takes[0].pieces == takes[0].messages.size());
}

TEST_CASE("each message is in one take, and in the one of its stop, whichever turn reads it") {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    std::mt19937 random(seed);
    PosixFiles files;
    ByMarks lab(files, 60.0);  // the pre-roll takes all data between takes
    std::vector<TakeContents> takes;
    for (int step = 0; step < 40; ++step) {
      lab.send(1 + static_cast<int>(random() % 8));
      // The id of a mark says how many messages were sent before it.
      if (random() % 2 == 0)
        lab.send_mark(random() % 2 == 0 ? Kind::start : Kind::stop, lab.sent());
      if (random() % 2 == 0) lab.session().turn(0ms);
      const auto& open = lab.session().takes();
      if (!open.empty() && open.front()->disk.status().finished) takes.push_back(*lab.next());
    }
    for (const Kind kind : {Kind::start, Kind::stop}) {
      lab.send(1);
      lab.mark(kind, lab.sent());
    }
    for (TakeContents& take : lab.takes()) takes.push_back(std::move(take));
    std::vector<int> messages;
    for (const TakeContents& take : takes) {
      messages.insert(messages.end(), take.messages.begin(), take.messages.end());
      CHECK(take.pieces == take.messages.size());
      const std::string& last = take.marks.back();
      REQUIRE(last.starts_with("stop "));
      CHECK(messages.size() >= std::stoul(last.substr(5)));
    }
    CHECK(messages == numbers(0, lab.sent()));
  }
}

TEST_CASE("while a disk stands still a second take is kept, and ends when the first is written") {
  StandsStill files;
  ByMarks lab(files, 60.0);
  lab.mark(Kind::start, 0);
  lab.send(10);
  lab.mark(Kind::stop, 1);
  lab.send(10);
  lab.mark(Kind::start, 2);
  lab.mark(Kind::stop, 3);
  CHECK(lab.session().recording());
  lab.send(10);
  CHECK(lab.session().take_findings().empty());
  SUBCASE("") { files.still = false; }
  SUBCASE("a start that comes before continues the second take") {
    lab.mark(Kind::start, 4);
    const Findings findings = lab.session().take_findings();
    REQUIRE(findings.size() == 1);
    CHECK(findings.front().what.expected == "a start mark after the previous take is on the disk");
    files.still = false;
    lab.mark(Kind::stop, 5);
  }
  const auto takes = lab.takes();
  REQUIRE(takes.size() == 2);
  CHECK(takes[0].marks == std::vector<std::string>{"start 0", "stop 1"});
  CHECK(takes[0].messages == numbers(0, 10));
  CHECK(takes[1].messages == numbers(10, 30));
  CHECK(takes[1].marks.front() == "start 2");
  CHECK(takes[1].marks.size() % 2 == 0);
}
