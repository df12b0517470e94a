// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/record_stream.h"

#include <algorithm>
#include <tuple>
#include <utility>
#include <variant>

namespace kinalign {

Result<RecordStream> RecordStream::open(FileSystem& files, const RecordingParts& parts,
                                        const Progress& progress, TakePiece take_piece) {
  RecordStream stream;
  stream.progress_ = progress;
  stream.take_piece_ = std::move(take_piece);
  for (const RecordingPart& part : parts) {
    stream.parts_.push_back({KA_TRY(InputFile::open(files, part.path)), part.facts.has_value()});
    // The total for the progress is the size of all files together.
    stream.total_ += stream.parts_.back().file.size();
  }
  // A single part repeats nothing, so it is not read twice.
  if (parts.size() > 1) KA_TRY(stream.learn(files, parts));
  for (Part& part : stream.parts_) KA_TRY(stream.advance(part));
  return stream;
}

/// Reads each part alone, to learn the numbers of its messages and its definitions.
Result<void> RecordStream::learn(FileSystem& files, const RecordingParts& parts) {
  for (std::size_t k = 0; k < parts.size(); ++k) {
    RecordStream alone = KA_TRY(open(files, {parts[k]}, progress_));
    while (const McapRecord* record = KA_TRY(alone.next())) {
      // A definition or message without a checksum must not replace one with a checksum.
      if (alone.reader().unchecked()) continue;
      if (const auto* message = std::get_if<McapMessage>(record)) parts_[k].numbers.add(*message);
      const auto* schema = std::get_if<McapSchema>(record);
      if (schema != nullptr) checked_.schemas.try_emplace(schema->id, *schema);
      const auto* channel = std::get_if<McapChannel>(record);
      if (channel != nullptr) checked_.channels.try_emplace(channel->id, *channel);
    }
  }
  return {};
}

Result<const McapRecord*> RecordStream::next() {
  for (;;) {
    // The caller has a pointer to the last record, so its part advances only at the next call.
    if (taken_) KA_TRY(advance(parts_[*taken_]));
    taken_ = first();
    if (!taken_) return nullptr;
    if (passes(parts_[*taken_])) return &*parts_[*taken_].head;
  }
}

/// Reads the next record of a part.
Result<void> RecordStream::advance(Part& part) {
  const auto next_piece = [&]() -> Result<std::string_view> {
    const std::string_view piece = KA_TRY(part.file.next());
    if (take_piece_) take_piece_(static_cast<std::size_t>(&part - parts_.data()), piece);
    done_ += piece.size();
    if (go_on(progress_, "reading", done_, total_)) return piece;
    return Failure(interruption(part.file.path()));
  };
  const auto* read = part.head ? std::get_if<McapMessage>(&*part.head) : nullptr;
  if (read != nullptr) {
    // Numbers below `end` are read already. waits() only asks for later numbers.
    part.end[read->channel] = std::uint64_t{read->sequence} + 1;
    ++part.place;
  }
  part.head = KA_TRY(pull(part.reader, next_piece));
  if (!part.reader.is_mcap()) {
    return Failure(Error{part.file.path(), 0, "an MCAP file", "another beginning"});
  }
  // `place` counts messages within a chunk, so it begins again at each chunk.
  if (std::exchange(part.chunk, part.reader.at()) != part.reader.at()) part.place = 0;
  return {};
}

/// Chooses the part with the next record. Messages with a checksum come first, then messages that
/// need not wait, then the earliest log time. The channels of a device therefore keep their common
/// order.
std::optional<std::size_t> RecordStream::first() const {
  std::optional<std::size_t> first;
  std::tuple<bool, bool, std::uint64_t> least;
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const Part& part = parts_[k];
    if (!part.head) continue;
    const auto* message = std::get_if<McapMessage>(&*part.head);
    // Definitions and metadata have no time. They come first, because later messages need them.
    const std::tuple rank(part.reader.in_truncated_chunk(),
                          message != nullptr && waits(part, *message),
                          message == nullptr ? 0 : message->log_time);
    if (first && rank >= least) continue;
    first = k;
    least = rank;
  }
  return first;
}

/// True if another part has a lower number of the message's channel that is not read yet.
bool RecordStream::waits(const Part& part, const McapMessage& message) const {
  return std::any_of(parts_.begin(), parts_.end(), [&](const Part& other) {
    if (&other == &part || !other.head) return false;
    const auto end = other.end.find(message.channel);
    const auto next = other.numbers.next(message.channel, end == other.end.end() ? 0 : end->second);
    return next && *next < message.sequence;
  });
}

