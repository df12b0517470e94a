// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/recover.h"

#include "kinalign/core/crc.h"
#include "kinalign/core/file_version.h"
#include "kinalign/formats/unknown_file.h"
#include "kinalign/mcap/store.h"
#include "kinalign/recording/record_stream.h"
#include "kinalign/recording/survey.h"
#include "kinalign/wire/little_endian_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <set>
#include <utility>
#include <variant>

namespace kinalign {

namespace {

/// The number of messages and the CRC-32 of channel, number, both times and payload of all
/// messages. It is computed while writing and again while reading the new file. Both results must
/// be equal.
struct Contents {
  std::uint64_t messages = 0;
  std::uint32_t crc = 0;

  void add(const McapMessage& message) {
    std::string head;
    append_little(message.channel, head);
    append_little(message.sequence, head);
    append_little(message.log_time, head);
    append_little(message.publish_time, head);
    append_little(static_cast<std::uint64_t>(message.data.size()), head);
    crc = crc_of(message.data, crc_of(head, crc));
    ++messages;
  }
  bool operator==(const Contents&) const = default;
};

/// Writes the records of a stream into the new file. Definitions are remembered, and each chunk
/// gets the definitions that its messages need. Metadata and attachments stand outside of chunks,
/// so the open chunk is closed before them.
class Copier {
 public:
  Copier(OutputFile& out, const RecordingParts& parts) : writer_(mcap_store(out)), parts_(parts) {}

  Result<void> take(const McapRecord& record) {
    // The new file gets a header even if the header of the old file is damaged.
    if (!std::holds_alternative<McapHeader>(record)) KA_TRY(begin({}));
    return std::visit([this](const auto& one) { return add(one); }, record);
  }
  /// Writes index and end. `ending`: the end of the recording.
  Result<void> finish(Ending ending) {
    KA_TRY(close_chunk());
    if (ending == Ending::truncated && parts_.front().facts) {
      KA_TRY(writer_.write(McapMetadata{std::string(truncated_metadata), {}}));
    }
    return writer_.finish();
  }

  std::uint64_t size() const { return writer_.size(); }
  const Contents& contents() const { return contents_; }
  std::size_t channels() const { return copied_.size(); }
  std::uint64_t nameless() const { return undefined_; }
  /// True if the files contain only a header and definitions.
  bool is_empty() const { return contents_.messages == 0 && is_empty_; }

 private:
  Result<void> begin(const McapHeader& header) {
    return writer_.size() == 0 ? writer_.begin(header) : Result<void>();
  }
  Result<void> add(const McapHeader& header) { return begin(header); }
  // The first definition is kept, so that a damaged summary can't override the definitions in the
  // data section.
  Result<void> add(const McapSchema& schema) {
    schemas_.try_emplace(schema.id, schema);
    return {};
  }
  Result<void> add(const McapChannel& channel) {
    channels_.try_emplace(channel.id, channel);
    return {};
  }
  Result<void> add(const McapMetadata& metadata) {
    if (metadata.name == truncated_metadata) return {};  // finish() writes this record
    is_empty_ = false;
    KA_TRY(close_chunk());
    return writer_.write(to_facts(metadata) ? of_all_parts(metadata) : metadata);
  }
  Result<void> add(const McapAttachment& attachment) {
    is_empty_ = false;
    KA_TRY(close_chunk());
    return writer_.write(attachment);
  }
  Result<void> add(const McapMessage& message) {
    // Readers can't decode a message without a definition of its channel. Such a message is left
    // out and counted.
    const auto channel = channels_.find(message.channel);
    if (channel == channels_.end()) {
      ++undefined_;
      return {};
    }
    if (!chunk_.messages().contains(message.channel)) {
      const auto schema = schemas_.find(channel->second.schema_id);
      if (schema != schemas_.end()) chunk_.add(schema->second);
      chunk_.add(channel->second);
      copied_.insert(message.channel);
    }
    chunk_.add(message);
    contents_.add(message);
    // The recorder uses the same size of chunks.
    constexpr std::size_t chunk_bytes = std::size_t{1} << 20;
    return chunk_.size() < chunk_bytes ? Result<void>() : close_chunk();
  }
  template <class Other>
  Result<void> add(const Other&) {
    return {};  // the new file gets its own summary
  }

