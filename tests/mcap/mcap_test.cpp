// SPDX-License-Identifier: Apache-2.0
#include "tests/mcap/mcap_files.h"
#include "tests/seeds.h"

#include "kinalign/core/crc.h"
#include "kinalign/mcap/reader.h"
#include "kinalign/mcap/writer.h"
#include "kinalign/wire/little_endian.h"

#include <doctest/doctest.h>

#include <ctime>
#include <numeric>

namespace kinalign {

namespace {

/// Whether the messages are the first ones that were written.
bool are_the_first(const std::vector<OwnedMessage>& messages) {
  for (std::uint32_t k = 0; k < messages.size(); ++k) {
    const OwnedMessage expected = nth_message(k);
    const McapMessage& m = messages[k].message;
    if (m.channel != expected.message.channel || m.sequence != k ||
        m.log_time != expected.message.log_time ||
        m.publish_time != expected.message.publish_time || messages[k].data != expected.data) {
      return false;
    }
  }
  return true;
}

/// Bytes in which a chunk could begin at each seventh byte, with a compression whose name has 2
/// MiB.
std::string named_chunks(std::size_t size) {
  std::string bytes;
  while (bytes.size() < size) bytes += std::string("\6\1\0\0\x20\0\1", 7);
  return bytes;
}

/// Chunks that state one byte each; every one holds all chunks after it.
std::string nested_chunks(std::size_t size) {
  const std::string_view none;
  std::string head;
  append_mcap(head, McapChunkHead{0, 0, 1, 0, ""}, none);
  std::string bytes;
  for (std::size_t left = size; left > head.size();) {
    left -= head.size();
    put_little(static_cast<std::uint64_t>(left + McapChunkView::fields), head.data() + 1);
    put_little(static_cast<std::uint64_t>(left), head.data() + head.size() - 8);
    bytes += head;
  }
  bytes.resize(size);
  return bytes;
}

double processor_seconds() {
  return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

template <class T>
std::vector<T> records_of(const ReadMcap& read) {
  std::vector<T> found;
  for (const McapRecord& record : read.records) {
    if (const auto* one = std::get_if<T>(&record)) found.push_back(*one);
  }
  return found;
}

/// A file of 20 messages with at least one record of each kind that recordings contain.
std::string file_of_all_records(McapCompression compression, bool finish) {
  MemoryFile file;
  McapWriter writer(file.store());
  (void)writer.begin({"kinalign", "test"});
  (void)writer.write(McapMetadata{"kinalign.recording", {{"subject", "03"}}});
  (void)writer.write(McapAttachment{0, 0, "lab.toml", "", "a = 1\n"});
  for (std::uint32_t k = 0; k < 20;) {
    McapChunkContent content;
    for (const std::uint32_t end = k + 5; k < end; ++k) add(content, nth_message(k));
    (void)writer.write(store(content, compression));
  }
  // The writer begins a page only after many chunks, so this one comes from here.
  if (!finish) append_mcap_record(file.bytes, McapOp::index_page, std::string(100, '\6'));
  if (finish) (void)writer.finish();
  return file.bytes;
}

/// The positions of the records outside of chunks.
std::vector<std::size_t> record_heads(const std::string& bytes) {
  std::vector<std::size_t> heads;
  for (std::size_t at = mcap_magic.size(); bytes.size() - at > mcap_magic.size();) {
    heads.push_back(at);
    at += mcap_record_head + decode_mcap_head(std::string_view(bytes).substr(at))->length;
  }
  return heads;
}

std::string with_flipped_bit(std::string bytes, std::size_t bit) {
  bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
  return bytes;
}

/// The numbers of the messages that a checksum covers, in the order of reading.
std::vector<std::uint32_t> checked_numbers(const ReadMcap& read) {
  std::vector<std::uint32_t> numbers;
  for (const OwnedMessage& m : read.messages) {
    if (!m.unchecked) numbers.push_back(m.message.sequence);
  }
  return numbers;
}
std::vector<std::uint32_t> first_numbers(std::uint32_t count) {
  std::vector<std::uint32_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0U);
  return numbers;
}

}  // namespace

TEST_CASE("what was written is read, in pieces of any size") {
  for (const auto compression : {McapCompression::none, McapCompression::zstd}) {
    const std::string bytes = mcap_file(100, 17, compression);
    for (const std::size_t piece : {1, 7, 1000, 1 << 20}) {
      const ReadMcap read = read_mcap(bytes, piece);
      CHECK(read.findings.empty());
      CHECK(read.closed);
      CHECK(read.messages.size() == 100);
      CHECK(are_the_first(read.messages));
      CHECK(!read.unchecked);
      CHECK(read.all_checked);
    }
  }
}

TEST_CASE("the summary counts what is there and says where it stands") {
  std::vector<std::size_t> ends;
  const std::string bytes = mcap_file(100, 30, McapCompression::zstd, &ends);
  const ReadMcap read = read_mcap(bytes);
  const auto statistics = records_of<McapStatistics>(read);
  REQUIRE(statistics.size() == 1);
  CHECK(statistics[0].messages == 100);
  CHECK(statistics[0].chunks == 4);
  CHECK(statistics[0].schemas == 3);
  CHECK(statistics[0].channels == 3);
  CHECK(statistics[0].metadata == 1);
  CHECK(statistics[0].start == 1000);
  CHECK(statistics[0].end == 1990);
  CHECK(statistics[0].channel_messages ==
        std::map<std::uint16_t, std::uint64_t>{{1, 34}, {2, 33}, {3, 33}});
  const auto indexes = records_of<McapChunkIndex>(read);
  REQUIRE(indexes.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(bytes[indexes[i].chunk_offset] == static_cast<char>(McapOp::chunk));
    CHECK(indexes[i].chunk_offset + indexes[i].chunk_length + indexes[i].message_index_length ==
          ends[i]);
    for (const auto& [channel, offset] : indexes[i].message_index_offsets) {
      CHECK(bytes[offset] == static_cast<char>(McapOp::message_index));
      CHECK(bytes[offset + mcap_record_head] == static_cast<char>(channel));
    }
  }
  for (const McapSummaryOffset& offset : records_of<McapSummaryOffset>(read)) {
    CHECK(bytes[offset.start] == static_cast<char>(offset.group));
  }
}

TEST_CASE("an index of many chunks goes through the file, not through memory") {
  const std::string bytes = mcap_file(2000, 1, McapCompression::none);
  const ReadMcap read = read_mcap(bytes);
  CHECK(read.findings.empty());
  CHECK(are_the_first(read.messages));
  const auto indexes = records_of<McapChunkIndex>(read);
  REQUIRE(indexes.size() == 2000);
  for (std::size_t i = 0; i < indexes.size(); ++i) {
    CHECK(indexes[i].start == 1000 + 10 * i);
    CHECK(bytes[indexes[i].chunk_offset] == static_cast<char>(McapOp::chunk));
  }
  const auto page = std::string(1, static_cast<char>(McapOp::index_page));
  CHECK(bytes.find(page) != std::string::npos);
}

TEST_CASE("a file that is cut anywhere gives every message of the chunks before") {
  for (const auto compression : {McapCompression::none, McapCompression::zstd}) {
    std::vector<std::size_t> ends;
    const std::string whole = mcap_file(60, 10, compression, &ends);
    for (std::size_t cut = 0; cut < whole.size(); ++cut) {
      CAPTURE(cut);
      const ReadMcap read = read_mcap(std::string_view(whole).substr(0, cut));
      const auto chunks = static_cast<std::size_t>(
          std::count_if(ends.begin(), ends.end(), [&](std::size_t end) { return end <= cut; }));
      CHECK(read.messages.size() >= 10 * chunks);
      CHECK(are_the_first(read.messages));
      CHECK(!read.closed);
    }
  }
}

TEST_CASE("of an uncompressed chunk at which the file breaks off messages are read one by one") {
  std::vector<std::size_t> ends;
  const std::string whole = mcap_file(20, 10, McapCompression::none, &ends);
  const ReadMcap read = read_mcap(std::string_view(whole).substr(0, ends[0] + 900));
  CHECK(read.messages.size() > 10);
  CHECK(read.messages.size() < 20);
  CHECK(read.unchecked);
  REQUIRE(read.findings.size() == 1);
  CHECK(to_string(read.findings[0].what)
            .starts_with(
                "expected a complete record, found the end of the file within a record at byte"));
}

TEST_CASE("a message outside of chunks is unchecked but by the checksum of all data") {
  std::string data(mcap_magic);
  append_mcap(data, McapHeader{});
  append_mcap(data, McapMessage{1, 2, 3, 4, "five"});
  for (const std::uint32_t stated : {0U, crc_of(data), crc_of(data) ^ 1U}) {
    std::string bytes = data;
    append_mcap(bytes, McapDataEnd{stated});
    append_mcap(bytes, McapFooter{});
    bytes += mcap_magic;
    const ReadMcap read = read_mcap(bytes);
    REQUIRE(read.messages.size() == 1);
    CHECK(read.messages[0].unchecked);
    CHECK(read.all_checked == (stated == crc_of(data)));
  }
}

TEST_CASE("messages of a chunk without a checksum are unchecked, those of the next one are not") {
  McapChunkContent content;
  add(content, nth_message(0));
  std::string bytes(mcap_magic);
  append_mcap(bytes, McapHeader{});
  for (const std::uint32_t crc : {0U, crc_of(content.records())}) {
    append_mcap(bytes, McapChunkHead{1000, 1000, content.records().size(), crc, ""},
                content.records());
  }
  const ReadMcap read = read_mcap(bytes);
  REQUIRE(read.messages.size() == 2);
  CHECK(read.messages[0].unchecked);
  CHECK_FALSE(read.messages[1].unchecked);
}

TEST_CASE("of a torn chunk in which a definition is damaged the messages behind it are read") {
  McapChunkContent content;
  for (std::uint32_t k = 0; k < 12; ++k) add(content, nth_message(k));
  std::string bytes = mcap_file(6, 3, McapCompression::none, nullptr, false);
  const std::size_t begin = bytes.size();
  bytes += store(content, McapCompression::none).bytes;
  const auto topic = bytes.find("/topic3", begin);
  bytes[topic - 4] = '\x7f';  // the topic's length
  bytes.resize(bytes.find(nth_message(10).data, begin));
  const ReadMcap read = read_mcap(bytes);
  CHECK(read.messages.size() == 6 + 10);
  CHECK(std::any_of(read.findings.begin(), read.findings.end(),
                    [](const Finding& one) { return one.meaning == "the record is skipped"; }));
}

TEST_CASE("a chunk with a flipped bit is left out, those behind it are read") {
  std::vector<std::size_t> ends;
  const std::string whole = mcap_file(30, 10, McapCompression::none, &ends);
  for (std::size_t at = ends[0]; at < ends[1]; ++at) {
    CAPTURE(at);
    std::string flipped = whole;
    flipped[at] = static_cast<char>(flipped[at] ^ 0x10);
    const ReadMcap read = read_mcap(flipped, 100);
    CHECK(!read.findings.empty());
    REQUIRE(read.messages.size() >= 20);
    for (std::size_t i = 0; i < 10; ++i) {
      CHECK(read.messages[i].message.sequence == i);
      CHECK(read.messages[read.messages.size() - 1 - i].message.sequence == 29 - i);
    }
    for (const OwnedMessage& m : read.messages) {
      CHECK(m.data == nth_message(m.message.sequence).data);
    }
  }
}

TEST_CASE("a flipped bit in the opcode or length of any record costs no intact chunk") {
  for (const auto compression : {McapCompression::none, McapCompression::zstd}) {
    for (const bool finish : {true, false}) {
      CAPTURE(finish);
      const std::string whole = file_of_all_records(compression, finish);
      CHECK(read_mcap(whole).findings.empty());
      for (const std::size_t at : record_heads(whole)) {
        const auto op = static_cast<McapOp>(whole[at]);
        for (std::size_t bit = 0; bit < 8 * mcap_record_head; ++bit) {
          CAPTURE(at);
          CAPTURE(static_cast<int>(op));
          CAPTURE(bit);
          const std::string flipped = with_flipped_bit(whole, 8 * at + bit);
          const ReadMcap read = read_mcap(flipped, 997);
          CHECK(checked_numbers(read) == first_numbers(20));
          // In a truncated file no checksum covers the opcodes of the other records.
          const bool is_seen = finish || op == McapOp::chunk || bit >= 8;
          CHECK((!read.findings.empty() || !is_seen));
        }
      }
    }
  }
}

TEST_CASE("a chunk that a flipped bit turns into a footer does not end the reading") {
  std::vector<std::size_t> ends;
  std::string bytes = mcap_file(30, 10, McapCompression::zstd, &ends);
  bytes[ends[0]] = static_cast<char>(McapOp::footer);
  const ReadMcap read = read_mcap(bytes);
  CHECK(checked_numbers(read) == first_numbers(30));
  CHECK(read.closed);
  CHECK(!read.findings.empty());
}

TEST_CASE("a footer that the magic does not follow is no end") {
  std::string bytes = mcap_file(10, 10, McapCompression::zstd, nullptr, false);
  append_mcap(bytes, McapFooter{});
  McapChunkContent content;
  for (std::uint32_t k = 10; k < 20; ++k) add(content, nth_message(k));
  const ReadMcap read = read_mcap(bytes + store(content, McapCompression::zstd).bytes);
  CHECK(checked_numbers(read) == first_numbers(20));
  CHECK(!read.closed);
  CHECK(!read.findings.empty());
}

TEST_CASE("an attachment with a recording in it is no damage, nor is a record of a program's own") {
  std::string bytes = mcap_file(20, 10, McapCompression::none, nullptr, false);
  append_mcap(bytes,
              McapAttachment{0, 0, "inner.mcap", "", mcap_file(40, 10, McapCompression::none)});
  append_mcap_record(bytes, static_cast<McapOp>(0x90), std::string(3000, '\6'));
  McapChunkContent content;
  for (std::uint32_t k = 20; k < 30; ++k) add(content, nth_message(k));
  bytes += store(content, McapCompression::none).bytes;
  const ReadMcap read = read_mcap(bytes, 100);
  CHECK(checked_numbers(read) == first_numbers(30));
  CHECK(read.findings.empty());
}

TEST_CASE("zeros at the end, as a power cut leaves them, end the reading") {
  std::string bytes = mcap_file(20, 10, McapCompression::zstd, nullptr, false);
  bytes.append(5000, '\0');
  const ReadMcap read = read_mcap(bytes);
  CHECK(read.messages.size() == 20);
  CHECK(!read.closed);
  REQUIRE(read.findings.size() == 1);
  CHECK(read.findings[0].what.found.starts_with("a byte 0 at byte "));
}

TEST_CASE("what is no MCAP file is said to be none") {
  for (const std::string text : {"", "\x89MCAP", "HIERARCHY\nROOT Hips", "\x89MCAP1\r\n"}) {
    McapReader reader;
    reader.feed(text);
    reader.end();
    CHECK(!reader.next());
    CHECK(!reader.is_mcap());
    CHECK(reader.findings().size() == 1);
  }
}

TEST_CASE("a chunk that states more than it holds takes no memory for it") {
  std::string bytes(mcap_magic);
  append_mcap(bytes, McapChunkHead{0, 0, std::uint64_t{200} << 20, 0, "zstd"}, "x");
  append_mcap(bytes, McapChunkHead{0, 0, std::uint64_t{1} << 60, 0, ""}, "x");
  append_mcap(bytes, McapChunkHead{0, 0, 1, 0, "brotli"}, "x");
  const ReadMcap read = read_mcap(bytes);
  REQUIRE(read.findings.size() == 3);
  CHECK(read.findings[0].what.expected == "a chunk of 209715200 bytes");
  CHECK(read.findings[1].what.expected == "a chunk of at most 256 MiB");
  CHECK(read.findings[2].what.found.starts_with("brotli"));
}

TEST_CASE("a file made to be searched for ever is searched in a moment") {
  constexpr std::size_t size = std::size_t{8} << 20;
  for (const std::string& rubbish : {named_chunks(size), nested_chunks(size)}) {
    std::string bytes(mcap_magic);
    bytes += static_cast<char>(McapOp::message);
    append_little(std::uint64_t{200} << 20, bytes);  // longer than the file, so chunks are searched
    const double begin = processor_seconds();
    const ReadMcap read = read_mcap(bytes + rubbish);
    CHECK(processor_seconds() - begin < 5.0);  // without limits it takes up to a minute
    CHECK(read.messages.empty());
    REQUIRE(read.findings.size() == 1);
    CHECK(read.findings[0].what.found.starts_with("the end of the file within a record"));
  }
}

TEST_CASE("rubbish of any kind ends in findings") {
  for (const auto seed : fresh_seeds(300)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::string bytes =
        mcap_file(40, 7, random() % 2 == 0 ? McapCompression::none : McapCompression::zstd);
    for (std::uint64_t i = 0, n = 1 + random() % 20; i < n; ++i) {
      bytes[8 + random() % (bytes.size() - 8)] = static_cast<char>(random());
    }
    const ReadMcap read = read_mcap(bytes, 1 + random() % 300);
    for (const OwnedMessage& m : read.messages) {
      const bool is_whole =
          m.message.sequence < 40 && m.data == nth_message(m.message.sequence).data;
      CHECK((is_whole || m.unchecked));
    }
    CHECK(read.findings.size() <= 200);
  }
}

}  // namespace kinalign
