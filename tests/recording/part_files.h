// SPDX-License-Identifier: Apache-2.0
// The files of a recording that continues in further files, for tests.
#pragma once

#include "tests/mcap/mcap_files.h"

#include "kinalign/recording/survey.h"
#include "kinalign/wire/little_endian_reader.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace kinalign {

inline Severity worst_of(const Findings& findings) {
  Severity worst = Severity::note;
  for (const Finding& one : findings) worst = std::max(worst, one.severity);
  return worst;
}

/// Returns whether a warning says that the rest of the recording is missing.
inline bool ends_before(const RecordingSurvey& survey) {
  return !judge_end("a.mcap", survey.facts.has_value(), survey.ending).empty();
}

/// Messages [from, to), numbered by channel as the recorder numbers them.
inline McapChunkContent messages_of(int from, int to) {
  McapChunkContent content;
  for (int k = from; k < to; ++k) {
    OwnedMessage message = nth_message(static_cast<std::uint32_t>(k));
    message.message.sequence /= 3;
    add(content, message);
  }
  return content;
}

/// The bytes cut before the times of the k-th message, in a chunk that is not compressed.
inline std::string torn_at(const std::string& bytes, std::uint32_t k) {
  const McapMessage message = nth_message(k).message;
  std::string times;
  append_little(message.log_time, times);
  append_little(message.publish_time, times);
  return bytes.substr(0, bytes.find(times));
}

/// The bytes with each channel's definition turned into a record of an unknown kind.
inline std::string nameless(std::string bytes) {
  for (auto at = bytes.find("/topic"); at != std::string::npos; at = bytes.find("/topic", at + 1)) {
    bytes[at - 17] = 0x7e;
  }
  return bytes;
}

/// A part of a recording, closed in order; `ends`: the recording ended in it.
inline std::string part_of(int part, const std::vector<McapChunkContent>& chunks, bool ends) {
  MemoryFile file;
  McapWriter writer(file.store());
  REQUIRE(writer.begin({"kinalign", "test"}));
  REQUIRE(writer.write(to_metadata({"", "", "lab", "a.mcap", part, {}})));
  for (const McapChunkContent& chunk : chunks) {
    REQUIRE(writer.write(store(chunk, McapCompression::none)));
  }
  if (ends) REQUIRE(writer.write(to_metadata(RecordingEnd{})));
  REQUIRE(writer.finish());
  return file.bytes;
}
inline std::string part_of(int part, int from, int to, bool ends) {
  return part_of(part, {messages_of(from, to)}, ends);
}

}  // namespace kinalign
