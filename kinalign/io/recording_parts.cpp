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

/// In their order.
RecordingParts without_repeated(RecordingParts parts) {
  RecordingParts kept;
  MessageNumbers before;
  Ending ending = Ending::none;
  bool all_proved = true;
  for (RecordingPart& part : parts) {
    const bool is_news = part.ending > ending || !all_proved || !before.has_all(part.numbers);
    if (!kept.empty() && !is_news) continue;
    for (const std::uint16_t channel : part.numbers.channels()) {
      const bool takes_over =
          part.numbers.goes_on_with(before, channel) && !part.unproved.shares_with(before, channel);
      if (!takes_over) part.repeats.insert(channel);
    }
    before.add_all(part.numbers);
    ending = std::max(ending, part.ending);
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

bool stands_elsewhere(const RecordingParts& parts, std::size_t part, const McapMessage& message) {
  for (std::size_t other = 0; other < parts.size(); ++other) {
    if (other == part) continue;
    const RecordingPart& later = parts[std::max(part, other)];
    const bool is_from_later = !later.repeats.contains(message.channel);
    if (is_from_later == (other > part) && parts[other].numbers.has(message)) return true;
  }
  return false;
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
    const auto take = [&part, &reader](const McapRecord& record) -> Result<void> {
      if (const auto* message = std::get_if<McapMessage>(&record)) {
        part.numbers.add(*message);
        if (reader.unchecked()) part.unproved.add(*message);
      } else if (const auto* metadata = std::get_if<McapMetadata>(&record)) {
        part.ending = std::max(part.ending, ending_of(*metadata));
      }
      return {};
    };
    KA_TRY(read_recording(files, path, reader, take, progress));
    if (!reader.closed()) part.ending = std::max(part.ending, Ending::torn);
    if (reader.all_checked()) part.unproved = {};
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
