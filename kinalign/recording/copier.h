// SPDX-License-Identifier: Apache-2.0
// The records of a recording's files, written anew into one: what `recover` does with them.
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
  /// Both have to stay.
  RecordingCopier(OutputFile& out, const RecordingParts& parts);

  /// A record of that part, in the order in which the new file is to have its messages: written,
  /// unless another part has a better copy of it, or one of another part was. `unchecked`: no
  /// checksum covers it.
  Result<void> take(const McapRecord& record, std::size_t part, bool unchecked);
  /// Of this part a checksum covers everything after all.
  void all_checked(std::size_t part) { unchecked_[part] = 0; }
  /// Index and end; `torn`: the part that reaches furthest is.
  Result<void> finish(bool torn);

  /// Nothing but a header and definitions was there, which says nothing.
  bool is_empty() const { return recovered.messages == 0 && names_.empty(); }
  std::uint64_t size() const { return writer_.size(); }
  std::uint64_t unchecked() const;
  /// Of those that were written, where the recording is ours.
  MessageNumbers numbers() const;
  /// Whether it has all messages that a first reading found in the parts: of a disk that gives the
  /// same each time it has.
  bool has_all() const;
  /// Whether a survey of the new file found in it what was written.
  bool proved_by(const RecordingSurvey& proof) const;

  Recovered recovered;
  /// Messages, by the file's own statistics: as long as nothing says that they are damaged.
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
    return {};  // the summary is made anew
  }
  McapMetadata of_all(McapMetadata metadata) const;
  bool is_repeated(const std::string& name);
  bool stands_in_another(const McapMessage& message) const;
  Result<void> close_chunk();

  McapWriter writer_;
  const RecordingParts& parts_;
  std::size_t part_ = 0;
  bool is_unchecked_ = false;
  bool torn_ = false;                     // the part that reaches furthest says so of itself
  std::vector<std::uint64_t> unchecked_;  // messages, by part
  std::vector<MessageNumbers> written_;   // by part, where the recording is ours
  std::map<std::uint16_t, McapSchema> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
  std::uint32_t contents_ = 0;
  std::set<std::string> names_;  // of metadata and attachments
  McapChunkContent chunk_;
};

}  // namespace kinalign
