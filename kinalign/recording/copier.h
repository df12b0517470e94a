// SPDX-License-Identifier: Apache-2.0
// Writes the records of a recording's files into one new file, for `recover`.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/mcap/writer.h"
#include "kinalign/recording/message_numbers.h"
#include "kinalign/recording/parts.h"
#include "kinalign/recording/recovered.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace kinalign {

class RecordingCopier {
 public:
  /// Both arguments must outlive the copier.
  RecordingCopier(OutputFile& out, const RecordingParts& parts);

  /// Takes a record of a part. Call in the order in which the new file shall contain the messages.
  /// The record is written unless another part has a better copy, or a copy of another part was
  /// written already. `unchecked`: no checksum covers the record.
  Result<void> take(const McapRecord& record, std::size_t part, bool unchecked);
  /// A checksum covers all of this part, so its messages do not count as unchecked.
  void all_checked(std::size_t part) { unchecked_[part] = 0; }
  /// Writes index and end. `torn`: the file with the highest part number is truncated.
  Result<void> finish(bool torn);

  /// Returns whether the files contain nothing but a header and definitions.
  bool is_empty() const { return recovered.messages == 0 && names_.empty(); }
  std::uint64_t size() const { return writer_.size(); }
  /// Written messages that no checksum covers.
  std::uint64_t unchecked() const;
  /// The numbers of the written messages. Empty if kinalign did not make the recording.
  MessageNumbers numbers() const;
  /// Returns whether all messages of the first reading were read again. It is false if the disk
  /// gives different data each time.
  bool has_all() const;
  /// Returns whether a survey of the new file found everything that was written.
  bool proved_by(const RecordingSurvey& proof) const;

  Recovered recovered;
  /// Messages by the file's own statistics; 0 if the statistics may be damaged.
  std::uint64_t counted = 0;

 private:
  void learn(const McapDefinitions& definitions);
  Result<void> begin(const McapHeader& header);
  Result<void> add(const McapHeader& header) { return begin(header); }
  Result<void> add(const McapSchema& schema);
  Result<void> add(const McapChannel& channel);
  Result<void> add(const McapMetadata& metadata);
  Result<void> add(const McapAttachment& attachment);
  Result<void> add(const McapMessage& message);
  Result<void> add(const McapStatistics& statistics);
  template <class Other>
  Result<void> add(const Other&) {
    return {};  // the new file gets its own summary
  }
  McapMetadata of_all(McapMetadata metadata) const;
  bool is_repeated(const std::string& name);
  bool stands_in_another(const McapMessage& message) const;
  Result<void> close_chunk();

  McapWriter writer_;
  const RecordingParts& parts_;
  std::size_t part_ = 0;
  bool is_unchecked_ = false;
  bool torn_ = false;  // the file with the highest part number has the record kinalign.torn
  std::vector<std::uint64_t> unchecked_;  // messages without a checksum, by part
  std::vector<MessageNumbers> written_;   // by part; empty if kinalign did not make the recording
  std::map<std::uint16_t, McapSchema> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
  // Checksum over the written messages, compared with that of the survey.
  std::uint32_t contents_ = 0;
  std::set<std::string> names_;  // names of metadata and attachments
  McapChunkContent chunk_;
};

}  // namespace kinalign
