// SPDX-License-Identifier: Apache-2.0
// Writes an MCAP file of JSON. Channels are added when needed; chunks have 1 MiB.
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

/// Call begin(), attach(), then add channels and messages in any order, then finish(). Messages are
/// collected in chunk_ up to 1 MiB. Each chunk contains the channels and schemas that it needs.
class ShownFile {
 public:
  /// `out` must outlive the object; its owner commits the file.
  explicit ShownFile(OutputFile& out);

  Result<void> begin();
  /// Adds a stream's description as an attachment. Call before the first message.
  Result<void> attach(std::string name, std::string description);
  /// Adds a channel. Of several schemas with the same name, only the first is stored. Fails if all
  /// ids of MCAP are used.
  Result<std::uint16_t> add_channel(std::string topic, McapSchema schema);
  /// `device`: the sample's time on the device's own clock.
  Result<void> add(std::uint16_t channel, Time at, Time device, std::string_view json);
  Result<void> finish();

  /// Returns a warning if messages before 1970 were omitted, because MCAP can't state their times.
  Findings findings() const;

 private:
  Result<void> close_chunk();

  std::string path_;
  McapWriter writer_;
  std::vector<McapSchema> schemas_;                  // the schema [i] has the id i + 1
  std::vector<McapChannel> channels_;                // the channel [i] has the id i + 1
  std::map<std::string, std::uint16_t> schema_ids_;  // by the schema's name
  std::vector<std::uint32_t> numbers_;
  McapChunkContent chunk_;
  std::uint64_t too_early_ = 0;  // number of messages before 1970
};

}  // namespace kinalign
