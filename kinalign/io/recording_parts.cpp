// SPDX-License-Identifier: Apache-2.0
#include "kinalign/io/recording_parts.h"

#include "kinalign/core/file_version.h"
#include "kinalign/io/recording_beside.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace kinalign {

namespace {

void sort(RecordingParts& parts) {
  std::stable_sort(parts.begin(), parts.end(), [](const RecordingPart& a, const RecordingPart& b) {
    return a.facts.part < b.facts.part;
  });
}

/// The later file's, but for an end, which nothing comes behind.
Ending behind(Ending before, Ending later) { return before == Ending::ended ? before : later; }

/// In their order.
RecordingParts without_repeated(RecordingParts parts) {
  RecordingParts kept;
  MessageNumbers before;
  std::set<std::string> names;
  Ending ending = Ending::none;
  bool all_proved = true;
  for (RecordingPart& part : parts) {
    const bool is_repeated =
        part.is_sound && part.ending <= ending && all_proved && before.has_all(part.numbers) &&
        std::includes(names.begin(), names.end(), part.names.begin(), part.names.end());
    if (!kept.empty() && is_repeated) continue;
    for (const std::uint16_t channel : part.numbers.channels()) {
      const bool takes_over =
          part.numbers.goes_on_with(before, channel) && !part.unproved.shares_with(before, channel);
      if (!takes_over) part.repeats.insert(channel);
    }
    before.add_all(part.numbers);
    names.insert(part.names.begin(), part.names.end());
    ending = behind(ending, part.ending);
    all_proved = all_proved && part.unproved.empty();
    kept.push_back(std::move(part));
  }
  return kept;
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
  if (more.end) survey.end = more.end;
  survey.ending = behind(survey.ending, more.ending);
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

std::string name_of(const McapMetadata& metadata) { return "metadata " + metadata.name; }
std::string name_of(const McapAttachment& attachment) { return "attachment " + attachment.name; }

bool has_better(const RecordingParts& parts, std::size_t part, const McapMessage& message) {
  const bool is_known = parts[part].numbers.has(message);  // its own file defines its channel
  const bool is_proved = is_known && !parts[part].unproved.has(message);
  for (std::size_t other = 0; other < parts.size(); ++other) {
    if (other == part || !parts[other].numbers.has(message)) continue;
    const bool other_is_proved = !parts[other].unproved.has(message);
    const bool is_alike = is_known && other_is_proved == is_proved;
    if (is_alike ? other > part : other_is_proved || !is_known) return true;
  }
  return false;
}

bool stands_elsewhere(const RecordingParts& parts, std::size_t part, const McapMessage& message) {
  for (std::size_t other = 0; other < parts.size(); ++other) {
    if (other == part) continue;
    const RecordingPart& later = parts[std::max(part, other)];
    const bool is_known = parts[part].numbers.has(message);  // its own file defines its channel
    if (!is_known && parts[other].numbers.has(message)) return true;
    const bool is_from_later = !later.repeats.contains(message.channel);
    if (is_from_later == (other > part) && parts[other].numbers.has(message)) return true;
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

/// Which messages it has, and how it ends.
Result<void> read_through(FileSystem& files, RecordingPart& part, const Progress& progress) {
  McapReader reader;
  std::set<std::uint16_t> defined;  // of other channels nobody knows what their messages are
  const auto take = [&](const McapRecord& record) -> Result<void> {
    if (const auto* message = std::get_if<McapMessage>(&record)) {
      if (!defined.contains(message->channel)) {
        part.is_sound = false;
        return {};
      }
      part.numbers.add(*message);
      if (reader.unchecked()) part.unproved.add(*message);
    } else if (const auto* channel = std::get_if<McapChannel>(&record)) {
      defined.insert(channel->id);
    } else if (const auto* metadata = std::get_if<McapMetadata>(&record)) {
      part.ending = std::max(part.ending, ending_of(*metadata));
      part.names.insert(name_of(*metadata));
    } else if (const auto* attachment = std::get_if<McapAttachment>(&record)) {
      part.names.insert(name_of(*attachment));
    }
    return {};
  };
  KA_TRY(read_recording(files, part.path, reader, take, progress));
  if (!reader.closed()) part.ending = std::max(part.ending, Ending::torn);
  if (reader.all_checked()) part.unproved = {};
  part.is_sound = part.is_sound && reader.findings().empty() && reader.skipped() == 0;
  return {};
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
    parts.push_back({path, *facts});
    KA_TRY(read_through(files, parts.back(), progress));
  }
  sort(parts);
  return without_repeated(std::move(parts));
}

Result<RecordingParts> parts_from(FileSystem& files, const std::string& path,
                                  const Progress& progress) {
  const auto facts = KA_TRY(read_facts(files, path));
  if (!facts) return RecordingParts{{path, {}}};  // what it is instead shows when it is read
  std::vector<std::string> paths{path};
  for (const FileBeside& one : files_beside(files, path, *facts)) {
    if (one.part > facts->part) paths.push_back(one.path);
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
