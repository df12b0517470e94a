// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/record_stream.h"

#include "tests/folder.h"
#include "tests/mcap/mcap_files.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

using namespace kinalign;

namespace {

struct Sent {
  std::uint16_t channel = 1;
  std::uint32_t number = 0;
  std::uint64_t log_time = 0;
};

/// A part of a recording with these messages in a chunk, in this order.
std::string part_with(int part, const std::vector<Sent>& messages) {
  MemoryFile file;
  McapWriter writer(file.store());
  REQUIRE(writer.begin({"kinalign", "test"}));
  REQUIRE(writer.write(to_metadata({"", "", "lab", "a.mcap", part, {}})));
  McapChunkContent content;
  for (const Sent& one : messages) {
    OwnedMessage message = nth_message(one.channel);
    message.message.channel = one.channel;
    message.message.sequence = one.number;
    message.message.log_time = one.log_time;
    add(content, message);
  }
  REQUIRE(writer.write(store(content, McapCompression::none)));
  REQUIRE(writer.finish());
  return file.bytes;
}

/// The sequence numbers of each channel in the order in which they are read.
std::map<std::uint16_t, std::vector<std::uint32_t>> numbers_in(
    const std::vector<std::string>& bytes, Findings* findings = nullptr) {
  const FreshFolder folder;
  PosixFiles files;
  std::vector<std::string> paths;
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    paths.push_back(folder.write("a.part" + std::to_string(k + 1) + ".mcap", bytes[k]));
  }
  auto stream = RecordStream::open(files, *find_parts(files, paths), {});
  REQUIRE(stream);
  std::map<std::uint16_t, std::vector<std::uint32_t>> found;
  for (;;) {
    const auto record = stream->next();
    REQUIRE(record);
    if (*record == nullptr) {
      if (findings != nullptr) *findings = stream->findings();
      return found;
    }
    const auto* message = std::get_if<McapMessage>(*record);
    if (message != nullptr) found[message->channel].push_back(message->sequence);
  }
}

}  // namespace

TEST_CASE("channels stay in order where log times do not rise within a file") {
  // After a standstill of the disk the recorder wrote all messages of one device first, then those
  // of the other.
  std::vector<Sent> first, second;
  for (std::uint32_t k = 0; k < 50; ++k) first.push_back({1, k, 100 + k});
  for (std::uint32_t k = 0; k < 20; ++k) first.push_back({2, k, 100 + k});
  for (std::uint32_t k = 20; k < 50; ++k) second.push_back({2, k, 100 + k});
  auto found = numbers_in({part_with(1, first), part_with(2, second)});
  for (const std::uint16_t channel : {std::uint16_t{1}, std::uint16_t{2}}) {
    CHECK(found[channel].size() == 50);
    CHECK(std::is_sorted(found[channel].begin(), found[channel].end()));
  }
}

TEST_CASE("a message index that a flipped bit turns into a message replaces no real message") {
  // The index of one message states 16 bytes. As a message, these are the number 16.
  MemoryFile file;
  McapWriter writer(file.store());
  REQUIRE(writer.begin({"kinalign", "test"}));
  REQUIRE(writer.write(to_metadata({"", "", "lab", "a.mcap", 1, {}})));
  std::size_t index = 0;
  for (std::uint32_t k = 0; k < 20; ++k) {
    McapChunkContent content;
    OwnedMessage message = nth_message(0);
    message.message.sequence = k;
    add(content, message);
    const McapStoredChunk chunk = store(content, McapCompression::none);
    if (k == 5) index = file.bytes.size() + chunk.index.message_index_offsets.begin()->second;
    REQUIRE(writer.write(chunk));
  }
  REQUIRE(file.bytes[index] == static_cast<char>(McapOp::message_index));
  file.bytes[index] = static_cast<char>(McapOp::message);
  Findings findings;
  const auto found = numbers_in({file.bytes}, &findings);
  REQUIRE(found.contains(1));
  CHECK(found.at(1).size() == 20);
  CHECK(std::is_sorted(found.at(1).begin(), found.at(1).end()));
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].what.found == "1 outside of the chunks");
}

TEST_CASE("each message of all parts is read once, and each channel in order") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::vector<Sent> all;
    std::map<std::uint16_t, std::uint32_t> numbers;
    for (std::uint64_t at = 1; at <= 60; ++at) {
      const auto channel = static_cast<std::uint16_t>(1 + random() % 3);
      all.push_back({channel, numbers[channel]++, at});
    }
    std::vector<std::string> files;
    std::map<std::uint16_t, std::set<std::uint32_t>> there;
    for (int part = 1; part <= 4; ++part) {
      std::vector<Sent> own;
      for (const Sent& one : all) {
        if (random() % 3 == 0) own.push_back(one);
      }
      own.push_back(all[static_cast<std::size_t>(part)]);  // no part is empty
      std::stable_sort(own.begin(), own.end(),
                       [](const Sent& a, const Sent& b) { return a.log_time < b.log_time; });
      for (const Sent& one : own) there[one.channel].insert(one.number);
      files.push_back(part_with(part, own));
    }
    std::map<std::uint16_t, std::vector<std::uint32_t>> expected;
    for (auto& [channel, all_of_it] : there)
      expected[channel] = {all_of_it.begin(), all_of_it.end()};
    CHECK(numbers_in(files) == expected);
  }
}
