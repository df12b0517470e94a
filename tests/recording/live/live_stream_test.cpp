// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/live/live_stream.h"

#include "kinalign/wire/little_endian_reader.h"

#include <doctest/doctest.h>

#include <random>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

constexpr std::uint64_t begin_ns = 1'790'000'000'000'000'000;

RecordingFacts facts() {
  RecordingFacts out;
  out.host = "lab";
  out.anchor = {HostTime{100s}, utc_time(static_cast<std::int64_t>(begin_ns))};
  return out;
}

/// A stream of marks, one a second.
std::string stream_of(std::size_t marks, std::size_t lost = 0) {
  std::string out(mcap_magic);
  append_mcap(out, McapHeader{std::string(recording_profile), "kinalign"});
  append_mcap(out, to_metadata(facts()));
  append_mcap(out, McapChannel{1, 0, std::string(marks_topic), "json", {}});
  RecordedMark mark;
  mark.mark.kind = Mark::Kind::t_pose;
  mark.source = "keyboard";
  const std::string json = to_json(mark);
  for (std::size_t i = 0; i < marks; ++i) {
    const auto number = static_cast<std::uint32_t>(i < marks / 2 ? i : i + lost);
    const std::uint64_t log = begin_ns + i * 1'000'000'000;
    append_mcap(out, McapMessage{1, number, log, log, json});
  }
  append_mcap(out, McapDataEnd{});
  append_mcap(out, McapFooter{});
  return out + std::string(mcap_magic);
}

/// Whether the stream was read to its end, in pieces of any length.
bool read(LiveStream& stream, std::string_view bytes, std::size_t piece, LiveData& news) {
  for (; !bytes.empty(); bytes.remove_prefix(std::min(piece, bytes.size()))) {
    if (!stream.take(bytes.substr(0, piece), news)) return false;
  }
  stream.end();
  return true;
}

}  // namespace

TEST_CASE("a stream says the same however it is cut, and that it has ended") {
  const std::string bytes = stream_of(20);
  for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, std::size_t{100}, bytes.size()}) {
    CAPTURE(piece);
    LiveStream stream;
    LiveData news;
    REQUIRE(read(stream, bytes, piece, news));
    CHECK(stream.closed());
    REQUIRE(news.marks.size() == 20);
    CHECK(news.marks[0].mark.mark.kind == Mark::Kind::t_pose);
    CHECK(to_ns(news.marks[19].at) == static_cast<std::int64_t>(begin_ns) + 19'000'000'000);
    CHECK(stream.counts().lost == 0);
    CHECK(stream.facts()->host == "lab");
  }
}

TEST_CASE("messages that a slow client did not get are counted by their numbers") {
  LiveStream stream;
  LiveData news;
  REQUIRE(read(stream, stream_of(20, 5), 64, news));
  CHECK(stream.counts().lost == 5);
}

TEST_CASE("a stream that breaks off is not closed") {
  const std::string bytes = stream_of(20);
  LiveStream stream;
  LiveData news;
  REQUIRE(read(stream, std::string_view(bytes).substr(0, bytes.size() / 2), 64, news));
  CHECK(!stream.closed());
}

TEST_CASE("what is no stream of record is refused with a word") {
  std::string silent = stream_of(1);
  silent.resize(silent.size() - mcap_magic.size());
  std::string late(mcap_magic);
  append_mcap(late, McapChannel{1, 0, std::string(marks_topic), "json", {}});
  append_mcap(late, McapMessage{1, 0, begin_ns, begin_ns, "{}"});
  std::string jump(mcap_magic);
  append_mcap(jump, to_metadata(facts()));
  append_mcap(jump, McapMessage{1, 0, begin_ns, begin_ns, "{}"});
  append_mcap(jump, McapMessage{1, 1, begin_ns + 61'000'000'000, begin_ns, "{}"});
  std::string huge(mcap_magic);
  huge += "\x05";
  huge += std::string(8, '\xff');
  for (const std::string& bytes : {std::string("HTTP/1.1 200 OK\r\n"), late, jump, huge}) {
    LiveStream stream;
    LiveData news;
    const auto refused = stream.take(bytes, news);
    REQUIRE(!refused);
    CHECK(refused.error().file == "--live");
    CHECK(!refused.error().found.empty());
  }
}

TEST_CASE("law: damaged streams are refused or read, and never take much memory") {
  const std::string whole = stream_of(30);
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::string bytes = whole;
    for (std::uint64_t k = random() % 4 + 1; k > 0; --k) {
      bytes[random() % bytes.size()] = static_cast<char>(random());
    }
    LiveStream stream;
    LiveData news;
    (void)read(stream, bytes, random() % 200 + 1, news);
    CHECK(news.marks.size() <= 30);
  }
}
