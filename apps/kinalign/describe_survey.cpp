// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/describe_file.h"
#include "apps/kinalign/describe_report.h"
#include "apps/kinalign/json_text.h"
#include "apps/kinalign/node_names.h"
#include "apps/kinalign/record_text.h"
#include "apps/kinalign/summary.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <set>

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

/// Of a node; empty: nobody said it.
std::string place_of(const std::string& stream, const std::string& node,
                     const RecordingSurvey& survey) {
  const auto place = survey.places.find(stream + "/" + node);
  return place == survey.places.end() ? "" : place->second;
}

/// "mocap from 192.168.7.5:51234", "imu waist from 192.168.7.21:4000"
std::string name_of(const CountedSender& sender, const RecordingSurvey& survey) {
  return sender_name(sender.stream, sender.node, place_of(sender.stream, sender.node, survey)) +
         (sender.sender.empty() ? "" : " from " + sender.sender);
}

/// "mocap", "imu waist", "imu 7" of what topics begin with: "mocap", "imu/7".
std::string name_of(const std::string& beginning, const RecordingSurvey& survey) {
  const std::size_t end = beginning.find('/');
  if (end == std::string::npos) return beginning;
  const std::string stream = beginning.substr(0, end), node = beginning.substr(end + 1);
  return sender_name(stream, node, place_of(stream, node, survey));
}

/// The log time of the first message, ns.
std::uint64_t first_of(const RecordingSurvey& survey) {
  std::uint64_t first = UINT64_MAX;
  for (const ChannelSurvey& channel : survey.channels) {
    if (channel.messages > 0) first = std::min(first, channel.first);
  }
  return first;
}

std::string mark_text(const RecordedMark& mark, double at_s) {
  const std::string latency = mark.mark.latency ? fmt::format(", {:g} ms before its effect",
                                                              1e3 * seconds(*mark.mark.latency))
                                                : "";
  return mark_words(kinalign::name_of(mark.mark.kind), mark.mark.text, at_s, mark.source) + latency;
}

/// What the recorder counted and was told.
void add_told(const RecordingSurvey& survey, Json& json) {
  json["marks"] = json["senders"] = json["ports"] = Json::array();
  for (const auto& [mark, log_time] : survey.marks) {
    Json one = Json::parse(to_json(mark));
    one["time_ns"] = log_time;
    json["marks"].push_back(one);
  }
  for (const CountedSender& one : survey.senders) {
    json["senders"].push_back(Json::parse(to_json(one)));
  }
  for (const CountedPort& one : survey.ports) {
    json["ports"].push_back(Json::parse(to_json(one)));
  }
}

/// Those that the lab wanted, and that the file has nothing of.
std::vector<std::string> unheard(const RecordingSurvey& survey) {
  std::vector<std::string> names;
  for (const auto& [name, required] : survey.expected) {
    const std::string begins = "/" + name + "/";  // of nodes any one's
    const bool heard =
        std::any_of(survey.channels.begin(), survey.channels.end(), [&](const ChannelSurvey& one) {
          return one.channel.topic.starts_with(begins) && one.messages > 0;
        });
    if (!heard && required) names.push_back(name_of(name, survey));
  }
  return names;
}

/// Of a topic: of what the recorder counted before it wrote the last counts, what is neither there
/// nor between two that are. Counts of a later part begin with the recording, not with the file.
std::uint64_t uncovered(const CountedSender& counted, const RecordingSurvey& survey) {
  std::uint64_t known = 0;
  for (const ChannelSurvey& channel : survey.channels) {
    if (channel.channel.topic == counted.topic) known += channel.messages + channel.missing;
  }
  const bool whole = survey.facts && survey.facts->part == 1;
  return whole && counted.counts.messages > known ? counted.counts.messages - known : 0;
}

/// What reached the recorder and is not in the file: its numbers are left out, or, at either end of
/// a topic, its own counts say so.
Findings gone(const std::string& path, const RecordingSurvey& survey) {
  Findings findings;
  const auto tell = [&](std::string expected, std::uint64_t lacks) {
    if (lacks == 0) return;
    findings.push_back({Severity::error,
                        {path, 0, std::move(expected), grouped(lacks) + " missing"},
                        "these messages reached the recorder and are not in the file",
                        "a further part of the recording may have them: recover takes all parts"});
  };
  for (const ChannelSurvey& channel : survey.channels) {
    tell(channel.channel.topic + " without a number left out", channel.missing);
  }
  for (const CountedSender& one : survey.senders) {
    tell(fmt::format("the {} messages on {} that were counted", grouped(one.counts.messages),
                     one.topic),
         uncovered(one, survey));
  }
  return findings;
}

/// Of what the devices sent, before it could be recorded.
Findings losses(const std::string& path, const RecordingSurvey& survey) {
  Findings findings;
  for (const std::string& name : unheard(survey)) {
    findings.push_back({Severity::warning,
                        {path, 0, "messages of " + name, "none"},
                        "a device that the lab requires is not in it",
                        "see that it sends to the recording machine; docs/recording.md"});
  }
  for (const CountedSender& one : survey.senders) {
    const SequenceCounts& order = one.counts.order;
    if (order.lost == 0) continue;
    const std::uint64_t came = frames_or_messages(one.counts);
    findings.push_back(
        {Severity::note,
         {path, 0, "every frame that " + name_of(one, survey) + " sent",
          fmt::format("{} lost of {}", grouped(order.lost), grouped(order.lost + came))},
         "by the sender's own numbers; they did not reach the recorder",
         ""});
  }
  for (const CountedPort& one : survey.ports) {
    const std::string lost = loss_of(one.counts);
    if (lost.empty() || one.counts.sifted) continue;
    findings.push_back({Severity::warning,
                        {path, 0, "everything that came to the port of " + one.stream, lost},
                        "these reached the recording machine and are not in it",
                        "see what else it does while it records"});
  }
  return findings;
}

