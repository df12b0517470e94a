// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/parts.h"

#include "kinalign/core/file_version.h"
#include "kinalign/mcap/reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>
#include <system_error>
#include <tuple>

namespace kinalign {

namespace {

constexpr std::string_view suffix = ".mcap";

/// The common name of a recording's files: "take" for "take.mcap" and "take.part2.mcap". Digits
/// alone do not mean a part, so "walk2.mcap" gives "walk2".
std::string_view stem_of(std::string_view name) {
  if (name.ends_with(suffix)) name.remove_suffix(suffix.size());
  constexpr std::string_view part = ".part";
  const std::string_view cut = name.substr(0, name.find_last_not_of("0123456789") + 1);
  return cut.size() < name.size() && cut.ends_with(part) ? cut.substr(0, cut.size() - part.size())
                                                         : name;
}

/// Reads the facts at the beginning of a file. The result is empty if the file is not a recording
/// of kinalign.
Result<std::optional<RecordingFacts>> read_facts(FileSystem& files, const std::string& path) {
  constexpr std::size_t page = 4096;  // bytes; the first page contains the facts
  InputFile file = KA_TRY(InputFile::open(files, path, page));
  McapReader reader;
  while (const auto record = KA_TRY(pull(reader, [&file] { return file.next(); }))) {
    // The facts stand before the messages, so the messages of a long file are not read.
    if (std::holds_alternative<McapMessage>(*record)) break;
    const auto* metadata = std::get_if<McapMetadata>(&*record);
    if (metadata == nullptr) continue;
    if (auto facts = to_facts(*metadata)) return facts;
  }
  return std::nullopt;
}

/// True if two files are from the same run of the recorder. Any two runs differ in both clocks at
/// the start, even on the same host and with the same name.
bool is_same_recording(const std::optional<RecordingFacts>& a,
                       const std::optional<RecordingFacts>& b) {
  return a && b && a->first == b->first && a->host == b->host && a->anchor.raw == b->anchor.raw &&
         a->anchor.utc == b->anchor.utc;
}

/// The folder of a file and, for a link, also the folder of its target. Each folder is "" or ends
/// in '/'.
std::set<std::string> folders_of(const std::string& path) {
  std::set<std::string> folders{std::string(folder(path))};
  std::error_code failed;
  if (std::filesystem::is_symlink(path, failed)) {
    folders.emplace(folder(std::filesystem::weakly_canonical(path, failed).string()));
  }
  return folders;
}

/// True if one of the paths names the same file, even with another spelling or through a link.
bool contains(const std::vector<std::string>& paths, const std::string& path) {
  return std::any_of(paths.begin(), paths.end(),
                     [&](const std::string& one) { return one == path || same_file(one, path); });
}

/// The sibling files: other files in a file's folders with a name of the same recording, sorted.
/// Siblings of a renamed file are found by the first name in its facts.
std::vector<std::string> siblings_of(const RecordingPart& part) {
  std::set<std::string_view> stems{stem_of(file_name(part.path))};
  if (part.facts) stems.insert(stem_of(part.facts->first));
  std::vector<std::string> found;
  for (const std::string& place : folders_of(part.path)) {
    std::error_code failed;  // a folder that can't be listed counts as empty
    std::filesystem::directory_iterator at(place.empty() ? "." : place, failed);
    for (; !failed && at != std::filesystem::directory_iterator(); at.increment(failed)) {
      const std::string name = at->path().filename().string();
      if (!name.ends_with(suffix) || !stems.contains(stem_of(name))) continue;
      if (!same_file(place + name, part.path)) found.push_back(place + name);
    }
  }
  std::sort(found.begin(), found.end());  // the order of a folder's list is not fixed
  return found;
}

/// True if `part` contains everything in `other`: recover has joined `other` into it, or `other` is
/// a copy with another name. If every sync fails, two parts may have the same number, but not the
/// same name.
bool has_all_of(const RecordingPart& part, const RecordingPart& other) {
  const bool is_copy = part.facts->part == other.facts->part &&
                       stem_of(file_name(part.path)) != stem_of(file_name(other.path));
  return is_copy || part.facts->joined.contains(other.facts->part);
}

/// A key that sorts parts. For equal part numbers, "a.part10.mcap" follows "a.part9.mcap".
auto place_of(const RecordingPart& part) {
  return std::tuple(part.facts ? part.facts->last_part() : 1, part.path.size(), part.path);
}

Error is_no_part(const RecordingPart& part, const RecordingParts& parts) {
  return {part.path, 0,
          fmt::format("a part of {}, as {} is",
                      parts.front().facts ? parts.front().facts->first : "a recording",
                      parts.front().path),
          part.facts
              ? fmt::format("part {} of another run, {}", part.facts->part, part.facts->first)
              : "a file that does not say of which recording it is"};
}

}  // namespace

Result<RecordingParts> find_parts(FileSystem& files, const std::vector<std::string>& named) {
  RecordingParts parts;
  std::vector<std::string> known;
  for (const std::string& path : named) {
    if (contains(known, path)) continue;
    known.push_back(path);
    RecordingPart part{path, KA_TRY(read_facts(files, path))};
    if (!parts.empty() && !is_same_recording(parts.front().facts, part.facts)) {
      // Files that the user names together must belong to one recording. Siblings of other
      // recordings are ignored.
      return Failure(is_no_part(part, parts));
    }
    parts.push_back(std::move(part));
  }
  // Only the named files are searched for siblings; the siblings found are not.
  const RecordingParts given = parts;
  for (const RecordingPart& one : given) {
    for (const std::string& path : siblings_of(one)) {
      auto facts = read_facts(files, path);
      // judge_parts() reports a sibling that can't be read. A failing disk is an error, because
      // data would be missing without notice.
      if (!facts && facts.error().kind == ErrorKind::unreadable_disk) return Failure(facts.error());
      if (!facts || !is_same_recording(*facts, one.facts) || contains(known, path)) continue;
      known.push_back(path);
      RecordingPart part{path, *std::move(facts)};
      const auto has = [&part](const RecordingPart& other) { return has_all_of(other, part); };
      if (std::none_of(given.begin(), given.end(), has)) parts.push_back(std::move(part));
    }
  }
  std::sort(parts.begin(), parts.end(), [](const RecordingPart& a, const RecordingPart& b) {
    return place_of(a) < place_of(b);
  });
  return parts;
}

/// The content of the files does not matter: recover must not overwrite a damaged part either.
std::vector<std::string> with_siblings(FileSystem& files, const std::vector<std::string>& named) {
  std::vector<std::string> all = named;
  for (const std::string& path : named) {
    const auto facts = read_facts(files, path);
    for (const std::string& one : siblings_of({path, facts ? *facts : std::nullopt})) {
      if (!contains(all, one)) all.push_back(one);
    }
  }
  return all;
}

namespace {

/// Reports sibling files that have the recording's name, but do not prove that they belong to it. A
/// file of another recording is not reported if it only has the original name of this recording.
Findings judge_siblings(FileSystem& files, const RecordingPart& part) {
  Findings findings;
  for (const std::string& path : siblings_of(part)) {
    const auto facts = read_facts(files, path);
    const bool is_recording = facts && *facts;
    if (is_recording && is_same_recording(*facts, part.facts)) continue;
    if (is_recording && stem_of(file_name(path)) != stem_of(file_name(part.path))) continue;
    findings.push_back(
        {Severity::warning,
         Error{path, 0, "a part of the recording " + shown(file_name(part.path)),
               !facts ? "a file that can't be read: " + facts.error().found
               : is_recording
                   ? "a part of another recording, or one of the two has a damaged beginning"
                   : "a file that does not say of which recording it is"},
         "the file has the name of a part, but was left out",
         "give it another name if it belongs to another recording"});
  }
  return findings;
}

}  // namespace

Findings judge_parts(FileSystem& files, const RecordingParts& parts, Severity several) {
  const char* join = "kinalign recover makes one file of all parts";
  const RecordingPart& front = parts.front();
  Findings findings;
  // A file of another program has no parts.
  const bool has_first = std::any_of(parts.begin(), parts.end(), [](const RecordingPart& one) {
    return !one.facts || one.facts->part == 1;
  });
  if (!has_first) {
    findings.push_back(
        {Severity::warning,
         Error{front.path, 0, "the recording's first file, " + shown(front.facts->first),
               fmt::format("part {}", front.facts->part)},
         "the data of the parts before it is missing", join});
  }
  if (parts.size() > 1) {
    std::vector<std::string> others;
    for (const RecordingPart& part : parts) others.emplace_back(file_name(part.path));
    others.erase(others.begin());
    findings.push_back({several,
                        Error{front.path, 0, "a recording in one file",
                              fmt::format("{}", fmt::join(others, ", "))},
                        "the recording continued there when the disk failed; all parts were read",
                        several == Severity::note ? "" : join});
  }
  append(findings, judge_siblings(files, front));
  return findings;
}

}  // namespace kinalign