bool RecordStream::passes(Part& part) {
  const McapRecord& record = *part.head;
  const bool unchecked = part.reader.unchecked();
  if (const auto* message = std::get_if<McapMessage>(&record)) return passes(part, *message);
  if (const auto* schema = std::get_if<McapSchema>(&record)) {
    return !unchecked || !checked_.schemas.contains(schema->id);
  }
  if (const auto* channel = std::get_if<McapChannel>(&record)) {
    return !unchecked || !checked_.channels.contains(channel->id);
  }
  // Parts repeat the metadata and attachments of the first file, so only the first copy passes.
  if (const auto* attachment = std::get_if<McapAttachment>(&record)) {
    return is_first("attachment " + attachment->name);
  }
  if (const auto* statistics = std::get_if<McapStatistics>(&record)) {
    part.counted = statistics->messages;
  }
  const auto* metadata = std::get_if<McapMetadata>(&record);
  if (metadata == nullptr) return true;
  // A truncated part that recover repaired is not the recording's end if later parts exist.
  const Ending end = ending_of(*metadata);
  if (end == Ending::ended || is_last_part()) ending_ = std::max(ending_, end);
  return is_first("metadata " + metadata->name);
}

/// True if no earlier part has a record of this name. A file of another program may have several
/// such records.
bool RecordStream::is_first(const std::string& name) {
  return names_.try_emplace(name, *taken_).first->second == *taken_;
}

/// True if the last message can't be one. The recorder writes all messages into chunks, and a live
/// stream has none. A message outside of the chunks is therefore another record whose opcode is
/// damaged, and its number must not replace the number of a real message.
bool RecordStream::is_outside(Part& part) {
  if (!part.reader.unchecked()) part.has_chunks = true;
  return part.is_ours && part.has_chunks && part.reader.outside_chunks();
}

/// Damaged bytes of a truncated chunk may look like a message with any number. Such a message is
/// accepted only if its number is at most most_ahead above the last number of its channel.
bool RecordStream::passes(Part& part, const McapMessage& message) {
  constexpr std::uint32_t most_ahead = 1024;  // a chunk contains fewer messages of a device
  if (is_outside(part)) {
    ++part.outside;
    return false;
  }
  const auto last = numbers_.last(message.channel);
  // Files of other programs are not checked by numbers, because their numbers may repeat.
  if (part.is_ours && numbers_.has(message)) {
    ++repeated_;
    return false;
  }
  if (part.is_ours && part.reader.in_truncated_chunk() && last && message.sequence > *last &&
      message.sequence - *last > most_ahead) {
    ++part.impossible;
    return false;
  }
  // A message that fills a gap late is returned, too. A finding then says that messages are out of
  // order.
  if (part.is_ours && last && message.sequence < *last) in_order_ = false;
  numbers_.add(message);
  ++part.passed;
  if (part.reader.unchecked()) ++part.unchecked;
  return true;
}

std::uint64_t RecordStream::missing() const {
  const Part& part = parts_.front();
  // Programs other than kinalign may number messages differently.
  const std::uint64_t by_number = part.is_ours ? numbers_.missing() : 0;
  // The file's own statistics count all messages, also those missing at the end, which numbers
  // don't show.
  const bool is_counted =
      parts_.size() == 1 && part.reader.closed() && !part.reader.is_summary_damaged();
  return is_counted && part.counted > part.passed ? std::max(by_number, part.counted - part.passed)
                                                  : by_number;
}

std::uint64_t RecordStream::unchecked() const {
  std::uint64_t all = 0;
  for (const Part& part : parts_) all += part.reader.all_checked() ? 0 : part.unchecked;
  return all;
}

std::uint64_t RecordStream::skipped() const {
  std::uint64_t all = 0;
  for (const Part& part : parts_) all += part.reader.skipped();
  return all;
}

Ending RecordStream::ending() const {
  // Only the last part may contain the recording's end, so it decides.
  return parts_.back().reader.closed() ? ending_ : std::max(ending_, Ending::truncated);
}

std::vector<std::string> RecordStream::truncated() const {
  std::vector<std::string> paths;
  for (const Part& part : parts_) {
    if (!part.reader.closed()) paths.push_back(part.file.path());
  }
  return paths;
}

Findings RecordStream::findings() const {
  Findings findings;
  for (const Part& part : parts_) {
    const std::string& path = part.file.path();
    for (Finding finding : part.reader.findings()) {
      finding.what.file = path;
      findings.push_back(std::move(finding));
    }
    if (part.impossible > 0) {
      findings.push_back(
          {Severity::error,
           Error{path, 0, "plausible message numbers in the truncated chunk",
                 std::to_string(part.impossible) + " messages with impossible numbers"},
           "these messages have no checksum and are damaged, so they are left out", ""});
    }
    if (part.outside == 0) continue;
    findings.push_back({Severity::error,
                        Error{path, 0, "all messages in chunks",
                              std::to_string(part.outside) + " outside of the chunks"},
                        "these are other records with a damaged opcode, so they are left out", ""});
  }
  if (in_order_) return findings;
  findings.push_back(
      {Severity::warning,
       Error{parts_.front().file.path(), 0, "each channel's messages in order",
             "some messages after later ones"},
       "all of them are read, but align may leave some out",
       "recover the recording's original files together, without a file that recover made"});
  return findings;
}

}  // namespace kinalign
