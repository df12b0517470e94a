// SPDX-License-Identifier: Apache-2.0
// An MCAP file of JSON while it is being written: channels are added when needed, chunks have 1
// MiB.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/mcap/writer.h"
#include "kinalign/wire/time.h"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// begin(), attachments, then channels and messages in any order, then finish(). Messages are kept
/// in chunk_ until it has 1 MiB; each chunk has the channels and schemas that it needs.
class ShownFile {
 public:
  /// `out` must live longer; its owner commits it.
  explicit ShownFile(OutputFile& out);

  Result<void> begin();
  /// Adds a stream's description as an attachment. Call before the first message.
  Result<void> attach(std::string name, std::string description);
  /// Adds a channel. Of schemas with one name only the first is stored. Fails if MCAP has no id
  /// left.
  Result<std::uint16_t> add_channel(std::string topic, McapSchema schema);
  /// `device`: the sample's time on the device's own clock.
  Result<void> add(std::uint16_t channel, Time at, Time device, std::string_view json);
  Result<void> finish();

  /// A warning if messages before 1970 were left out, because MCAP can't state their times.
  Findings findings() const;

 private:
  Result<void> close_chunk();

  std::string path_;
  McapWriter writer_;
  std::vector<McapSchema> schemas_;                  // [i] has the id i + 1
  std::vector<McapChannel> channels_;                // [i] has the id i + 1
  std::map<std::string, std::uint16_t> schema_ids_;  // by the schema's name
  std::vector<std::uint32_t> numbers_;
  McapChunkContent chunk_;
  std::uint64_t too_early_ = 0;  // messages before 1970
};

}  // namespace kinalign
