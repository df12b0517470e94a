// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/parts.h"

#include "kinalign/core/file_version.h"
#include "kinalign/recording/beside.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <tuple>

namespace kinalign {

namespace {

/// Sorts files by their first part. Among files with the same first part, the one with the highest
/// last part comes first, so that files that it repeats can be left out. If every sync fails, two
/// files may have the same part number, but their names differ.
void sort(RecordingParts& parts) {
  const auto place = [](const RecordingPart& one) {
    return std::tuple(one.facts.part, -one.facts.last_part(), part_number(one.path), one.path);
  };
  std::sort(parts.begin(), parts.end(),
            [&](const RecordingPart& a, const RecordingPart& b) { return place(a) < place(b); });
}

/// Returns whether a file follows another. A file joined by recover does not follow the parts that
/// it contains, but later parts follow a joined file.
bool stands_behind(const RecordingPart& other, const RecordingPart& part) {
  const bool is_twin = other.facts.part == part.facts.part && other.facts.joined.empty() &&
                       part.facts.joined.empty() &&
                       part_number(other.path) > part_number(part.path);
  return other.facts.part > part.facts.part || is_twin;
}

/// Leaves out files that only repeat earlier ones. The order is kept.
RecordingParts without_repeated(RecordingParts parts) {
  RecordingParts kept;
  MessageNumbers before;
  std::set<std::string> names;
  EndTogether end;
  bool all_proved = true;
  for (RecordingPart& part : parts) {
    const EndTogether with_it = end.with(part.ending, part.facts);
    // If recover joined the first file from this part too, it has already taken everything readable
    // from this part.
    const bool is_joined = !kept.empty() && kept.front().facts.joined.contains(part.facts.part);
    const bool is_repeated =
        (part.is_sound || is_joined) && with_it.ending == end.ending && all_proved &&
        before.has_all(part.numbers) &&
        std::includes(names.begin(), names.end(), part.names.begin(), part.names.end());
    if (!kept.empty() && is_repeated) continue;
    for (const std::uint16_t channel : part.numbers.channels()) {
      const bool takes_over =
          part.numbers.goes_on_with(before, channel) && !part.unproved.shares_with(before, channel);
      if (!takes_over) part.repeats.insert(channel);
    }
    before.add_all(part.numbers);
    names.insert(part.names.begin(), part.names.end());
    end = with_it;
    all_proved = all_proved && part.unproved.empty();
    kept.push_back(std::move(part));
  }
  return kept;
}

}  // namespace

const McapChannel* proved_channel(const RecordingParts& parts, std::uint16_t id) {
  for (const RecordingPart& part : parts) {
    const auto found = part.definitions.channels.find(id);
    if (found != part.definitions.channels.end()) return &found->second;
  }
  return nullptr;
}

std::size_t source_of(const RecordingParts& parts, const std::string& name) {
  std::size_t source = parts.size();
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (!parts[k].names.contains(name)) continue;
    const bool is_end = name == name_of(McapMetadata{std::string(end_metadata), {}});
    const bool is_surer = source < k && parts[k].all_checked && !parts[source].all_checked;
    if (source == parts.size() || is_end || is_surer) source = k;
  }
  return source;
}

std::size_t furthest(const RecordingParts& parts) {
  std::size_t found = 0;
  for (std::size_t k = 1; k < parts.size(); ++k) {
    if (parts[k].facts.last_part() >= parts[found].facts.last_part()) found = k;
  }
  return found;
}

bool has_better(const RecordingParts& parts, std::size_t part, const McapMessage& message) {
  const bool is_proved = !parts[part].unproved.has(message);
  for (std::size_t other = 0; other < parts.size(); ++other) {
    if (other == part || !parts[other].numbers.has(message)) continue;
    const bool other_is_proved = !parts[other].unproved.has(message);
    if (other_is_proved == is_proved ? other > part : other_is_proved) return true;
  }
  return false;
}

