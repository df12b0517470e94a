// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/json_text.h"
#include "apps/kinalign/text/describe_file.h"
#include "apps/kinalign/text/describe_report.h"
#include "apps/kinalign/text/record_text.h"
#include "apps/kinalign/text/summary.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

double seconds_of(const ChannelSurvey& channel) {
  return static_cast<double>(channel.last - channel.first) / 1e9;
}

/// The mean rate of all messages of a channel, Hz. 0 if there is a single message.
double rate_of(const ChannelSurvey& channel) {
  const double s = seconds_of(channel);
  // There are n - 1 intervals between n messages.
  return s > 0.0 ? static_cast<double>(channel.messages - 1) / s : 0.0;
}

Json json_of(const ChannelSurvey& channel) {
  return {{"topic", channel.channel.topic},
          {"encoding", channel.channel.message_encoding},
          {"metadata", channel.channel.metadata},
          {"messages", channel.messages},
          {"bytes", channel.bytes},
          {"first_ns", channel.first},
          {"last_ns", channel.last},
          {"missing", channel.missing}};
}

/// The log time of the recording's first message, ns. The times of marks count from it. A channel
/// without messages is skipped.
std::uint64_t first_of(const RecordingSurvey& survey) {
  std::uint64_t first = UINT64_MAX;
  for (const ChannelSurvey& channel : survey.channels) {
    if (channel.messages > 0) first = std::min(first, channel.first);
  }
  return first;
}

std::string mark_text(const RecordedMark& mark, double at_s) {
  // A mark may state its latency, for example the time from a click to the first frame.
  const std::string latency = mark.mark.latency ? fmt::format(", {:g} ms before its effect",
                                                              1e3 * seconds(*mark.mark.latency))
                                                : "";
  return mark_words(kinalign::name_of(mark.mark.kind), mark.mark.text, at_s, mark.source) + latency;
}

/// The number of findings about damage and missing messages. `check` has more findings.
std::size_t faults_of(const RecordingSurvey& survey) {
  const auto faults =
      std::count_if(survey.findings.begin(), survey.findings.end(),
                    [](const Finding& finding) { return finding.severity >= Severity::warning; });
  const auto gaps = std::count_if(survey.channels.begin(), survey.channels.end(),
                                  [](const ChannelSurvey& one) { return one.missing > 0; });
  return static_cast<std::size_t>(faults + gaps);
}

/// The text about a recording. The times of marks count from its first message.
std::string text_of(const std::string& path, const RecordingSurvey& survey,
                    const RecordingParts& parts) {
  std::string text = path + "\n";
  const auto line = [&text](std::string_view name, const std::string& value) {
    text += fact_line(name, value);
  };
  line("format", survey.facts ? "MCAP, a recording of kinalign's" : "MCAP");
  if (survey.facts && !survey.facts->subject.empty()) line("subject", survey.facts->subject);
  if (survey.facts && !survey.facts->action.empty()) line("action", survey.facts->action);
  if (survey.facts && survey.facts->part > 1) {
    line("part", fmt::format("{} of {}", survey.facts->part, survey.facts->first));
  }
  // parts[0] is the named file. The other parts are the sibling files that continue the recording.
  for (std::size_t k = 1; k < parts.size(); ++k) line("goes on in", parts[k].path);
  // `truncated` lists the files without an index at the end.
  line("state", survey.truncated.empty() ? "whole" : "truncated: no index at its end");
  line("messages", grouped(survey.messages));
  text += size_line(survey.bytes);
  for (const ChannelSurvey& channel : survey.channels) {
    line("channel",
         fmt::format("{}: {} messages, {:.1f} s, {:.1f} Hz, {:.1f} MB", channel.channel.topic,
                     grouped(channel.messages), seconds_of(channel), rate_of(channel),
                     static_cast<double>(channel.bytes) / 1e6));
  }
  for (const CountedSender& one : survey.senders) {
    // The recorder writes its counts once a second, and once more when it ends.
    line("sender", name_of(one, survey) + ": " + counts_text(one.counts) +
                       (survey.facts && !survey.end ? "; counted up to 1 s before the end" : ""));
  }
  for (const CountedPort& one : survey.ports) {
    const std::string lost = loss_of(one.counts, frames_lost(one.stream, survey.senders));
    // A port that lost nothing gets no line.
    if (!lost.empty()) line("port", one.stream + ": " + lost);
  }
  const std::uint64_t first = first_of(survey);
  for (const auto& [mark, log_time] : survey.marks) {
    line("mark", mark_text(mark, static_cast<double>(log_time - first) / 1e9));
  }
  // A recording may have thousands of marks; only the first ones are shown.
  if (survey.more_marks > 0) line("marks", grouped(survey.more_marks) + " more, not shown");
  text += findings_line(faults_of(survey), path);
  return text;
}

/// The JSON about a recording.
Json json_of(const std::string& path, const RecordingSurvey& survey, const RecordingParts& parts) {
  Json json{{"file", path},
            {"closed", survey.truncated.empty()},
            {"messages", survey.messages},
            {"unchecked", survey.unchecked},
            {"bytes", survey.bytes},
            {"attachments", survey.attachments},
            {"channels", Json::array()}};
  if (survey.facts) {
    json["subject"] = survey.facts->subject;
    json["action"] = survey.facts->action;
    json["part"] = survey.facts->part;
  }
  for (std::size_t k = 1; k < parts.size(); ++k) json["goes_on_in"].push_back(parts[k].path);
  // Only a recording with a proper end states how many messages were dropped.
  if (survey.end) json["dropped"] = survey.end->dropped;
  for (const ChannelSurvey& channel : survey.channels) json["channels"].push_back(json_of(channel));
  json["marks"] = json["senders"] = json["ports"] = Json::array();
  for (const auto& [mark, log_time] : survey.marks) {
    json["marks"].push_back(Json::parse(to_json(mark)));
    json["marks"].back()["time_ns"] = log_time;
  }
  // The members are those of the JSON that the recorder writes into the recording.
  for (const CountedSender& one : survey.senders) {
    json["senders"].push_back(Json::parse(to_json(one)));
  }
  for (const CountedPort& one : survey.ports) json["ports"].push_back(Json::parse(to_json(one)));
  return json;
}

}  // namespace

Description describe_survey(const std::string& path, const RecordingSurvey& survey,
                            const RecordingParts& parts) {
  return {text_of(path, survey, parts), json_text(json_of(path, survey, parts))};
}

}  // namespace kinalign
