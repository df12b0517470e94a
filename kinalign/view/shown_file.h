// SPDX-License-Identifier: Apache-2.0
// An MCAP file of JSON while it is made: channels are added as they come, chunks of 1 MiB.
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

struct Shown {
  std::uint64_t messages = 0;
  std::uint64_t out_of_range = 0;  // samples before 1970: no MCAP time
};

class ShownFile {
 public:
  /// `out` has to stay; who made it commits it.
  explicit ShownFile(OutputFile& out);

  Result<void> begin();
  /// Before the first message. `description` of a stream, as text.
  Result<void> attach(std::string name, std::string description);
  /// Schemas of one name are one, the first. Fails where MCAP has no number left for the channel.
  Result<std::uint16_t> add_channel(std::string topic, McapSchema schema);
  /// `device`: on the device's own clock.
  Result<void> add(std::uint16_t channel, Time at, Time device, std::string_view json);
  Result<void> finish();

  const Shown& counts() const { return counts_; }

 private:
  Result<void> close_chunk();

  std::string path_;
  McapWriter writer_;
  std::vector<McapSchema> schemas_;                  // [i] has the id i + 1
  std::vector<McapChannel> channels_;                // likewise
  std::map<std::string, std::uint16_t> schema_ids_;  // by name
  std::vector<std::uint32_t> numbers_;
  McapChunkContent chunk_;
  Shown counts_;
};

}  // namespace kinalign
