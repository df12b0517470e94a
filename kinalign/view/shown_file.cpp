// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/shown_file.h"

#include "kinalign/mcap/store.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace kinalign {

ShownFile::ShownFile(OutputFile& out) : path_(out.path()), writer_(mcap_store(out)) {}

Result<void> ShownFile::begin() { return writer_.begin({"", "kinalign " KINALIGN_VERSION}); }

Result<void> ShownFile::attach(std::string name, std::string description) {
  return writer_.write(McapAttachment{0, 0, std::move(name), "text/plain", std::move(description)});
}

Result<std::uint16_t> ShownFile::add_channel(std::string topic, McapSchema schema) {
  // MCAP ids of channels have 16 bits.
  constexpr std::size_t most = std::numeric_limits<std::uint16_t>::max();
  if (channels_.size() == most) {
    return Failure(Error{path_, 0, "at most " + std::to_string(most) + " channels", "more"});
  }
  const auto next = static_cast<std::uint16_t>(schemas_.size() + 1);
  // Channels may share a schema. Ids begin at 1, because 0 means no schema in MCAP.
  const auto [known, is_new] = schema_ids_.try_emplace(schema.name, next);
  schema.id = known->second;
  channels_.push_back(
      {static_cast<std::uint16_t>(channels_.size() + 1), schema.id, std::move(topic), "json", {}});
  if (is_new) schemas_.push_back(std::move(schema));
  numbers_.push_back(0);
  return channels_.back().id;
}

Result<void> ShownFile::add(std::uint16_t channel, Time at, Time device, std::string_view json) {
  if (to_ns(at) < 0) {
    ++too_early_;
    return {};
  }
  // Each chunk must be readable alone, so a channel's definition precedes its first message.
  if (!chunk_.messages().contains(channel)) {
    const McapChannel& described = channels_[channel - 1U];
    chunk_.add(schemas_[described.schema_id - 1U]);
    chunk_.add(described);
  }
  const auto log = static_cast<std::uint64_t>(to_ns(at));
  // A device's own stamp may be negative, but MCAP has no negative times.
  const auto published = static_cast<std::uint64_t>(std::max<std::int64_t>(0, to_ns(device)));
  chunk_.add(McapMessage{channel, numbers_[channel - 1U]++, log, published, json});
  constexpr std::size_t chunk_bytes = std::size_t{1} << 20;
  return chunk_.size() < chunk_bytes ? Result<void>() : close_chunk();
}

Result<void> ShownFile::finish() {
  KA_TRY(close_chunk());
  return writer_.finish();
}

Findings ShownFile::findings() const {
  FileFindings out{path_};
  if (too_early_ > 0) {
    out.add(Severity::warning, "stamps from 1970 on",
            std::to_string(too_early_) + " messages with earlier stamps",
            "they were left out: MCAP has no earlier times");
  }
  return out.all;
}

// The chunk is compressed with zstd, which viewers can read. JSON becomes much smaller.
Result<void> ShownFile::close_chunk() {
  if (chunk_.empty()) return {};
  return writer_.write(store(std::exchange(chunk_, {}), McapCompression::zstd));
}

}  // namespace kinalign
