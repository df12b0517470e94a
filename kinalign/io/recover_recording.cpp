// SPDX-License-Identifier: Apache-2.0
#include "kinalign/io/recover_recording.h"

#include "kinalign/core/file_version.h"
#include "kinalign/io/mcap_store.h"
#include "kinalign/io/merged_parts.h"
#include "kinalign/io/recording_beside.h"
#include "kinalign/io/recording_parts.h"
#include "kinalign/io/recording_reader.h"
#include "kinalign/io/unknown_file.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace kinalign {

namespace {

constexpr std::size_t chunk_bytes = std::size_t{1} << 20;

/// The new file, from its front, before it has its name.
PieceSource pieces_of(const OutputFile& file, std::uint64_t size, std::string& buffer) {
  return {file.path(), size,
          [&file, &buffer, at = std::uint64_t{0}]() mutable -> Result<std::string_view> {
            buffer.resize(InputFile::piece_size);
            const std::size_t got = KA_TRY(file.read_at(at, buffer));
            at += got;
            return std::string_view(buffer).substr(0, got);
          }};
}

/// Takes the records of all files and writes them anew.
class Copier {
 public:
  Copier(OutputFile& out, const RecordingParts& parts)
      : writer_(mcap_store(out)), parts_(parts), unchecked_(parts.size()) {}

  Result<void> take(const McapRecord& record, std::size_t part, bool unchecked) {
    part_ = part;
    is_unchecked_ = unchecked;
    if (!std::holds_alternative<McapHeader>(record)) KA_TRY(begin({}));
    return std::visit([this](const auto& one) { return add(one); }, record);
  }

  Result<void> finish() {
    KA_TRY(begin({}));
    KA_TRY(close_chunk());
    const auto has = [this](std::string_view name) {
      return names_.contains("metadata " + std::string(name));
    };
    if (torn && has(recording_metadata) && !has(end_metadata)) {
      KA_TRY(writer_.write(McapMetadata{std::string(torn_metadata), {}}));
    }
    return writer_.finish();
  }
  std::uint64_t size() const { return writer_.size(); }
  /// Nothing but a header and definitions was there.
  bool is_empty() const { return recovered.messages == 0 && names_.empty(); }
  /// Whether a survey of the new file found in it what was written.
  bool proved_by(const RecordingSurvey& proof) const {
    const auto known = [this](const ChannelSurvey& one) {
      const auto channel = channels_.find(one.channel.id);
      return channel != channels_.end() && one.channel == channel->second;
    };
    return proof.torn.empty() && proof.findings.empty() && proof.messages == recovered.messages &&
           proof.contents == contents_ &&
           std::all_of(proof.channels.begin(), proof.channels.end(), known);
  }

  Recovered recovered;
  MessageNumbers numbers;  // of those that were written
  /// Messages, by the file's own statistics: as long as nothing says that they are damaged.
  std::uint64_t counted = 0;
  bool torn = false;  // the last part
  /// Of this part a checksum covers everything after all.
  void all_checked(std::size_t part) { unchecked_[part] = 0; }
  std::uint64_t unchecked() const {
    return std::accumulate(unchecked_.begin(), unchecked_.end(), std::uint64_t{0});
  }

