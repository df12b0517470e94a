// SPDX-License-Identifier: Apache-2.0
#include "kinalign/io/recording_parts.h"

#include "kinalign/core/file_version.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>
#include <system_error>

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

void sort(RecordingParts& parts) {
  std::stable_sort(parts.begin(), parts.end(), [](const RecordingPart& a, const RecordingPart& b) {
    return a.facts.part < b.facts.part;
  });
}

struct Beside {
  std::string path;
  int part = 0;
};

/// The recording's files in the same folder, itself among them.
std::vector<Beside> files_beside(FileSystem& files, const std::string& path,
                                 const RecordingFacts& facts) {
  const std::string place(folder(path));
  const std::set<std::string_view> stems{stem_of(file_name(path)), stem_of(facts.first)};
  std::vector<Beside> found;
  std::error_code failed;  // a folder that can't be listed has nothing beside
  for (std::filesystem::directory_iterator at(place.empty() ? "." : place, failed), end;
       !failed && at != end; at.increment(failed)) {
    const std::string name = at->path().filename().string();
    if (!name.ends_with(suffix) || !stems.contains(stem_of(name))) continue;
    const auto read = read_facts(files, place + name);
    if (!read || !*read || !is_same_recording(**read, facts)) continue;
    found.push_back({place + name, (*read)->part});
  }
  return found;
}

/// What the same one says later, or what is new.
template <class Counted, class Same>
void replace(std::vector<Counted>&& later, const Same& same, std::vector<Counted>& all) {
  for (Counted& one : later) {
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const Counted& known) { return same(known, one); });
    if (found == all.end()) {
      all.push_back(std::move(one));
    } else {
      *found = std::move(one);
    }
  }
}

void add(const ChannelSurvey& more, ChannelSurvey& channel) {
  channel.first = std::min(channel.first, more.first);
  channel.last = std::max(channel.last, more.last);
  channel.bytes += more.bytes;
  channel.sensors |= more.sensors;
}

/// Marks that stand in both files are one.
void add_marks(RecordingSurvey&& more, RecordingSurvey& survey) {
  for (auto& [mark, log_time] : more.marks) {
    const auto same = [time = log_time, &one = mark](const auto& known) {
      return known.second == time && known.first == one;
    };
    if (std::any_of(survey.marks.begin(), survey.marks.end(), same)) continue;
    survey.marks.emplace_back(std::move(mark), log_time);
  }
  survey.more_marks = std::max(survey.more_marks, more.more_marks);
}

/// What a file that goes on behind adds.
void add(RecordingSurvey&& more, RecordingSurvey& survey) {
  for (const ChannelSurvey& one : more.channels) {
    const auto same = [&](const ChannelSurvey& c) { return c.channel == one.channel; };
    const auto found = std::find_if(survey.channels.begin(), survey.channels.end(), same);
    if (found == survey.channels.end()) {
      survey.channels.push_back(one);
    } else {
      add(one, *found);
    }
  }
  replace(
      std::move(more.senders),
      [](const CountedSender& a, const CountedSender& b) {
        return a.topic == b.topic && a.stream == b.stream && a.sender == b.sender &&
               a.node == b.node;
      },
      survey.senders);
  replace(
      std::move(more.ports),
      [](const CountedPort& a, const CountedPort& b) { return a.stream == b.stream; },
      survey.ports);
  survey.end = more.end;
  survey.was_torn = more.was_torn;
  survey.bytes += more.bytes;
  survey.unchecked += more.unchecked;
  survey.torn.insert(survey.torn.end(), more.torn.begin(), more.torn.end());
  for (const WallClockStep& step : more.steps) {  // one may stand in both
    if (survey.steps.empty() || step.at > survey.steps.back().at) survey.steps.push_back(step);
  }
  append(survey.findings, more.findings);
  add_marks(std::move(more), survey);
}

}  // namespace

/// Numbers that touch are one stretch.
void MessageNumbers::add(Stretches& stretches, std::uint32_t begin, std::uint64_t end) {
  auto at = stretches.upper_bound(begin);
  if (at != stretches.begin() && std::prev(at)->second >= begin) {
    --at;
  } else {
    at = stretches.emplace_hint(at, begin, end);
  }
  at->second = std::max(at->second, end);
  for (auto next = std::next(at); next != stretches.end() && next->first <= at->second;) {
    at->second = std::max(at->second, next->second);
    next = stretches.erase(next);
  }
}

void MessageNumbers::add(const McapMessage& message) {
  add(channels_[message.channel], message.sequence, std::uint64_t{message.sequence} + 1);
}

void MessageNumbers::add_all(const MessageNumbers& others) {
  for (const auto& [id, stretches] : others.channels_) {
    for (const auto& [begin, end] : stretches) add(channels_[id], begin, end);
  }
}

std::uint64_t MessageNumbers::present(std::uint16_t channel) const {
  std::uint64_t present = 0;
  const auto found = channels_.find(channel);
  if (found == channels_.end()) return present;
  for (const auto& [begin, end] : found->second) present += end - begin;
  return present;
}

