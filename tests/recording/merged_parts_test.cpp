// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/merged_parts.h"

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

struct Told {
  std::uint16_t channel = 1;
  std::uint32_t number = 0;
  std::uint64_t log_time = 0;
};

/// A part of a recording with these messages in a chunk, in this order.
std::string part_with(int part, const std::vector<Told>& messages) {
  MemoryFile file;
  McapWriter writer(file.store());
  REQUIRE(writer.begin({"kinalign", "test"}));
  REQUIRE(writer.write(to_metadata({"", "", "lab", "a.mcap", part, {}})));
  McapChunkContent content;
  for (const Told& one : messages) {
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
std::map<std::uint16_t, std::vector<std::uint32_t>> merged(const std::vector<std::string>& bytes) {
  const FreshFolder folder;
  PosixFiles files;
  std::vector<std::string> paths;
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    paths.push_back(folder.write("a.part" + std::to_string(k + 1) + ".mcap", bytes[k]));
  }
  const RecordingParts parts = *read_parts(files, paths, {});
  auto records = MergedParts::open(files, parts, {});
  REQUIRE(records);
  std::map<std::uint16_t, std::vector<std::uint32_t>> found;
  for (;;) {
    const auto one = records->next();
    REQUIRE(one);
    if (!*one) return found;
    const auto* message = std::get_if<McapMessage>((*one)->record);
    if (message != nullptr) found[message->channel].push_back(message->sequence);
  }
}

}  // namespace

TEST_CASE("channels stay in order where log times do not rise within a file") {
  // After a standstill of the disk the recorder wrote all messages of one device first, then those
  // of the other.
  std::vector<Told> first, second;
  for (std::uint32_t k = 0; k < 50; ++k) first.push_back({1, k, 100 + k});
  for (std::uint32_t k = 0; k < 20; ++k) first.push_back({2, k, 100 + k});
  for (std::uint32_t k = 20; k < 50; ++k) second.push_back({2, k, 100 + k});
  auto found = merged({part_with(1, first), part_with(2, second)});
  for (const std::uint16_t channel : {std::uint16_t{1}, std::uint16_t{2}}) {
    CHECK(found[channel].size() == 50);
    CHECK(std::is_sorted(found[channel].begin(), found[channel].end()));
  }
}

TEST_CASE("whatever files have of a recording, channels come in order, and all there is") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::vector<Told> all;
    std::map<std::uint16_t, std::uint32_t> numbers;
    for (std::uint64_t at = 1; at <= 60; ++at) {
      const auto channel = static_cast<std::uint16_t>(1 + random() % 3);
      all.push_back({channel, numbers[channel]++, at});
    }
    std::vector<std::string> files;
    std::map<std::uint16_t, std::set<std::uint32_t>> there;
    for (int part = 1; part <= 4; ++part) {
      std::vector<Told> own;
      for (const Told& one : all) {
        if (random() % 3 == 0) own.push_back(one);
      }
      own.push_back(all[static_cast<std::size_t>(part)]);  // no part is empty
      std::stable_sort(own.begin(), own.end(),
                       [](const Told& a, const Told& b) { return a.log_time < b.log_time; });
      for (const Told& one : own) there[one.channel].insert(one.number);
      files.push_back(part_with(part, own));
    }
    std::map<std::uint16_t, std::set<std::uint32_t>> heard;
    for (auto& [channel, order] : merged(files)) {
      CHECK(std::is_sorted(order.begin(), order.end()));
      heard[channel].insert(order.begin(), order.end());
    }
    CHECK(heard == there);
  }
}
