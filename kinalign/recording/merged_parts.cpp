// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/merged_parts.h"

#include <utility>
#include <variant>

namespace kinalign {

Result<MergedParts> MergedParts::open(FileSystem& files, const RecordingParts& parts,
                                      const Progress& progress) {
  MergedParts merged;
  merged.progress_ = progress;
  for (const RecordingPart& part : parts) {
    merged.parts_.push_back(
        std::make_unique<Part>(Part{KA_TRY(InputFile::open(files, part.path)), &part}));
    merged.total_ += merged.parts_.back()->file.size();
  }
  for (const auto& part : merged.parts_) KA_TRY(merged.advance(*part));
  return merged;
}

Result<std::optional<PartRecord>> MergedParts::next() {
  if (taken_) KA_TRY(advance(*parts_[*taken_]));
  taken_ = first();
  if (!taken_) return std::nullopt;
  return PartRecord{&*parts_[*taken_]->head, *taken_};
}

Result<void> MergedParts::advance(Part& part) {
  if (const auto* given = part.head ? std::get_if<McapMessage>(&*part.head) : nullptr) {
    part.given[given->channel] = std::uint64_t{given->sequence} + 1;
  }
  do part.head = KA_TRY(pull_from(part));
  while (is_stray(part));
  if (part.reader.is_mcap()) return {};
  return Failure(Error{part.file.path(), 0, "an MCAP file", "another beginning"});
}

Result<std::optional<McapRecord>> MergedParts::pull_from(Part& part) {
  const auto next_piece = [&]() -> Result<std::string_view> {
    const std::string_view piece = KA_TRY(part.file.next_or_zeros());
    done_ += piece.size();
    if (!go_on(progress_, "reading", done_, total_)) {
      return Failure(interruption(part.file.path()));
    }
    return piece;
  };
  return pull(part.reader, next_piece);
}

/// Returns whether the number of the message is impossible. Files of other programs are not
/// checked, because their numbers have no fixed order.
bool MergedParts::is_stray(Part& part) {
  const auto* message = part.head ? std::get_if<McapMessage>(&*part.head) : nullptr;
  return message != nullptr && part.told->is_ours() &&
         !part.guard.believes(*message, part.reader.unchecked());
}

/// Chooses the part with the next record. If all files wait for one another, the earliest message
/// is chosen.
std::optional<std::size_t> MergedParts::first() const {
  std::optional<std::size_t> first;
  std::pair<bool, std::uint64_t> least;  // whether the message waits, and its log time
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (!parts_[i]->head) continue;
    const auto* message = std::get_if<McapMessage>(&*parts_[i]->head);
    if (message == nullptr) return i;
    const std::pair rank(waits(i, *message), message->log_time);
    if (first && rank >= least) continue;
    first = i;
    least = rank;
  }
  return first;
}

// A message waits while another file still has a lower number of its channel.
bool MergedParts::waits(std::size_t part, const McapMessage& message) const {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Part& other = *parts_[i];
    if (i == part || !other.head) continue;
    const auto given = other.given.find(message.channel);
    const auto next =
        other.told->numbers.next(message.channel, given == other.given.end() ? 0 : given->second);
    if (next && *next < message.sequence) return true;
  }
  return false;
}

}  // namespace kinalign
