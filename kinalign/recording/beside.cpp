// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/beside.h"

#include "kinalign/core/file_version.h"
#include "kinalign/mcap/reader.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <set>
#include <string_view>
#include <system_error>
#include <variant>

namespace kinalign {

namespace {

constexpr std::string_view suffix = ".mcap";

// The parts of a file name; `number` is empty without ".partN".
struct PartName {
  std::string_view stem, number{};
};

/// Splits a file name: "take.mcap" into "take" and "", "take.part2.mcap" into "take" and "2".
PartName split(std::string_view name) {
  if (name.ends_with(suffix)) name.remove_suffix(suffix.size());
  const auto digits = name.find_last_not_of("0123456789");
  constexpr std::string_view part = ".part";
  const bool is_part = digits != std::string_view::npos && digits + 1 < name.size() &&
                       name.substr(0, digits + 1).ends_with(part);
  if (!is_part) return {name};
  return {name.substr(0, digits + 1 - part.size()), name.substr(digits + 1)};
}

std::string_view stem_of(std::string_view name) { return split(name).stem; }

/// The folder of a path and, if the path is a link, the folder of its target. Each is "" or ends in
/// '/'.
std::set<std::string> folders_of(const std::string& path) {
  std::set<std::string> places{std::string(folder(path))};
  std::error_code failed;
  if (std::filesystem::is_symlink(path, failed)) {
    const std::string real = std::filesystem::weakly_canonical(path, failed).string();
    if (!failed) places.insert(std::string(folder(real)));
  }
  return places;
}

/// The path with all links resolved.
std::string real(const std::string& path) {
  std::error_code failed;
  const auto canonical = std::filesystem::weakly_canonical(path.empty() ? "." : path, failed);
  return failed ? path : canonical.string();
}

/// A list of paths in the order of insertion, each file once.
class Paths {
 public:
  /// Returns whether the file is new in the list.
  bool add(const std::string& path) {
    const bool is_new = known_.insert(real(path)).second;
    if (is_new) all_.push_back(path);
    return is_new;
  }
  std::vector<std::string> take() { return std::move(all_); }

