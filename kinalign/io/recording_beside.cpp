// SPDX-License-Identifier: Apache-2.0
#include "kinalign/io/recording_beside.h"

#include "kinalign/core/file_version.h"
#include "kinalign/io/mcap_reader.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>
#include <system_error>
#include <variant>

namespace kinalign {

namespace {

constexpr std::string_view suffix = ".mcap";

/// "take" of "take.mcap" and of "take.part2.mcap".
std::string_view stem_of(std::string_view name) {
  if (name.ends_with(suffix)) name.remove_suffix(suffix.size());
  const auto digits = name.find_last_not_of("0123456789");
  constexpr std::string_view part = ".part";
  const bool is_part = digits != std::string_view::npos && digits + 1 < name.size() &&
                       name.substr(0, digits + 1).ends_with(part);
  return is_part ? name.substr(0, digits + 1 - part.size()) : name;
}

/// Where it lies, and where its file does.
std::set<std::string> folders_of(const std::string& path) {
  std::set<std::string> places{std::string(folder(path))};
  std::error_code failed;
  if (std::filesystem::is_symlink(path, failed)) {
    const std::string real = std::filesystem::weakly_canonical(path, failed).string();
    if (!failed) places.insert(std::string(folder(real)));
  }
  return places;
}

/// Files beside this one, itself among them, that are of the same recording by their names.
std::vector<std::string> namesakes_of(const std::string& path,
                                      const std::optional<RecordingFacts>& facts) {
  std::set<std::string_view> stems{stem_of(file_name(path))};
  if (facts) stems.insert(stem_of(facts->first));
  std::vector<std::string> found;
  for (const std::string& place : folders_of(path)) {
    std::error_code failed;  // a folder that can't be listed has nothing beside
    for (std::filesystem::directory_iterator at(place.empty() ? "." : place, failed), end;
         !failed && at != end; at.increment(failed)) {
      const std::string name = at->path().filename().string();
      if (name.ends_with(suffix) && stems.contains(stem_of(name))) found.push_back(place + name);
    }
  }
  return found;
}

void add_new(const std::string& path, std::vector<std::string>& paths) {
  const bool known = std::any_of(paths.begin(), paths.end(),
                                 [&](const auto& one) { return same_file(one, path); });
  if (!known) paths.push_back(path);
}

}  // namespace

bool is_same_recording(const RecordingFacts& a, const RecordingFacts& b) {
  return a.first == b.first && a.host == b.host && a.anchor.raw == b.anchor.raw &&
         a.anchor.utc == b.anchor.utc;
}

Result<std::optional<RecordingFacts>> read_facts(FileSystem& files, const std::string& path) {
  InputFile file = KA_TRY(InputFile::open(files, path));
  McapReader reader;
  for (bool ended = false; !ended;) {
    const std::string_view piece = KA_TRY(file.next());
    ended = piece.empty();
    if (ended) {
      reader.end();
    } else {
      reader.feed(piece);
    }
    while (const auto record = reader.next()) {
      if (std::holds_alternative<McapMessage>(*record)) return std::nullopt;
      const auto* metadata = std::get_if<McapMetadata>(&*record);
      if (metadata == nullptr) continue;
      if (auto facts = to_facts(*metadata)) return facts;
    }
    if (!reader.is_mcap()) return std::nullopt;
  }
  return std::nullopt;
}

std::vector<FileBeside> files_beside(FileSystem& files, const std::string& path,
                                     const RecordingFacts& facts) {
  std::vector<FileBeside> found;
  for (const std::string& one : namesakes_of(path, facts)) {
    const auto read = read_facts(files, one);
    if (read && *read && is_same_recording(**read, facts)) found.push_back({one, (*read)->part});
  }
  return found;
}

std::vector<std::string> with_parts(FileSystem& files, std::vector<std::string> paths) {
  for (std::size_t i = 0, named = paths.size(); i < named; ++i) {
    const auto facts = read_facts(files, paths[i]);
    if (!facts || !*facts) continue;
    for (const FileBeside& one : files_beside(files, paths[i], **facts)) add_new(one.path, paths);
  }
  return paths;
}

std::vector<std::string> with_namesakes(FileSystem& files, std::vector<std::string> paths) {
  for (std::size_t i = 0, named = paths.size(); i < named; ++i) {
    const auto facts = read_facts(files, paths[i]);
    for (const std::string& one : namesakes_of(paths[i], facts ? *facts : std::nullopt)) {
      add_new(one, paths);
    }
  }
  return paths;
}

Findings judge_namesakes(FileSystem& files, const std::string& path) {
  const auto facts = read_facts(files, path);
  if (!facts || !*facts) return {};  // it is no recording of ours itself
  Findings findings;
  for (const std::string& one : namesakes_of(path, *facts)) {
    const auto read = read_facts(files, one);
    if (read && *read && is_same_recording(**read, **facts)) continue;
    std::string found = "one of another run, or with a damaged beginning";
    if (!read) {
      found = "one that can't be read: " + read.error().found;
    } else if (!*read) {
      found = "a file that does not say of which recording it is";
    }
    findings.push_back({Severity::warning,
                        Error{one, 0, "a file of the recording " + shown(file_name(path)), found},
                        "it has such a name, but was left out",
                        "where it is of another recording give it another name"});
  }
  return findings;
}

}  // namespace kinalign
