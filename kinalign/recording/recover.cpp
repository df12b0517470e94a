// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/recover.h"

#include "kinalign/core/file_version.h"
#include "kinalign/formats/unknown_file.h"
#include "kinalign/recording/beside.h"
#include "kinalign/recording/copier.h"
#include "kinalign/recording/merged_parts.h"
#include "kinalign/recording/parts.h"

#include <fmt/format.h>

#include <algorithm>

namespace kinalign {

namespace {

/// Reads the new file from its beginning, before it gets its name.
PieceSource pieces_of(const OutputFile& file, std::uint64_t size, std::string& buffer) {
  return {file.path(), size,
          [&file, &buffer, at = std::uint64_t{0}]() mutable -> Result<std::string_view> {
            buffer.resize(InputFile::piece_size);
            const std::size_t got = KA_TRY(file.read_at(at, buffer));
            at += got;
            return std::string_view(buffer).substr(0, got);
          }};
}

/// Reports everything in a part that could not be read.
Findings judge(const MergedParts& merged, std::size_t part, const std::string& path) {
  Findings findings = merged.reader(part).findings();
  for (Finding& finding : findings) finding.what.file = path;
  append(findings, judge_strays(path, merged.guard(part)));
  if (merged.unread(part) > 0) {
    findings.push_back({Severity::error,
                        Error{path, 0, "bytes that the disk can read",
                              fmt::format("{} that it can't", merged.unread(part))},
                        "what lay there is lost, the rest was read",
                        "ddrescue copies a bad disk and tries more often; recover that copy, too"});
  }
  return findings;
}

/// The error for a file in which nothing can be read. It names sibling files, because the beginning
/// that names the recording may be damaged.
Error nothing_in(FileSystem& files, const std::string& path) {
  std::string found = "nothing";
  for (const std::string& one : with_namesakes(files, {path})) {
    if (same_file(one, path)) continue;
    found += (found == "nothing" ? "; beside it are " : ", ") + shown(file_name(one));
  }
  return {path, 0, "a recording of which anything can be read", found};
}

Error reads_differently(const std::string& path) {
  return {path, 0, "files that a second reading finds as the first one did",
          "others: copy them with ddrescue, and recover the copies"};
}

/// Copies everything, and writes index and end.
Result<void> copy(FileSystem& files, const RecordingParts& parts, RecordingCopier& copier,
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
    append(copier.recovered.findings, judge(merged, part, parts[part].path));
  }
  copier.recovered.unchecked = copier.unchecked();
  if (!copier.has_all()) return Failure(reads_differently(parts.front().path));
  if (copier.is_empty()) return Failure(nothing_in(files, parts.front().path));
  return copier.finish(!merged.reader(furthest(parts)).closed());
}

/// Fails if the file does not begin as an MCAP file.
Result<void> check_beginning(FileSystem& files, const std::string& path) {
  InputFile file = KA_TRY(InputFile::open(files, path));
  const std::string_view head = KA_TRY(file.next_or_zeros());
  if (file.unread() > 0) return Failure(unreadable_beginning(path));
  if (head.empty()) return Failure(unknown_file(path, head));
  if (looks_like_recording(head)) return {};
  return Failure(Error{path, 0, "an MCAP file", beginning_of(head)});
}

/// The number of messages that were recorded and are not in the new file.
std::uint64_t missing(const RecordingCopier& copier, std::size_t parts) {
  const Recovered& recovered = copier.recovered;
  std::uint64_t by_number = 0;
  if (recovered.proof.facts) {  // other programs number messages as they like
    const MessageNumbers numbers = copier.numbers();
    for (const ChannelSurvey& one : recovered.proof.channels) {
      by_number += numbers.missing(one.channel.id);
    }
  }
  const bool counted = parts == 1 && copier.counted > recovered.messages;
  return std::max(by_number, counted ? copier.counted - recovered.messages : 0);
}

Result<RecordingParts> parts_of(FileSystem& files, const std::vector<std::string>& paths,
                                const Progress& progress) {
  const std::vector<std::string> all = with_parts(files, paths);
  return all.size() > 1 ? read_parts(files, all, progress)
                        : parts_from(files, all.front(), progress);
}

Error is_input(const std::string& out, const std::string& part) {
  return {out, 0, "another name than those of the recording's files",
          "'" + shown(file_name(part)) + "', which is one of them"};
}

/// Checks, before anything is read, that the files can be read and that none of them is
/// overwritten.
Result<void> check_names(FileSystem& files, const std::vector<std::string>& paths,
                         const std::string& out) {
  for (const std::string& path : paths) KA_TRY(check_beginning(files, path));
  for (const std::string& path : with_namesakes(files, paths)) {  // also files that are not needed
    if (same_file(out, path)) return Failure(is_input(out, path));
  }
  for (const std::string& path : paths) {  // needed if the folder cannot be listed
    if (version_of(out) && is_namesake(out, path)) return Failure(is_input(out, out));
  }
  return {};
}

/// Reads the new file again before it gets its name.
Result<void> prove(RecordingCopier& copier, const OutputFile& file, const std::string& out,
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
  KA_TRY(check_names(files, paths, out));
  OutputFile file = KA_TRY(OutputFile::create(files, out, overwrite));
  const RecordingParts parts = KA_TRY(parts_of(files, paths, progress));
  RecordingCopier copier(file, parts);
  KA_TRY(copy(files, parts, copier, progress));
  Recovered& recovered = copier.recovered;
  KA_TRY(prove(copier, file, out, progress));
  recovered.missing = missing(copier, parts.size());
  append(recovered.findings, judge_order(out, recovered.proof));
  append(recovered.findings, judge_end(parts[furthest(parts)].path, recovered.proof));
  append(recovered.findings, judge_parts(parts, PartsBehind::read));
  append(recovered.findings, judge_namesakes(files, parts.front().path));
  KA_TRY(file.commit());
  return std::move(recovered);
}

}  // namespace kinalign