 private:
  std::vector<std::string> all_;
  std::set<std::string> known_;
};

/// Finds sibling files: files in the same folder whose names say that they belong to the same
/// recording. The file itself is included.
std::vector<std::string> namesakes_of(const std::string& file,
                                      const std::optional<RecordingFacts>& facts) {
  std::set<std::string_view> stems{stem_of(file_name(file))};
  if (facts) stems.insert(stem_of(facts->first));
  std::vector<std::string> found;
  for (const std::string& place : folders_of(file)) {
    std::error_code failed;  // a folder that cannot be listed has no siblings
    for (std::filesystem::directory_iterator at(place.empty() ? "." : place, failed), end;
         !failed && at != end; at.increment(failed)) {
      const std::string name = at->path().filename().string();
      if (name.ends_with(suffix) && stems.contains(stem_of(name))) found.push_back(place + name);
    }
  }
  std::sort(found.begin(), found.end());  // a folder lists files in no fixed order
  Paths once;
  for (const std::string& path : found) once.add(path);
  return once.take();
}

/// Adds the files that `beside` finds for each file. Each recording is searched once per folder.
template <class Beside>
std::vector<std::string> with_others(const std::vector<std::string>& named, Beside beside) {
  Paths all;
  for (const std::string& path : named) all.add(path);
  // folders in which a file's siblings were searched, by file
  std::map<std::string, std::set<std::string>> searched;
  std::vector<std::string> to_search = named;
  for (std::size_t k = 0; k < to_search.size(); ++k) {
    const std::string path = to_search[k];
    const std::set<std::string> places = folders_of(path);
    if (std::includes(searched[real(path)].begin(), searched[real(path)].end(), places.begin(),
                      places.end())) {
      continue;
    }
    for (const std::string& one : beside(path)) {
      searched[real(one)].insert(places.begin(), places.end());
      if (all.add(one)) to_search.push_back(one);
    }
    searched[real(path)].insert(places.begin(), places.end());
  }
  return all.take();
}

}  // namespace

bool is_same_recording(const RecordingFacts& a, const RecordingFacts& b) {
  return a.first == b.first && a.host == b.host && a.anchor.raw == b.anchor.raw &&
         a.anchor.utc == b.anchor.utc;
}

int part_number(const std::string& path) {
  const std::string_view digits = split(file_name(path)).number;
  int number = 0;
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return read.ec == std::errc() ? number : 0;
}

Error unreadable_beginning(const std::string& path) {
  return {path, 0, "a file whose beginning the disk can read",
          "Input/output error (ddrescue copies a bad disk and tries more often)"};
}

Result<std::optional<RecordingFacts>> read_facts(FileSystem& files, const std::string& path) {
  constexpr std::size_t page = 4096;  // bytes; the facts stand within the first page
  InputFile file = KA_TRY(InputFile::open(files, path, page));
  McapReader reader;
  while (const auto record = KA_TRY(pull(reader, [&file] { return file.next_or_zeros(); }))) {
    if (std::holds_alternative<McapMessage>(*record)) break;
    const auto* metadata = std::get_if<McapMetadata>(&*record);
    if (metadata == nullptr) continue;
    if (auto facts = to_facts(*metadata)) return facts;
  }
  if (file.unread() > 0) return Failure(unreadable_beginning(path));
  return std::nullopt;
}

namespace {

/// Finds the files of the same recording in the same folder, including the file itself.
std::vector<std::string> files_beside(FileSystem& files, const std::string& path,
                                      const RecordingFacts& facts) {
  std::vector<std::string> found;
  for (const std::string& one : namesakes_of(path, facts)) {
    const auto read = read_facts(files, one);
    if (read && *read && is_same_recording(**read, facts)) found.push_back(one);
  }
  return found;
}

/// Reports folders that cannot be listed, since they may contain other files of the recording.
Findings judge_folders(const std::string& path) {
  Findings findings;
  for (const std::string& place : folders_of(path)) {
    std::error_code failed;
    std::filesystem::directory_iterator at(place.empty() ? "." : place, failed);
    if (!failed) continue;
    findings.push_back({Severity::warning,
                        Error{path, 0, "a folder that can be listed", failed.message()},
                        "other files of the recording may lie there", ""});
  }
  return findings;
}

}  // namespace

std::vector<std::string> with_parts(FileSystem& files, const std::vector<std::string>& named) {
  return with_others(named, [&files](const std::string& path) {
    const auto facts = read_facts(files, path);
    return facts && *facts ? files_beside(files, path, **facts) : std::vector<std::string>();
  });
}

std::vector<std::string> with_namesakes(FileSystem& files, const std::vector<std::string>& named) {
  return with_others(named, [&files](const std::string& path) {
    const auto facts = read_facts(files, path);
    return namesakes_of(path, facts ? *facts : std::nullopt);
  });
}

bool is_namesake(const std::string& path, const std::string& other) {
  const std::set<std::string> places = folders_of(other);
  return stem_of(file_name(path)) == stem_of(file_name(other)) &&
         std::any_of(places.begin(), places.end(), [&](const std::string& place) {
           return real(place) == real(std::string(folder(path)));
         });
}

Findings judge_namesakes(FileSystem& files, const std::string& path) {
  const auto own = read_facts(files, path);
  const bool is_ours = own && *own;
  Findings findings = judge_folders(path);
  for (const std::string& one : namesakes_of(path, is_ours ? *own : std::nullopt)) {
    const auto read = read_facts(files, one);
    const bool says_one = read && *read;
    // The file has only the recording's first name. It may have been renamed, and a file of another
    // run may have that name now.
    const bool is_by_own_name = stem_of(file_name(one)) == stem_of(file_name(path));
    if (says_one && !is_by_own_name) continue;
    if (same_file(one, path) || (is_ours && says_one && is_same_recording(**read, **own))) continue;
    std::string found = "one of another run, or with a damaged beginning";
    if (!is_ours && says_one) {
      found = "a part of one, while the other does not say of which it is";
    } else if (!read) {
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
