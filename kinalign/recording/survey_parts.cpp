// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/survey_parts.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace kinalign {

namespace {

/// Replaces counts by later ones of the same sender or port, and adds new ones.
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
  if (channel.messages == 0) channel.first = more.first;
  if (more.messages > 0) {
    channel.first = std::min(channel.first, more.first);
    channel.last = std::max(channel.last, more.last);
  }
  channel.messages += more.messages;
  channel.in_order = channel.in_order && more.in_order;
  channel.bytes += more.bytes;
  channel.sensors |= more.sensors;
}

/// Adds marks. A mark in both files counts once.
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

/// Adds the survey of the next file.
void add(RecordingSurvey&& more, RecordingSurvey& survey) {
  for (const ChannelSurvey& one : more.channels) {
    const auto same = [&](const ChannelSurvey& c) { return c.channel.id == one.channel.id; };
    const auto found = std::find_if(survey.channels.begin(), survey.channels.end(), same);
    if (found == survey.channels.end()) {
      survey.channels.push_back(one);
    } else {
      // the earlier file does not define the channel
      if (found->channel.topic.empty()) found->channel = one.channel;
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
  survey.bytes += more.bytes;
  survey.unchecked += more.unchecked;
  survey.torn.insert(survey.torn.end(), more.torn.begin(), more.torn.end());
  for (const WallClockStep& step : more.steps) {  // a step may be in both files
    if (survey.steps.empty() || step.at > survey.steps.back().at) survey.steps.push_back(step);
  }
  append(survey.findings, more.findings);
  survey.flawed = survey.flawed || more.flawed;
  add_marks(std::move(more), survey);
}

}  // namespace

// Messages are counted by their numbers, because a message may be in several files.
RecordingSurvey join_surveys(const RecordingParts& parts, std::vector<RecordingSurvey> surveys) {
  RecordingSurvey survey = std::move(surveys.front());
  if (parts.size() == 1) return survey;
  MessageNumbers numbers;
  for (const RecordingPart& part : parts) numbers.add_all(part.numbers);
  EndTogether end = EndTogether().with(survey.ending, parts.front().facts);
  for (std::size_t k = 1; k < parts.size(); ++k) {
    end = end.with(surveys[k].ending, parts[k].facts);
    add(std::move(surveys[k]), survey);
  }
  survey.messages = 0;
  for (ChannelSurvey& one : survey.channels) {
    survey.messages += one.messages = numbers.present(one.channel.id);
    one.missing = numbers.missing(one.channel.id);
    const McapChannel* proved = proved_channel(parts, one.channel.id);
    if (proved != nullptr) one.channel = *proved;
    const auto raw = to_raw(one.channel);
    if (raw && !raw->place.empty()) survey.places[raw->stream + "/" + raw->node] = raw->place;
  }
  std::stable_sort(survey.channels.begin(), survey.channels.end(),
                   [](const auto& a, const auto& b) { return a.channel.topic < b.channel.topic; });
  survey.ending = end.ending;
  return survey;
}

Result<RecordingSurvey> survey_parts(FileSystem& files, const RecordingParts& parts,
                                     const Progress& progress) {
  std::vector<RecordingSurvey> surveys;
  for (const RecordingPart& part : parts) {
    surveys.push_back(KA_TRY(survey_recording(files, part.path, progress)));
  }
  return join_surveys(parts, std::move(surveys));
}

}  // namespace kinalign