std::string text_of(const std::string& path, const RecordingSurvey& survey,
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
  line("state", survey.torn.empty() ? "whole" : "torn: no index at its end");
  line("messages", grouped(survey.messages));
  line("size", fmt::format("{:.1f} MB", static_cast<double>(survey.bytes) / 1e6));
  for (const ChannelSurvey& channel : survey.channels) {
    line("channel",
         fmt::format("{}: {} messages, {:.1f} s, {:.1f} Hz, {:.1f} MB", channel.channel.topic,
                     grouped(channel.messages), seconds_of(channel), rate_of(channel),
                     static_cast<double>(channel.bytes) / 1e6));
  }
  for (const CountedSender& one : survey.senders) {
    line("sender", name_of(one, survey) + ": " + counts_text(one.counts));
  }
  for (const CountedPort& one : survey.ports) {
    const std::string lost = loss_of(one.counts);
    if (!lost.empty()) line("port", one.stream + ": " + lost);
  }
  const std::uint64_t first = first_of(survey);
  for (const auto& [mark, log_time] : survey.marks) {
    line("mark", mark_text(mark, static_cast<double>(log_time - first) / 1e9));
  }
  if (survey.more_marks > 0) line("marks", grouped(survey.more_marks) + " more, not shown");
  return text;
}

Json json_of(const std::string& path, const RecordingSurvey& survey, const RecordingParts& parts) {
  Json json{{"file", path},
            {"closed", survey.torn.empty()},
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
  if (survey.end) json["dropped"] = survey.end->dropped;
  for (const ChannelSurvey& channel : survey.channels) json["channels"].push_back(json_of(channel));
  add_told(survey, json);
  return json;
}

/// Of what no rows can be made: the recorder saw none of the protocol's frames in it, or nothing
/// says whose body moves.
Findings unreadable(const std::string& path, const RecordingSurvey& survey) {
  Findings findings;
  std::set<std::string> without_skeleton;
  for (const CountedSender& one : survey.senders) {
    const auto channel =
        std::find_if(survey.channels.begin(), survey.channels.end(),
                     [&](const ChannelSurvey& known) { return known.channel.topic == one.topic; });
    if (channel == survey.channels.end()) continue;
    const std::string& protocol = channel->channel.message_encoding;
    const bool counted = protocol == "noitom" || protocol == "xsens" || protocol == "kinect";
    if (counted && speaks_another_protocol(one.counts)) {
      findings.push_back(
          {Severity::warning,
           {path, 0, "frames of " + protocol + " in what " + name_of(one, survey) + " sent",
            grouped(one.counts.messages) + " messages, none of them one"},
           "nothing of it can be aligned as " + protocol,
           "see which port and protocol the device sends to"});
    }
    const auto& names = survey.attachments;
    const bool has_body = std::find(names.begin(), names.end(), one.stream + ".bvh") != names.end();
    if (protocol == "noitom" && one.counts.frames > 0 && !has_body) {
      without_skeleton.insert(one.stream);
    }
  }
  for (const std::string& stream : without_skeleton) {
    findings.push_back({Severity::note,
                        {path, 0, "a skeleton for " + stream, "none"},
                        "Noitom's stream does not say whose body it moves; alignment needs it",
                        "skeleton = \"a.bvh\" in [stream." + stream + "] of a recording.toml"});
  }
  return findings;
}

}  // namespace

Description describe_survey(const std::string& path, const RecordingSurvey& survey,
                            const RecordingParts& parts) {
  return {text_of(path, survey, parts), json_text(json_of(path, survey, parts))};
}

Findings judge_survey(const std::string& path, const RecordingSurvey& survey) {
  Findings findings = survey.findings;
  for (const std::string& torn : survey.torn) {
    findings.push_back({Severity::warning,
                        {torn, 0, "an index at the recording's end", "none"},
                        "it was not closed: the program or the machine stopped, or the disk did",
                        "kinalign recover " + torn + " -o whole.mcap gives it one"});
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
  if (survey.facts) append(findings, gone(path, survey));
  if (survey.more_marks > 0) {
    findings.push_back({Severity::note,
                        {path, 0, fmt::format("at most {} marks", grouped(most_marks)),
                         grouped(survey.more_marks) + " more"},
                        "alignment leaves them out",
                        ""});
  }
  if (survey.end && survey.end->dropped > 0) {
    findings.push_back({Severity::error,
                        {path, 0, "every message that reached the recorder",
                         grouped(survey.end->dropped) + " fewer"},
                        "the disk was too slow for too long, and memory full",
                        "record to a disk of the machine itself"});
  }
  append(findings, losses(path, survey));
  append(findings, unreadable(path, survey));
  return findings;
}

}  // namespace kinalign