 private:
  Result<void> begin(const McapHeader& header) {
    return writer_.size() == 0 ? writer_.begin(header) : Result<void>();
  }
  Result<void> add(const McapHeader& header) { return begin(header); }
  /// MCAP: an id means one thing in a file, and parts of a recording share them. What a summary
  /// repeats and damage has changed is none the wiser.
  Result<void> add(const McapSchema& schema) {
    schemas_.try_emplace(schema.id, schema);
    return {};
  }
  Result<void> add(const McapChannel& channel) {
    channels_.try_emplace(channel.id, channel);
    return {};
  }
  Result<void> add(const McapMetadata& metadata) {
    if (metadata.name == torn_metadata) {  // of the last part alone, and at the end
      torn = torn || part_ + 1 == parts_.size();
      return {};
    }
    if (is_repeated(name_of(metadata))) return {};
    KA_TRY(close_chunk());
    return writer_.write(metadata);
  }
  Result<void> add(const McapAttachment& attachment) {
    if (is_repeated(name_of(attachment))) return {};
    KA_TRY(close_chunk());
    return writer_.write(attachment);
  }
  Result<void> add(const McapMessage& message) {
    const std::uint16_t id = message.channel;
    const auto known = channels_.find(id);
    if (known == channels_.end()) {
      ++recovered.nameless;
      return {};
    }
    if (has_better(parts_, part_, message)) {
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
    numbers.add(message);
    ++recovered.messages;
    if (is_unchecked_) ++unchecked_[part_];
    return chunk_.size() < chunk_bytes ? Result<void>() : close_chunk();
  }
  /// Each file of a recording begins with what the first one says. Within a file records may share
  /// a name: programs of others write several.
  bool is_repeated(const std::string& name) {
    names_.insert(name);
    return std::any_of(parts_.begin(), parts_.begin() + static_cast<std::ptrdiff_t>(part_),
                       [&name](const RecordingPart& part) { return part.names.contains(name); });
  }
  Result<void> add(const McapStatistics& statistics) {
    counted += statistics.messages;
    return {};
  }
  template <class Other>
  Result<void> add(const Other&) {
    return {};  // the summary is made anew
  }

  Result<void> close_chunk() {
    if (chunk_.empty()) return {};
    return writer_.write(store(std::exchange(chunk_, {}), McapCompression::zstd));
  }

  McapWriter writer_;
  const RecordingParts& parts_;
  std::size_t part_ = 0;
  bool is_unchecked_ = false;
  std::vector<std::uint64_t> unchecked_;  // messages, by part
  std::map<std::uint16_t, McapSchema> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
  std::uint32_t contents_ = 0;
  std::set<std::string> names_;  // of metadata and attachments
  McapChunkContent chunk_;
};

Result<void> copy(FileSystem& files, const RecordingParts& parts, Copier& copier,
                  const Progress& progress) {
  MergedParts merged = KA_TRY(MergedParts::open(files, parts, progress));
  while (const auto one = KA_TRY(merged.next())) {
    KA_TRY(copier.take(*one->record, one->part, merged.reader(one->part).unchecked()));
  }
  for (std::size_t part = 0; part < parts.size(); ++part) {
    const McapReader& reader = merged.reader(part);
    copier.recovered.skipped += reader.skipped();
    if (reader.all_checked()) copier.all_checked(part);
    if (reader.summary_spoilt() || !reader.closed()) copier.counted = 0;
    for (Finding finding : reader.findings()) {
      finding.what.file = parts[part].path;
      copier.recovered.findings.push_back(std::move(finding));
    }
  }
  copier.torn = copier.torn || !merged.reader(parts.size() - 1).closed();
  copier.recovered.unchecked = copier.unchecked();
  return {};
}

/// Fails where the file does not begin as MCAP does.
Result<void> check_beginning(FileSystem& files, const std::string& path) {
  InputFile file = KA_TRY(InputFile::open(files, path));
  const std::string_view head = KA_TRY(file.next());
  if (head.empty()) return Failure(unknown_file(path, head));
  if (looks_like_recording(head)) return {};
  return Failure(Error{path, 0, "an MCAP file", beginning_of(head)});
}

/// Files that recover has made and that lack what is in others are the only ones to bring this
/// about.
Findings judge_order(const std::string& out, const Copier& copier) {
  const RecordingSurvey& proof = copier.recovered.proof;
  const auto is_disordered = [&copier](const ChannelSurvey& one) {
    return one.missing > copier.numbers.missing(one.channel.id);
  };
  if (!proof.facts || std::none_of(proof.channels.begin(), proof.channels.end(), is_disordered)) {
    return {};
  }
  return {{Severity::warning,
           Error{out, 0, "each channel's messages in their order", "some behind later ones"},
           "all are there, but check takes some for missing, and align leaves some out",
           "recover the recording's own files together, without one that recover has made"}};
}

/// Messages that were there and are not in the new file.
std::uint64_t missing(const Copier& copier, std::size_t parts) {
  const Recovered& recovered = copier.recovered;
  std::uint64_t by_number = 0;
  if (recovered.proof.facts) {  // programs of others number as they like
    for (const ChannelSurvey& one : recovered.proof.channels) {
      by_number += copier.numbers.missing(one.channel.id);
    }
  }
  const bool counted = parts == 1 && copier.counted > recovered.messages;
  return std::max(by_number, counted ? copier.counted - recovered.messages : 0);
}

Result<RecordingParts> parts_of(FileSystem& files, const std::vector<std::string>& paths,
                                const Progress& progress) {
  for (const std::string& path : paths) KA_TRY(check_beginning(files, path));
  const std::vector<std::string> all = with_parts(files, paths);
  return all.size() > 1 ? read_parts(files, all, progress)
                        : parts_from(files, all.front(), progress);
}

Error is_input(const std::string& out, const std::string& part) {
  return {out, 0, "another name than those of the recording's files",
          "'" + shown(file_name(part)) + "', which is one of them"};
}

/// Reads what was written, before it has its name.
Result<void> prove(Copier& copier, const OutputFile& file, const std::string& out,
                   const Progress& progress) {
  std::string buffer;
  Recovered& recovered = copier.recovered;
  recovered.proof = KA_TRY(survey_recording(pieces_of(file, copier.size(), buffer), progress));
  const RecordingSurvey& proof = recovered.proof;
  if (copier.proved_by(proof)) return {};
  return Failure(
      Error{out, 0, std::to_string(recovered.messages) + " messages, read again",
            std::to_string(proof.messages) +
                (proof.torn.empty() ? ", not all as they were written" : " and no end")});
}

}  // namespace

Result<Recovered> recover_recording(FileSystem& files, const std::vector<std::string>& paths,
                                    const std::string& out, Overwrite overwrite,
                                    const Progress& progress) {
  const RecordingParts parts = KA_TRY(parts_of(files, paths, progress));
  for (const std::string& path : with_namesakes(files, paths)) {  // needed or not
    if (same_file(out, path)) return Failure(is_input(out, path));
  }
  OutputFile file = KA_TRY(OutputFile::create(files, out, overwrite));
  Copier copier(file, parts);
  KA_TRY(copy(files, parts, copier, progress));
  Recovered& recovered = copier.recovered;
  if (copier.is_empty()) {
    return Failure(Error{paths.front(), 0, "a recording in which a message can be read", "none"});
  }
  KA_TRY(copier.finish());
  KA_TRY(prove(copier, file, out, progress));
  recovered.missing = missing(copier, parts.size());
  append(recovered.findings, judge_order(out, copier));
  append(recovered.findings, judge_end(parts.back().path, recovered.proof));
  append(recovered.findings, judge_parts(parts, PartsBehind::read));
  append(recovered.findings, judge_namesakes(files, parts.front().path));
  KA_TRY(file.commit());
  return std::move(recovered);
}

}  // namespace kinalign
