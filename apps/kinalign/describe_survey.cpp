// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/describe_file.h"
#include "apps/kinalign/json_text.h"
#include "apps/kinalign/summary.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

double seconds_of(const ChannelSurvey& channel) {
  return static_cast<double>(channel.last - channel.first) / 1e9;
}

/// Over the whole channel; 0 of a single message.
double rate_of(const ChannelSurvey& channel) {
  const double s = seconds_of(channel);
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

}  // namespace

Description describe_survey(const std::string& path, const RecordingSurvey& survey,
                            const RecordingParts& parts) {
  std::string text = fmt::format("{}\n", path);
  const auto line = [&text](std::string_view name, const std::string& value) {
    text += fmt::format("  {:<12}{}\n", name, value);
  };
  line("format", survey.facts ? "MCAP, a recording of kinalign's" : "MCAP");
  if (survey.facts && !survey.facts->subject.empty()) line("subject", survey.facts->subject);
  if (survey.facts && !survey.facts->action.empty()) line("action", survey.facts->action);
  if (survey.facts && survey.facts->part > 1) {
    line("part", fmt::format("{} of {}", survey.facts->part, survey.facts->first));
  }
  for (std::size_t k = 1; k < parts.size(); ++k) line("goes on in", parts[k].path);
  line("state", survey.closed ? "whole" : "torn: no index at its end");
  line("messages", grouped(survey.messages));
  line("size", fmt::format("{:.1f} MB", static_cast<double>(survey.bytes) / 1e6));
  for (const ChannelSurvey& channel : survey.channels) {
    line("channel",
         fmt::format("{}: {} messages, {:.1f} s, {:.1f} Hz, {:.1f} MB", channel.channel.topic,
                     grouped(channel.messages), seconds_of(channel), rate_of(channel),
                     static_cast<double>(channel.bytes) / 1e6));
  }
  Json json{{"file", path},
            {"closed", survey.closed},
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
  for (const ChannelSurvey& channel : survey.channels) json["channels"].push_back(json_of(channel));
  return {text, json_text(json)};
}

Findings judge_survey(const std::string& path, const RecordingSurvey& survey) {
  Findings findings = survey.findings;
  if (!survey.closed) {
    findings.push_back({Severity::warning,
                        {path, 0, "an index at the recording's end", "none"},
                        "it was not closed: the program or the machine stopped, or the disk did",
                        "kinalign recover " + path + " -o whole.mcap gives it one"});
  }
  if (!survey.steps.empty()) {
    const WallClockStep& worst = *std::max_element(
        survey.steps.begin(), survey.steps.end(), [](const auto& a, const auto& b) {
          return std::chrono::abs(a.by) < std::chrono::abs(b.by);
        });
    findings.push_back({Severity::warning,
                        {path, 0, "a wall clock that nobody sets while it records",
                         fmt::format("set {} times, by {:+.3f} s at the most", survey.steps.size(),
                                     seconds(worst.by))},
                        "UTC in it is the clock's of the beginning; time differences are right",
                        "let the machine's clock be set before recording: docs/time_server.md"});
  }
  for (const ChannelSurvey& channel : survey.channels) {
    if (!survey.facts || channel.missing == 0) continue;
    findings.push_back({Severity::error,
                        {path, 0, channel.channel.topic + " without a number left out",
                         grouped(channel.missing) + " missing"},
                        "these messages reached the recorder and are not in the file",
                        "a further part of the recording may have them: recover takes all parts"});
  }
  return findings;
}

}  // namespace kinalign