  /// Changes the metadata of one part so that they describe all parts together.
  McapMetadata of_all_parts(McapMetadata metadata) const {
    if (parts_.size() == 1) return metadata;
    std::set<int> joined;
    for (const RecordingPart& part : parts_) {
      joined.insert(part.facts->part);
      joined.insert(part.facts->joined.begin(), part.facts->joined.end());
    }
    // The joined file names all parts that it contains, so that no part is read in addition.
    metadata.texts["part"] = std::to_string(*joined.begin());
    metadata.texts["joined"] = fmt::format("{}", fmt::join(joined, " "));
    return metadata;
  }
  Result<void> close_chunk() {
    if (chunk_.empty()) return {};
    return writer_.write(store(std::exchange(chunk_, {}), McapCompression::zstd));
  }

  McapWriter writer_;
  const RecordingParts& parts_;
  std::map<std::uint16_t, McapSchema> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
  std::set<std::uint16_t> copied_;  // channels with messages
  McapChunkContent chunk_;
  Contents contents_;
  std::uint64_t undefined_ = 0;
  bool is_empty_ = true;
};

/// Before anything is read, checks that the files are MCAP files. Also checks that `out` overwrites
/// neither these files nor another part in their folders.
Result<void> check_names(FileSystem& files, const std::vector<std::string>& paths,
                         const std::string& out) {
  for (const std::string& path : paths) {
    InputFile file = KA_TRY(InputFile::open(files, path));
    const std::string_view head = KA_TRY(file.next());
    if (head.empty()) return Failure(unknown_file(path, head));
    if (!looks_like_recording(head)) {
      return Failure(Error{path, 0, "an MCAP file", beginning_of(head)});
    }
  }
  for (const std::string& path : with_siblings(files, paths)) {
    if (!same_file(out, path)) continue;
    return Failure(Error{out, 0, "another name than those of the recording's files",
                         "'" + shown(file_name(path)) + "', which is one of them"});
  }
  return {};
}

/// Reads the new file before it gets its name. A checksum covers every byte of it.
Result<void> prove(const OutputFile& file, const Copier& copier, const Progress& progress) {
  std::string buffer(InputFile::piece_size, '\0');
  std::uint64_t at = 0;
  const auto next_piece = [&]() -> Result<std::string_view> {
    const std::size_t got = KA_TRY(file.read_at(at, buffer));
    at += got;
    if (!go_on(progress, "reading again", at, copier.size())) return Failure(interruption());
    return std::string_view(buffer).substr(0, got);
  };
  McapReader reader;
  Contents read;
  while (const auto record = KA_TRY(pull(reader, next_piece))) {
    if (const auto* message = std::get_if<McapMessage>(&*record)) read.add(*message);
  }
  // All three conditions are needed: the end was reached, nothing was damaged, and the messages are
  // the same.
  if (reader.closed() && reader.findings().empty() && read == copier.contents()) return {};
  return Failure(Error{file.path(), 0,
                       fmt::format("{} messages, read again", copier.contents().messages),
                       fmt::format("{} messages, some of them changed", read.messages)});
}

}  // namespace

Result<Recovered> recover_recording(FileSystem& files, const std::vector<std::string>& paths,
                                    const std::string& out, Overwrite overwrite,
                                    const Progress& progress) {
  // The names are checked first, so that a wrong `out` does not cost the reading of a long
  // recording or overwrite a file.
  KA_TRY(check_names(files, paths, out));
  OutputFile file = KA_TRY(OutputFile::create(files, out, overwrite));
  const RecordingParts parts = KA_TRY(find_parts(files, paths));
  RecordStream stream = KA_TRY(RecordStream::open(files, parts, progress));
  Copier copier(file, parts);
  while (const McapRecord* record = KA_TRY(stream.next())) KA_TRY(copier.take(*record));
  const std::string& first = parts.front().path;
  // A new file without messages would look like a successful recovery.
  if (copier.is_empty()) {
    return Failure(Error{first, 0, "a recording with at least one readable message", "none"});
  }
  KA_TRY(copier.finish(stream.ending()));
  // Before commit() the new file has a temporary name, so a failure leaves no file.
  KA_TRY(prove(file, copier, progress));

  Recovered done{copier.contents().messages, copier.channels(), stream.unchecked(),
                 stream.repeated(),          copier.nameless(), stream.skipped(),
                 stream.missing(),           stream.findings()};
  append(done.findings,
         judge_end(parts.back().path, parts.front().facts.has_value(), stream.ending()));
  append(done.findings, judge_parts(files, parts, Severity::note));
  KA_TRY(file.commit());
  return done;
}

}  // namespace kinalign
