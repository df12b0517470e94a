// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/recorder/recorder.h"

#include "tests/mcap/mcap_files.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

using std::chrono::milliseconds;
using namespace std::chrono_literals;

HostTime at_ms(int ms) { return HostTime{milliseconds(ms)}; }

/// The messages of the chunks that a take received, in their order.
struct Taken {
  std::vector<McapChunkContent> chunks;

  Recorder::Take take() {
    return [this](McapChunkContent chunk) { chunks.push_back(std::move(chunk)); };
  }
  std::vector<std::string> texts() const {
    MemoryFile file;
    McapWriter writer(file.store());
    CHECK(writer.begin({}));
    for (const auto& chunk : chunks) CHECK(writer.write(store(chunk, McapCompression::none)));
    CHECK(writer.finish());
    std::vector<std::string> texts;
    for (const OwnedMessage& m : read_mcap(file.bytes).messages) texts.push_back(m.data);
    return texts;
  }
};

}  // namespace

TEST_CASE("a message keeps its arrival in UTC, its device's time and its number") {
  Recorder recorder({.utc_minus_host = 1000s});
  Taken taken;
  const auto channel = recorder.add_channel({0, 0, "/mocap/raw", "noitom", {}});
  recorder.start(at_ms(0), taken.take());
  recorder.record(channel, at_ms(1), "a", 77);
  recorder.record(channel, at_ms(2), "b");
  recorder.stop();
  REQUIRE(taken.chunks.size() == 1);
  MemoryFile file;
  McapWriter writer(file.store());
  CHECK(writer.write(store(taken.chunks[0], McapCompression::none)));
  const ReadMcap read = read_mcap(std::string(mcap_magic) + file.bytes);
  REQUIRE(read.messages.size() == 2);
  CHECK(read.messages[0].message.log_time == 1'000'001'000'000);
  CHECK(read.messages[0].message.publish_time == 77);
  CHECK(read.messages[0].message.sequence == 0);
  // The device has no clock, so the stamp is the arrival.
  CHECK(read.messages[1].message.publish_time == 1'000'002'000'000);
  CHECK(read.messages[1].message.sequence == 1);
}

TEST_CASE("a chunk is closed after a quarter of a second, or when it is full") {
  Recorder recorder({.chunk_bytes = 1000});
  Taken taken;
  const auto channel = recorder.add_channel({0, 0, "/imu/raw", "x", {}});
  recorder.start(at_ms(0), taken.take());
  recorder.record(channel, at_ms(10), "a");
  recorder.tick(at_ms(259));
  CHECK(taken.chunks.empty());
  recorder.tick(at_ms(260));
  CHECK(taken.chunks.size() == 1);
  recorder.tick(at_ms(900));  // no message has come, so no chunk is closed
  CHECK(taken.chunks.size() == 1);
  recorder.record(channel, at_ms(901), std::string(1000, 'b'));
  CHECK(taken.chunks.size() == 2);
}

TEST_CASE("each chunk can be read by itself") {
  Recorder recorder(RecorderOptions{});
  Taken taken;
  const McapSchema schema{0, "kinalign.Mark", "jsonschema", "{}"};
  const auto marks = recorder.add_channel({0, 0, "/marks", "json", {}}, &schema);
  const auto more = recorder.add_channel({0, 0, "/more", "json", {}}, &schema);
  recorder.start(at_ms(0), taken.take());
  for (const int t : {0, 1000}) {
    recorder.record(marks, at_ms(t), "{}");
    recorder.record(more, at_ms(t), "{}");
    recorder.tick(at_ms(t + 500));
  }
  REQUIRE(taken.chunks.size() == 2);
  for (const auto& chunk : taken.chunks) {
    CHECK(chunk.definitions().channels.size() == 2);
    REQUIRE(chunk.definitions().schemas.size() == 1);  // which both channels share
    CHECK(chunk.definitions().schemas.begin()->second.name == "kinalign.Mark");
  }
}

