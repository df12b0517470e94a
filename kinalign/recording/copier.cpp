// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/copier.h"

#include "kinalign/mcap/store.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <utility>
#include <variant>

namespace kinalign {

RecordingCopier::RecordingCopier(OutputFile& out, const RecordingParts& parts)
    : writer_(mcap_store(out)), parts_(parts), unchecked_(parts.size()), written_(parts.size()) {
  for (const RecordingPart& part : parts) learn(part.definitions);
  for (const RecordingPart& part : parts) learn(part.unproved_definitions);
}

Result<void> RecordingCopier::take(const McapRecord& record, std::size_t part, bool unchecked) {
  part_ = part;
  is_unchecked_ = unchecked;
  if (!std::holds_alternative<McapHeader>(record)) KA_TRY(begin({}));
  return std::visit([this](const auto& one) { return add(one); }, record);
}

Result<void> RecordingCopier::finish(bool torn) {
  KA_TRY(begin({}));
  KA_TRY(close_chunk());
  const auto has = [this](std::string_view name) {
    return names_.contains("metadata " + std::string(name));
  };
  if ((torn || torn_) && has(recording_metadata) && !has(end_metadata)) {
    KA_TRY(writer_.write(McapMetadata{std::string(torn_metadata), {}}));
  }
  return writer_.finish();
}

std::uint64_t RecordingCopier::unchecked() const {
  return std::accumulate(unchecked_.begin(), unchecked_.end(), std::uint64_t{0});
}

MessageNumbers RecordingCopier::numbers() const {
  MessageNumbers all;
  for (const MessageNumbers& one : written_) all.add_all(one);
  return all;
}

bool RecordingCopier::has_all() const {
  const MessageNumbers all = numbers();
  return std::all_of(parts_.begin(), parts_.end(),
                     [&all](const RecordingPart& part) { return all.has_all(part.numbers); });
}

bool RecordingCopier::proved_by(const RecordingSurvey& proof) const {
  const auto known = [this](const ChannelSurvey& one) {
    const auto channel = channels_.find(one.channel.id);
    return channel != channels_.end() && one.channel == channel->second;
  };
  return proof.torn.empty() && !proof.flawed && proof.messages == recovered.messages &&
         proof.contents == contents_ &&
         std::all_of(proof.channels.begin(), proof.channels.end(), known);
}

/// Adds definitions. Existing definitions of the same id are kept.
void RecordingCopier::learn(const McapDefinitions& definitions) {
  schemas_.insert(definitions.schemas.begin(), definitions.schemas.end());
  channels_.insert(definitions.channels.begin(), definitions.channels.end());
}

Result<void> RecordingCopier::begin(const McapHeader& header) {
  return writer_.size() == 0 ? writer_.begin(header) : Result<void>();
}

/// An MCAP id has one meaning in a file, and the parts of a recording share ids. The first
/// definition is kept, because a damaged summary must not override the definitions in the data
/// section.
Result<void> RecordingCopier::add(const McapSchema& schema) {
  schemas_.try_emplace(schema.id, schema);
  return {};
}

Result<void> RecordingCopier::add(const McapChannel& channel) {
  channels_.try_emplace(channel.id, channel);
  return {};
}

Result<void> RecordingCopier::add(const McapMetadata& metadata) {
  if (metadata.name == torn_metadata) {  // counts only in the file with the highest part number
    torn_ = torn_ || part_ == furthest(parts_);
    return {};
  }
  if (is_repeated(name_of(metadata))) return {};
  KA_TRY(close_chunk());
  return writer_.write(to_facts(metadata) ? of_all(metadata) : metadata);
}

Result<void> RecordingCopier::add(const McapAttachment& attachment) {
  if (is_repeated(name_of(attachment))) return {};
  KA_TRY(close_chunk());
  return writer_.write(attachment);
}

// A message whose channel has no definition cannot be used. A message with a better copy in another
// part is counted only.
Result<void> RecordingCopier::add(const McapMessage& message) {
  const std::uint16_t id = message.channel;
  const auto known = channels_.find(id);
  if (known == channels_.end()) {
    ++recovered.nameless;
    return {};
  }
  if (stands_in_another(message)) {
    ++recovered.twice;
    return {};
  }
  if (!chunk_.messages().contains(id)) {
    const auto schema = schemas_.find(known->second.schema_id);
    if (schema != schemas_.end()) chunk_.add(schema->second);
    chunk_.add(known->second);
  }
  chunk_.add(message);
  contents_ = add_to(contents_, message);
  if (parts_.front().is_ours()) written_[part_].add(message);
  ++recovered.messages;
  if (is_unchecked_) ++unchecked_[part_];
  constexpr std::size_t chunk_bytes = std::size_t{1} << 20;
  return chunk_.size() < chunk_bytes ? Result<void>() : close_chunk();
}

Result<void> RecordingCopier::add(const McapStatistics& statistics) {
  counted += statistics.messages;
  return {};
}

/// Changes the metadata of one part so that it describes all parts together.
McapMetadata RecordingCopier::of_all(McapMetadata metadata) const {
  if (parts_.size() == 1) return metadata;
  std::set<int> joined;
  for (const RecordingPart& part : parts_) {
    joined.insert(part.facts.part);
    joined.insert(part.facts.joined.begin(), part.facts.joined.end());
  }
  metadata.texts["part"] = std::to_string(*joined.begin());
  metadata.texts["joined"] = fmt::format("{}", fmt::join(joined, " "));
  return metadata;
}

/// Returns whether the record repeats one of another part: each file of a recording begins with the
/// same records. Within one file, records may share a name, because other programs write several.
bool RecordingCopier::is_repeated(const std::string& name) {
  names_.insert(name);
  const std::size_t source = source_of(parts_, name);
  return source < parts_.size() && source != part_;
}

/// Returns whether the message is taken from another part. It is also if the copy of another part
/// was written already, because the first reading had not found that copy.
bool RecordingCopier::stands_in_another(const McapMessage& message) const {
  if (has_better(parts_, part_, message)) return true;
  for (std::size_t other = 0; other < parts_.size(); ++other) {
    if (other != part_ && written_[other].has(message) && !written_[part_].has(message))
      return true;
  }
  return false;
}

Result<void> RecordingCopier::close_chunk() {
  if (chunk_.empty()) return {};
  return writer_.write(store(std::exchange(chunk_, {}), McapCompression::zstd));
}

}  // namespace kinalign
