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

/// In the order in which they were added, each file once.
class Paths {
 public:
  void add(const std::string& path) {
    if (known_.insert(real(path)).second) all_.push_back(path);
  }
  bool has(const std::string& path) const { return known_.contains(real(path)); }
  std::vector<std::string> take() { return std::move(all_); }

 private:
  static std::string real(const std::string& path) {
    std::error_code failed;
    const auto canonical = std::filesystem::weakly_canonical(path, failed);
    return failed ? path : canonical.string();
  }
  std::vector<std::string> all_;
  std::set<std::string> known_;
};

/// Files beside this one, itself among them, that are of the same recording by their names.
std::vector<std::string> namesakes_of(const std::string& file,
                                      const std::optional<RecordingFacts>& facts) {
  std::set<std::string_view> stems{stem_of(file_name(file))};
  if (facts) stems.insert(stem_of(facts->first));
  std::vector<std::string> found;
  for (const std::string& place : folders_of(file)) {
    std::error_code failed;  // a folder that can't be listed has nothing beside
    for (std::filesystem::directory_iterator at(place.empty() ? "." : place, failed), end;
         !failed && at != end; at.increment(failed)) {
      const std::string name = at->path().filename().string();
      if (name.ends_with(suffix) && stems.contains(stem_of(name))) found.push_back(place + name);
    }
  }
  std::sort(found.begin(), found.end());  // folders have no order
  Paths once;
  for (const std::string& path : found) once.add(path);
  return once.take();
}

/// And what `beside` finds by each, once a recording.
template <class Beside>
std::vector<std::string> with_others(const std::vector<std::string>& named, Beside beside) {
  Paths all, looked_at;
  for (const std::string& path : named) all.add(path);
  for (const std::string& path : named) {
    if (looked_at.has(path)) continue;
    for (const std::string& one : beside(path)) {
      looked_at.add(one);
      all.add(one);
    }
  }
  return all.take();
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

std::vector<std::string> with_parts(FileSystem& files, const std::vector<std::string>& named) {
  return with_others(named, [&files](const std::string& path) {
    std::vector<std::string> found;
    const auto facts = read_facts(files, path);
    if (!facts || !*facts) return found;
    for (FileBeside& one : files_beside(files, path, **facts)) found.push_back(std::move(one.path));
    return found;
  });
}

std::vector<std::string> with_namesakes(FileSystem& files, const std::vector<std::string>& named) {
  return with_others(named, [&files](const std::string& path) {
    const auto facts = read_facts(files, path);
    return namesakes_of(path, facts ? *facts : std::nullopt);
  });
}

Findings judge_namesakes(FileSystem& files, const std::string& path) {
  const auto own = read_facts(files, path);
  const bool is_ours = own && *own;
  Findings findings;
  for (const std::string& one : namesakes_of(path, std::nullopt)) {
    const auto read = read_facts(files, one);
    const bool says_one = read && *read;
    if (is_ours ? says_one && is_same_recording(**read, **own) : !says_one) continue;
    std::string found = "one of another run, or with a damaged beginning";
    if (!is_ours) {
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