TEST_CASE("of more channels than a file can number the rest share one, and none is another's") {
  Recorder recorder(RecorderOptions{});
  Taken taken;
  std::uint16_t number = 0;
  for (int k = 1; k < 65'535; ++k) number = recorder.add_channel({0, 0, "/a/raw", "x", {}});
  CHECK(number == 65'534);
  for (const char* topic : {"/b/raw", "/c/raw"}) {
    CHECK(recorder.add_channel({0, 0, topic, "x", {}}) == 65'535);
  }
  recorder.start(at_ms(0), taken.take());
  recorder.record(number, at_ms(1), "a");
  for (const char* text : {"b", "c"}) recorder.record(65'535, at_ms(1), text);
  recorder.stop();
  CHECK(taken.texts() == std::vector<std::string>{"a", "b", "c"});
  const auto& channels = taken.chunks.at(0).definitions().channels;
  CHECK(channels.at(65'534).topic == "/a/raw");
  CHECK(channels.at(65'535).topic == "/others");
}

TEST_CASE("a take begins with the last five seconds before it") {
  Recorder recorder(RecorderOptions{});
  Taken taken;
  const auto channel = recorder.add_channel({0, 0, "/imu/raw", "x", {}});
  for (int t = 0; t < 20'000; t += 10) {
    recorder.record(channel, at_ms(t), std::to_string(t));
    recorder.tick(at_ms(t));
  }
  recorder.start(at_ms(20'000), taken.take());
  recorder.record(channel, at_ms(20'000), "20000");
  recorder.stop();
  const auto texts = taken.texts();
  REQUIRE(!texts.empty());
  const int first = std::stoi(texts.front());
  CHECK(first <= 15'000);
  CHECK(first >= 14'490);  // and two chunks at most
  for (std::size_t i = 0; i < texts.size(); ++i) {
    REQUIRE(texts[i] == std::to_string(first + 10 * static_cast<int>(i)));
  }
  CHECK(texts.back() == "20000");
}

TEST_CASE("the pre-roll keeps to its memory") {
  Recorder recorder({.chunk_bytes = 1000, .pre_roll_bytes = 10'000});
  Taken taken;
  const auto channel = recorder.add_channel({0, 0, "/imu/raw", "x", {}});
  for (int i = 0; i < 1000; ++i) {
    recorder.record(channel, at_ms(i), std::string(500, 'x'));
    recorder.tick(at_ms(i));
  }
  recorder.start(at_ms(1000), taken.take());
  recorder.stop();
  std::size_t size = 0;
  for (const auto& chunk : taken.chunks) size += chunk.size();
  CHECK(size <= 12'000);
  CHECK(size >= 9'000);
}

TEST_CASE("what comes between two takes belongs to the pre-roll of the second") {
  Recorder recorder(RecorderOptions{});
  Taken first, second;
  const auto channel = recorder.add_channel({0, 0, "/imu/raw", "x", {}});
  recorder.start(at_ms(0), first.take());
  recorder.record(channel, at_ms(1), "first");
  recorder.stop();
  recorder.record(channel, at_ms(2), "between");
  recorder.start(at_ms(3), second.take());
  recorder.record(channel, at_ms(4), "second");
  recorder.stop();
  CHECK(first.texts() == std::vector<std::string>{"first"});
  CHECK(second.texts() == std::vector<std::string>{"between", "second"});
}

TEST_CASE("what came while nobody ticked is in the pre-roll as far as it reaches") {
  Recorder recorder({.pre_roll = 5s});
  Taken taken;
  const auto channel = recorder.add_channel({0, 0, "/imu/raw", "x", {}});
  for (int s = 0; s <= 20; ++s) recorder.record(channel, at_ms(1000 * s), std::to_string(s));
  recorder.tick(at_ms(20'001));  // the machine stood still
  recorder.tick(at_ms(20'300));
  recorder.start(at_ms(20'300), taken.take());
  recorder.stop();
  const auto texts = taken.texts();
  REQUIRE(!texts.empty());
  CHECK(texts.back() == "20");
}
