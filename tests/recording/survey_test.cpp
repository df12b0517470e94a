// SPDX-License-Identifier: Apache-2.0
// The counts and facts of the recorder are in its file, and the survey finds them.
#include "kinalign/recording/survey.h"

#include "tests/folder.h"
#include "tests/mcap/mcap_files.h"
#include "tests/recording/survey_recording.h"

#include <doctest/doctest.h>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

/// A recording that has only the recorder's own channels.
class Told {
 public:
  Told() {
    REQUIRE(writer_.begin({std::string(recording_profile), "test"}));
    RecordingFacts facts;
    facts.anchor = {HostTime{1000s}, Time{1'700'000'000s}};
    REQUIRE(writer_.write(to_metadata(facts)));
    REQUIRE(writer_.write(to_metadata(ExpectedDevices{{"mocap", true}, {"imu/7", false}})));
  }
  void attach(const std::string& name, const std::string& text) {
    REQUIRE(writer_.write(McapAttachment{at_, at_, name, "application/toml", text}));
  }
  void add(const McapChannel& channel) {
    McapChunkContent chunk;
    chunk.add(channel);
    REQUIRE(writer_.write(store(chunk, McapCompression::none)));
  }
  void add(std::uint16_t id, std::string_view topic, const std::string& json) {
    McapChunkContent chunk;
    chunk.add(McapChannel{id, 0, std::string(topic), "json", {}});
    chunk.add(McapMessage{id, number_++, at_++, at_, json});
    REQUIRE(writer_.write(store(chunk, McapCompression::none)));
  }
  RecordingSurvey survey() {
    REQUIRE(writer_.finish());
    const FreshFolder folder;
    PosixFiles files;
    auto survey = survey_recording(files, folder.write("a.mcap", file_.bytes));
    REQUIRE(survey);
    return *survey;
  }

 private:
  MemoryFile file_;
  McapWriter writer_{file_.store()};
  std::uint32_t number_ = 0;
  std::uint64_t at_ = 1'700'000'000'000'000'000;
};

SenderCounts counts(std::uint64_t messages) {
  SenderCounts out;
  out.messages = messages;
  out.bytes = 10 * messages;
  out.frames = messages - 1;
  out.order = {};
  out.order.lost = 3;
  out.order.late = 2;
  out.order.duplicates = 1;
  out.order.restarts = 4;
  out.refused = 5;
  return out;
}

}  // namespace

TEST_CASE("where nodes are worn is what their channels say, or the lab's file") {
  Told told;
  told.attach("lab.toml",
              "[device.imu]\nprotocol = \"nodes\"\nport = 5005\n"
              "nodes = { \"7\" = \"waist\", \"12\" = \"wrist\" }\n");
  McapChannel channel = to_channel("/imu/8/raw", {"imu", "kinalign-node", "udp", "", "8", "head"});
  channel.id = 3;
  told.add(channel);
  CHECK(told.survey().places == std::map<std::string, std::string>{
                                    {"imu/7", "waist"}, {"imu/8", "head"}, {"imu/12", "wrist"}});
  Told another;
  another.attach("lab.toml", "[device.imu\n");
  CHECK(another.survey().places.empty());
}

TEST_CASE("of each sender and each port the last counts are found, whatever they are called") {
  Told told;
  for (const std::uint64_t n : {10U, 20U, 30U}) {
    told.add(1, sender_counts_topic, to_json({"/mocap/raw", "mocap", "10.0.0.1:7", "", counts(n)}));
    told.add(1, sender_counts_topic,
             to_json({"/imu/7/raw", "imu", "10.0.0.2:7", "7", counts(n + 1)}));
    told.add(1, sender_counts_topic,
             to_json({"/imu/8/raw", "imu", "10.0.0.2:7", "8", counts(n + 2)}));
    PortCounts port;
    port.pieces = n;
    port.dropped = n / 10;
    told.add(2, port_counts_topic, to_json(CountedPort{"\"messages\":", port}));
    port.sifted = true;
    told.add(2, port_counts_topic, to_json(CountedPort{"imu", port}));
  }
  const RecordingSurvey survey = told.survey();
  REQUIRE(survey.senders.size() == 3);
  CHECK(survey.senders[0].stream == "imu");
  CHECK(survey.senders[0].node == "7");
  CHECK(survey.senders[0].counts.messages == 31);
  CHECK(survey.senders[2].stream == "mocap");
  CHECK(survey.senders[2].sender == "10.0.0.1:7");
  const SenderCounts& mocap = survey.senders[2].counts;
  CHECK(mocap.messages == 30);
  CHECK(mocap.bytes == 300);
  CHECK(mocap.frames == 29);
  CHECK(mocap.order.lost == 3);
  CHECK(mocap.order.late == 2);
  CHECK(mocap.order.duplicates == 1);
  CHECK(mocap.order.restarts == 4);
  CHECK(mocap.refused == 5);
  REQUIRE(survey.ports.size() == 2);
  CHECK(survey.ports[0].stream == "\"messages\":");
  CHECK(survey.ports[0].counts.dropped == 3);
  CHECK(!survey.ports[0].counts.sifted);
  CHECK(survey.ports[1].counts.sifted);
}

TEST_CASE("two connections of one device, made one after another, are counted each") {
  Told told;
  told.add(1, sender_counts_topic, to_json({"/mocap/raw", "mocap", "10.0.0.1:7", "", counts(10)}));
  told.add(1, sender_counts_topic, to_json({"/mocap/raw/2", "mocap", "10.0.0.1:7", "", counts(5)}));
  const RecordingSurvey survey = told.survey();
  REQUIRE(survey.senders.size() == 2);
  CHECK(survey.senders[0].topic == "/mocap/raw");
  CHECK(survey.senders[0].counts.messages == 10);
  CHECK(survey.senders[1].counts.messages == 5);
}

TEST_CASE("marks and who was to be heard are found") {
  Told told;
  told.add(3, marks_topic,
           to_json(RecordedMark{{Mark::Kind::start, "dance", 33ms, "1"}, "call", "a"}));
  told.add(3, marks_topic, "no mark");
  const RecordingSurvey survey = told.survey();
  REQUIRE(survey.marks.size() == 1);
  CHECK(survey.marks[0].first.mark.kind == Mark::Kind::start);
  CHECK(survey.marks[0].first.mark.latency == 33ms);
  CHECK(survey.marks[0].second == 1'700'000'000'000'000'000);
  CHECK(survey.expected == ExpectedDevices{{"mocap", true}, {"imu/7", false}});
}

TEST_CASE("marks beyond what is looked at are counted") {
  Told told;
  const std::string mark = R"({"kind": "text", "source": "call", "text": "x"})";
  for (std::size_t k = 0; k < most_marks + 3; ++k) told.add(9, marks_topic, mark);
  const RecordingSurvey survey = told.survey();
  CHECK(survey.marks.size() == most_marks);
  CHECK(survey.more_marks == 3);
}

TEST_CASE("a reading of the host's clocks that can't be is passed over") {
  const std::string pair = R"({"raw_ns": 1001000000000, "utc_ns": 1700000001000000000})";
  REQUIRE(to_clock_pair(pair));
  CHECK(to_json(*to_clock_pair(pair)) == pair);
  Told told;
  told.add(4, host_clock_topic, pair);
  for (const char* wild : {R"({"raw_ns": -9000000000000000000, "utc_ns": 9000000000000000000})",
                           R"({"raw_ns": 18446744073709551615, "utc_ns": 1700000002000000000})",
                           R"({"raw_ns": 1002000000000, "utc_ns": -1})",
                           R"({"raw_ns": 1002000000000, "utc_ns": 4000000000000000001})",
                           R"({"raw_ns": 1000000000000000001, "utc_ns": 1700000002000000000})"}) {
    CAPTURE(wild);
    CHECK(!to_clock_pair(wild));
    told.add(4, host_clock_topic, wild);
  }
  CHECK(told.survey().steps.empty());
}

TEST_CASE("what is no count is none, and what is missing of one is 0") {
  CHECK(!to_counted_sender("no JSON"));
  CHECK(!to_counted_sender("[1]"));
  CHECK(!to_counted_sender(R"({"messages": 3})"));
  const auto sender =
      to_counted_sender(R"({"stream": "a", "messages": -3, "lost": 1.5, "late": 7})");
  REQUIRE(sender);
  CHECK(sender->counts.messages == 0);
  CHECK(sender->counts.order.lost == 0);
  CHECK(sender->counts.order.late == 7);
  CHECK(!to_counted_port(R"({"stream": 3})"));
  CHECK(to_counted_port(R"({"stream": "a", "sifted": 1})")->counts.sifted == false);
}