std::uint64_t MessageNumbers::missing(std::uint16_t channel) const {
  const auto found = channels_.find(channel);
  if (found == channels_.end() || found->second.empty()) return 0;
  std::uint64_t missing = 0, behind = found->second.begin()->first;
  for (const auto& [begin, end] : found->second) {
    missing += begin - behind;
    behind = end;
  }
  return missing;
}

bool MessageNumbers::has(const McapMessage& message) const {
  const auto channel = channels_.find(message.channel);
  if (channel == channels_.end()) return false;
  const auto next = channel->second.upper_bound(message.sequence);
  return next != channel->second.begin() && message.sequence < std::prev(next)->second;
}

bool MessageNumbers::has_all(const MessageNumbers& others) const {
  for (const auto& [id, stretches] : others.channels_) {
    const auto channel = channels_.find(id);
    if (channel == channels_.end()) return false;
    for (const auto& [begin, end] : stretches) {
      const auto next = channel->second.upper_bound(begin);
      if (next == channel->second.begin() || std::prev(next)->second < end) return false;
    }
  }
  return true;
}

bool stands_later(const RecordingParts& parts, std::size_t part, const McapMessage& message) {
  for (std::size_t later = part + 1; later < parts.size(); ++later) {
    if (parts[later].numbers.has(message)) return true;
  }
  return false;
}

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

Result<RecordingParts> read_parts(FileSystem& files, const std::vector<std::string>& paths,
                                  const Progress& progress) {
  RecordingParts parts;
  for (const std::string& path : paths) {
    const auto facts = KA_TRY(read_facts(files, path));
    const bool same = facts && (parts.empty() || is_same_recording(parts.front().facts, *facts));
    if (!same) {
      return Failure(
          Error{path, 0,
                parts.empty() ? "a part of a recording of kinalign's"
                              : fmt::format("a part of {}, as {} is", parts.front().facts.first,
                                            parts.front().path),
                !facts ? "a file that does not say of which recording it is"
                       : fmt::format("part {} of another run, {}", facts->part, facts->first)});
    }
    parts.push_back({path, *facts});
    RecordingPart& part = parts.back();
    McapReader reader;
    const auto take = [&part](const McapRecord& record) -> Result<void> {
      if (const auto* message = std::get_if<McapMessage>(&record)) part.numbers.add(*message);
      const auto* metadata = std::get_if<McapMetadata>(&record);
      if (metadata != nullptr) part.has_end = part.has_end || is_end(*metadata);
      return {};
    };
    KA_TRY(read_recording(files, path, reader, take, progress));
  }
  sort(parts);
  return parts;
}

std::vector<std::string> with_parts(FileSystem& files, std::vector<std::string> paths) {
  for (std::size_t i = 0, named = paths.size(); i < named; ++i) {
    const auto facts = read_facts(files, paths[i]);
    if (!facts || !*facts) continue;
    for (const Beside& one : files_beside(files, paths[i], **facts)) {
      const bool known = std::any_of(paths.begin(), paths.end(),
                                     [&](const auto& path) { return same_file(path, one.path); });
      if (!known) paths.push_back(one.path);
    }
  }
  return paths;
}

Result<RecordingParts> parts_from(FileSystem& files, const std::string& path,
                                  const Progress& progress) {
  const auto facts = KA_TRY(read_facts(files, path));
  if (!facts) return RecordingParts{{path, {}}};  // what it is instead shows when it is read
  std::vector<std::string> paths{path};
  for (const Beside& one : files_beside(files, path, *facts)) {
    if (one.part > facts->part) paths.push_back(one.path);
  }
  if (paths.size() == 1) return RecordingParts{{path, *facts}};
  RecordingParts parts = KA_TRY(read_parts(files, paths, progress));
  const RecordingPart first = parts.front();
  const auto brings_nothing = [&first](const RecordingPart& part) {
    return first.numbers.has_all(part.numbers) && (first.has_end || !part.has_end);
  };
  parts.erase(std::remove_if(parts.begin() + 1, parts.end(), brings_nothing), parts.end());
  return parts;
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

Result<RecordingSurvey> survey_parts(FileSystem& files, const RecordingParts& parts,
                                     const Progress& progress) {
  RecordingSurvey survey = KA_TRY(survey_recording(files, parts.front().path, progress));
  if (parts.size() == 1) return survey;
  MessageNumbers numbers;
  for (const RecordingPart& part : parts) numbers.add_all(part.numbers);
  for (auto part = parts.begin() + 1; part != parts.end(); ++part) {
    add(KA_TRY(survey_recording(files, part->path, progress)), survey);
  }
  survey.messages = 0;
  for (ChannelSurvey& one : survey.channels) {
    survey.messages += one.messages = numbers.present(one.channel.id);
    one.missing = numbers.missing(one.channel.id);
  }
  return survey;
}

}  // namespace kinalign
