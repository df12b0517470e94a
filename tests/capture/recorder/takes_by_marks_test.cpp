// SPDX-License-Identifier: Apache-2.0
// Takes that marks begin and end: each message and each mark is in the take to which it belongs.
#include "tests/capture/recorder/sessions.h"

#include "kinalign/protocols/marks/mark_call.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <functional>
#include <optional>
#include <utility>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

std::string call(Mark::Kind kind, int id) {
  return encode_mark_call({kind, "", std::nullopt, std::to_string(id)});
}

/// The marks in a file, each as kind and number: "start 1".
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

/// The newest count of pieces for the suit's port in a file.
std::uint64_t pieces_in(const std::map<std::string, std::vector<std::string>>& payloads) {
  std::uint64_t pieces = 0;
  for (const std::string& text : payloads.at("/counts/ports")) {
    const auto json = nlohmann::json::parse(text);
    if (json.at("stream") == "mocap") pieces = json.at("pieces");
  }
  return pieces;
}

/// A session with a port for marks and a port for a suit; its takes are the files a0.mcap, a1.mcap,
/// ...
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
  /// Sends frames without waiting until they are recorded.
  void flood(std::uint32_t from, std::uint32_t to) {
    for (std::uint32_t i = from; i < to; ++i) {
      client_.send("127.0.0.1", session_->ports().front().second, noitom_frame(i));
    }
  }
  void say_other(std::uint32_t index) {
    client_.send("127.0.0.1", session_->ports().at(1).second, noitom_frame(index));
  }
  /// Sends with a pause before and after, so that the time surely differs from all other times.
  template <class Send>
  static void apart(Send send) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    send();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  /// Calls `send` once, when the session has asked for the time that many times: before it waits
  /// for datagrams, after that, and when it has read the first device's port.
  void when_asked(int times, std::function<void()> send) {
    ports_clock_.when_asked = std::move(send);
    ports_clock_.still = times;
  }
  void mark(Mark::Kind kind, int id) {
    call_all({call(kind, id)});
    serve_until(*session_, [&] { return !session_->take_marks().empty(); });
  }
  using Payloads = std::map<std::string, std::vector<std::string>>;
  /// The messages of the next take, in their order; nothing if there is no further take.
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
  constexpr std::uint32_t sent = 150;  // more than one turn of the loop reads
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
