// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/part.h"

#include "kinalign/recording/survey.h"

#include <algorithm>
#include <variant>

namespace kinalign {

std::string name_of(const McapMetadata& metadata) { return "metadata " + metadata.name; }
std::string name_of(const McapAttachment& attachment) { return "attachment " + attachment.name; }

namespace {

/// Returns whether a file is damaged, not only truncated.
bool is_damaged(const McapReader& reader) {
  const Findings& findings = reader.findings();
  return reader.skipped() > 0 ||
         std::any_of(findings.begin(), findings.end(),
                     [](const Finding& one) { return one.severity == Severity::error; });
}

/// Collects the numbers and definitions of a file's messages, and how the file ends.
class PartReader {
 public:
  PartReader(RecordingPart& part, const McapReader& reader) : part_(part), reader_(reader) {}

  Result<void> take(const McapRecord& record) {
    std::visit([this](const auto& one) { add(one); }, record);
    return {};
  }

 private:
  McapDefinitions& definitions() {
    return reader_.unchecked() ? part_.unproved_definitions : part_.definitions;
  }
  void add(const McapMessage& message) {
    const bool is_named = defined_.contains(message.channel);
    const bool is_believed = guard_.believes(message, reader_.unchecked());
    if (!is_named || !is_believed) part_.is_sound = false;
    if (!is_believed) return;
    (is_named ? part_.numbers : part_.nameless).add(message);
    if (reader_.unchecked()) part_.unproved.add(message);
  }
  void add(const McapChannel& channel) {
    defined_.insert(channel.id);
    definitions().channels.try_emplace(channel.id, channel);
  }
  void add(const McapSchema& schema) { definitions().schemas.try_emplace(schema.id, schema); }
  void add(const McapMetadata& metadata) {
    part_.ending = std::max(part_.ending, ending_of(metadata));
    part_.names.insert(name_of(metadata));
  }
  void add(const McapAttachment& attachment) { part_.names.insert(name_of(attachment)); }
  template <class Other>
  void add(const Other&) {}

  RecordingPart& part_;
  const McapReader& reader_;
  NumberGuard guard_;
  std::set<std::uint16_t> defined_;
};

}  // namespace

Result<RecordingPart> read_part(FileSystem& files, const std::string& path,
                                const RecordingFacts& facts, const Progress& progress) {
  InputFile file = KA_TRY(InputFile::open(files, path));
  RecordingPart part{path, facts};
  McapReader reader;
  PartReader taker(part, reader);
  KA_TRY(read_recording(
      {path, file.size(), [&file] { return file.next_or_zeros(); }}, reader,
      [&taker](const McapRecord& record) { return taker.take(record); }, progress));
  if (!reader.closed()) part.ending = std::max(part.ending, Ending::torn);
  part.all_checked = reader.all_checked();
  if (part.all_checked) part.unproved = {};
  part.is_sound = part.is_sound && !is_damaged(reader) && file.unread() == 0;
  return part;
}

}  // namespace kinalign
