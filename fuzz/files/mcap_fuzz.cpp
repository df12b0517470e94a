// SPDX-License-Identifier: Apache-2.0
// A recording is read alike, however it is cut into pieces, and is read again when it is written
// anew.
#include "kinalign/mcap/reader.h"
#include "kinalign/mcap/writer.h"
#include "kinalign/recording/format.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

using namespace kinalign;

namespace {

struct Message {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0, publish_time = 0;
  std::string data;

  bool operator==(const Message&) const = default;
};

std::vector<Message> read(std::string_view bytes, std::size_t piece) {
  McapReader reader;
  std::vector<Message> messages;
  const auto take = [&] {
    while (const auto record = reader.next()) {
      if (const auto* m = std::get_if<McapMessage>(&*record)) {
        messages.push_back(
            {m->channel, m->sequence, m->log_time, m->publish_time, std::string(m->data)});
      } else if (const auto* metadata = std::get_if<McapMetadata>(&*record)) {
        const auto facts = to_facts(*metadata);
        if (facts && to_metadata(*to_facts(to_metadata(*facts))).texts != to_metadata(*facts).texts)
          std::abort();
      }
    }
  };
  for (; !bytes.empty(); bytes.remove_prefix(std::min(piece, bytes.size()))) {
    reader.feed(bytes.substr(0, piece));
    take();
  }
  reader.end();
  take();
  return messages;
}

std::string written(const std::vector<Message>& messages) {
  std::string file;
  McapWriter writer({[&](std::string_view more) {
                       file += more;
                       return Result<void>();
                     },
                     [&](std::uint64_t at, std::span<char> to) {
                       std::memcpy(to.data(), file.data() + at, to.size());
                       return Result<void>();
                     }});
  McapChunkContent content;
  for (const Message& m : messages) {
    content.add(McapMessage{m.channel, m.sequence, m.log_time, m.publish_time, m.data});
  }
  if (!writer.begin({}) || !writer.write(store(content, McapCompression::zstd)) ||
      !writer.finish()) {
    std::abort();
  }
  return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::vector<Message> once = read(bytes, bytes.size() + 1);
  if (read(bytes, 1 + data[0]) != once) std::abort();
  if (read(written(once), SIZE_MAX) != once) std::abort();
  if (const auto exchange = to_exchange(bytes)) {
    const std::string again = to_bytes(*exchange);
    if (to_bytes(*to_exchange(again)) != again) std::abort();
  }
  if (const auto exchange = to_clockless(bytes)) {
    const std::string again = to_bytes(*exchange);
    if (to_exchange(again) || to_bytes(*to_clockless(again)) != again) std::abort();
  }
  return 0;
}