/// A file may lack the definition of a channel. A program that reads one file after the other could
/// meet such a message before its definition, so a copy in a file with the definition is preferred.
bool stands_elsewhere(const RecordingParts& parts, std::size_t part, const McapMessage& message) {
  const bool is_named = !parts[part].nameless.has(message);
  for (std::size_t other = 0; other < parts.size(); ++other) {
    if (other == part || !parts[other].numbers.has(message)) continue;
    const bool other_is_named = !parts[other].nameless.has(message);
    const RecordingPart& later = parts[std::max(part, other)];
    const bool is_from_later = !later.repeats.contains(message.channel);
    if (is_named == other_is_named ? is_from_later == (other > part) : other_is_named) return true;
  }
  return false;
}

namespace {

Error is_no_part(const std::string& path, const RecordingParts& parts,
                 const std::optional<RecordingFacts>& facts) {
  return {path, 0,
          parts.empty() ? "a part of a recording of kinalign's"
                        : fmt::format("a part of {}, as {} is", parts.front().facts.first,
                                      parts.front().path),
          !facts ? "a file that does not say of which recording it is"
                 : fmt::format("part {} of another run, {}", facts->part, facts->first)};
}

bool defines(const RecordingPart& part, std::uint16_t channel) {
  return part.definitions.channels.contains(channel) ||
         part.unproved_definitions.channels.contains(channel);
}

/// Gives messages their channel if another file defines it, because a channel has the same meaning
/// in all files.
void name(RecordingParts& parts) {
  for (RecordingPart& part : parts) {
    for (const std::uint16_t channel : part.nameless.channels()) {
      const bool is_defined =
          std::any_of(parts.begin(), parts.end(),
                      [channel](const RecordingPart& other) { return defines(other, channel); });
      if (is_defined) part.numbers.add_all(part.nameless, channel);
    }
  }
}

}  // namespace

Result<RecordingParts> read_parts(FileSystem& files, const std::vector<std::string>& paths,
                                  const Progress& progress) {
  RecordingParts parts;
  for (const std::string& path : paths) {
    const auto facts = KA_TRY(read_facts(files, path));
    if (!facts || !(parts.empty() || is_same_recording(parts.front().facts, *facts))) {
      return Failure(is_no_part(path, parts, facts));
    }
    parts.push_back(KA_TRY(read_part(files, path, *facts, progress)));
  }
  name(parts);
  sort(parts);
  return without_repeated(std::move(parts));
}

Result<RecordingParts> parts_from(FileSystem& files, const std::string& path,
                                  const Progress& progress) {
  const auto facts = KA_TRY(read_facts(files, path));
  if (!facts) return RecordingParts{{path, {}}};  // reading it later shows what the file is instead
  std::vector<std::string> paths{path};
  for (const std::string& one : with_parts(files, {path})) {
    const auto other = KA_TRY(read_facts(files, one));
    if (other && stands_behind({one, *other}, {path, *facts})) paths.push_back(one);
  }
  if (paths.size() == 1) return RecordingParts{{path, *facts}};
  return read_parts(files, paths, progress);
}

Findings judge_parts(const RecordingParts& parts, PartsBehind behind) {
  Findings findings;
  const RecordingPart& one = parts.front();
  const char* join = "kinalign recover makes one file of all parts";
  if (one.facts.part > 1) {
    findings.push_back({Severity::warning,
                        Error{one.path, 0, "the recording's first file, " + shown(one.facts.first),
                              fmt::format("part {}", one.facts.part)},
                        "what stands in the files before is not in this one", join});
  }
  if (parts.size() == 1) return findings;
  std::vector<std::string> names;
  for (const RecordingPart& part : parts) names.emplace_back(file_name(part.path));
  names.erase(names.begin());
  const bool read = behind == PartsBehind::read;
  findings.push_back(
      {read ? Severity::note : Severity::warning,
       Error{one.path, 0, "a recording in one file", fmt::format("{}", fmt::join(names, ", "))},
       read ? "what it went on in was read behind it" : "it went on there when the disk had failed",
       read ? "" : join});
  return findings;
}

}  // namespace kinalign
