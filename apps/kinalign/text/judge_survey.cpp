// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/describe_file.h"
#include "apps/kinalign/text/describe_report.h"
#include "apps/kinalign/text/node_names.h"
#include "apps/kinalign/text/record_text.h"
#include "apps/kinalign/text/summary.h"

#include "kinalign/protocols/protocols.h"
#include "kinalign/syntax/toml.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>

namespace kinalign {

namespace {

/// The name for people of a sender's topic prefix: "mocap" gives "mocap", "imu/7" gives "imu waist"
/// or "imu 7".
std::string name_of(const std::string& beginning, const RecordingSurvey& survey) {
  const std::size_t end = beginning.find('/');
  if (end == std::string::npos) return beginning;
  const std::string stream = beginning.substr(0, end), node = beginning.substr(end + 1);
  return sender_name(stream, node, survey);
}

/// The topic prefixes of devices that the lab requires and of which the file has no message.
/// `expected` is from the lab in the recording. Names of nodes contain their id: "imu/7".
std::vector<std::string> unheard(const RecordingSurvey& survey) {
  std::vector<std::string> names;
  for (const auto& [name, required] : survey.expected) {
    const std::string begins = "/" + name + "/";  // for nodes: of any node
    const bool heard =
        std::any_of(survey.channels.begin(), survey.channels.end(), [&](const ChannelSurvey& one) {
          // A definition without messages does not count.
          return one.channel.topic.starts_with(begins) && one.messages > 0;
        });
    if (!heard && required) names.push_back(name);
  }
  return names;
}

/// The messages of a topic that the recorder counted and that are neither in the file nor missing
/// between two that are. Only the first part of a recording can be checked: the counts of later
/// parts begin with the recording, not with the file.
/// The recorder counts messages before they are written, so its counts also cover what the disk
/// lost.
std::uint64_t uncovered(const CountedSender& counted, const RecordingSurvey& survey) {
  std::uint64_t known = 0;
  for (const ChannelSurvey& channel : survey.channels) {
    if (channel.channel.topic == counted.topic) known += channel.messages + channel.missing;
  }
  // Without the recorder's facts the file is not one of record.
  const bool whole = survey.facts && survey.facts->part == 1;
  return whole && counted.counts.messages > known ? counted.counts.messages - known : 0;
}

/// Errors for messages that reached the recorder and are not in the file. A gap in the recorder's
/// own numbering shows them; at the ends of a topic the counts do.
/// Both findings can't be about the same messages: uncovered() subtracts those that are missing in
/// between.
Findings gone(const std::string& path, const RecordingSurvey& survey) {
  Findings findings;
  const auto tell = [&](std::string expected, std::uint64_t lacks) {
    if (lacks == 0) return;
    findings.push_back({Severity::error,
                        {path, 0, std::move(expected), grouped(lacks) + " missing"},
                        "these messages reached the recorder and are not in the file",
                        "a part of the recording in another folder may have them"});
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

/// Notes by the devices' own numbers: frames that never reached the recorder, and restarts.
/// These losses happened before the recorder, on the network or in the device. They are notes,
/// since nothing can be repaired.
Findings numbered(const std::string& path, const RecordingSurvey& survey) {
  Findings findings;
  for (const CountedSender& one : survey.senders) {
    const SequenceCounts& order = one.counts.order;
    if (order.lost > 0) {
      // The share is over all numbers that the sender gave.
      const std::uint64_t came = frames_or_messages(one.counts);
      findings.push_back(
          {Severity::note,
           {path, 0, "every frame that " + name_of(one, survey) + " sent",
            fmt::format("{} lost of {}", grouped(order.lost), grouped(order.lost + came))},
           "by the sender's own numbers; they did not reach the recorder, or were never sent",
           ""});
    }
    if (order.restarts > 0) {
      findings.push_back({Severity::note,
                          {path, 0, "one life of " + name_of(one, survey),
                           grouped(order.restarts + 1) + ": it was started anew"},
                          "each has a clock of its own, and nothing is known of between",
                          ""});
    }
  }
  return findings;
}

/// The warning about data that reached a device's port and could not be recorded.
Finding port_loss(const std::string& path, const CountedPort& port, const std::string& lost) {
  // `lost` is the text of loss_of().
  return {Severity::warning,
          {path, 0, "everything that came to the port of " + port.stream, lost},
          "these reached the recording machine and are not in it",
          "see what else it does while it records"};
}

/// The note about datagrams at a port of marks that are not marks. Any program of the network may
/// send such datagrams without harm, but one may have been meant as a mark.
Finding no_marks(const std::string& path, const CountedPort& port) {
  return {Severity::note,
          {path, 0, "marks alone at the port of " + port.stream,
           grouped(port.counts.refused) + " datagrams that are none"},
          "record said why, and answered so",
          "docs/formats/marks.md says how a mark is sent"};
}

/// The note about refused frames of nodes, for example of a node without the lab's key. The
/// kernel's filter drops and counts datagrams that are no frames at all.
Finding no_nodes(const std::string& path, const CountedPort& port) {
  return {Severity::note,
          {path, 0, "frames alone of the lab's nodes at the port of " + port.stream,
           grouped(port.counts.refused) + " that are refused"},
          "a node that is missing may have sent them: without the lab's key, say",
          "record said of which node, and why"};
}

/// The finding about datagrams at a nodes' port that are no frames, for example of another device.
/// Many of them are a warning; `record` uses the same limit.
Finding strays_at(const std::string& path, const CountedPort& port, std::uint64_t strays) {
  return {are_many(strays) ? Severity::warning : Severity::note,
          {path, 0, "frames of nodes alone at the port of " + port.stream,
           fmt::format("{}{} datagrams that are none",
                       strays < port.counts.dropped ? "at least " : "", grouped(strays))},
          "they were thrown away: nothing of them is in it",
          "see which port and protocol each device sends to"};
}

/// True for the recorder's own ports; no device can have such a name.
bool is_of_marks(const CountedPort& port) {
  return port.stream == "marks" || port.stream == "trigger";
}

/// The findings about data that came to a port and is not in the recording.
Findings not_recorded(const std::string& path, const RecordingSurvey& survey) {
  Findings findings;
  for (const CountedPort& one : survey.ports) {
    // `sifted` is true for ports of nodes, where a filter of the kernel drops what is no frame.
    if (one.counts.sifted) {
      if (one.counts.refused > 0) findings.push_back(no_nodes(path, one));
      const std::uint64_t came = strays(one.counts, frames_lost(one.stream, survey.senders));
      if (came > 0) findings.push_back(strays_at(path, one, came));
      continue;
    }
    // The copy allows the count of refused marks to be taken out: it has a note of its own.
    CountedPort of_device = one;
    if (is_of_marks(one)) {
      if (one.counts.refused > 0) findings.push_back(no_marks(path, one));
      of_device.counts.refused = 0;
    }
    const std::string lost = loss_of(of_device.counts, 0);
    if (!lost.empty()) findings.push_back(port_loss(path, one, lost));
  }
  return findings;
}

/// The text about datagrams at the port of a device of which nothing was recorded. Empty if none
/// came.
/// It tells a device at the wrong port from one that is switched off.
std::string came_unheard(const std::string& device, const RecordingSurvey& survey) {
  const bool heard = std::any_of(survey.senders.begin(), survey.senders.end(),
                                 [&](const CountedSender& one) { return one.stream == device; });
  const auto port = std::find_if(survey.ports.begin(), survey.ports.end(),
                                 [&](const CountedPort& one) { return one.stream == device; });
  if (heard || port == survey.ports.end()) return "";
  return unusable_data(port->counts, "to its port");
}

/// Warnings about required devices that are missing in the recording.
Findings lacking(const std::string& path, const RecordingSurvey& survey) {
  Findings findings;
  for (const std::string& name : unheard(survey)) {
    // The part before '/' is the device; ports belong to devices.
    const std::string came = came_unheard(name.substr(0, name.find('/')), survey);
    findings.push_back(
        {Severity::warning,
         {path, 0, "messages of " + name_of(name, survey), came.empty() ? "none" : "none: " + came},
         "a device that the lab requires is not in it",
         came.empty() ? "see that it sends to the recording machine; "
                        "docs/recording.md"
                      : "see that it sends to this port, and other devices to "
                        "theirs; docs/recording.md"});
  }
  return findings;
}

/// The warning about a suit over UDP: pieces of its frames do not state the frame they belong to.
/// UDP splits long frames into datagrams. If some are lost or mixed, the frame can't be put
/// together.
Finding hardly_read(const std::string& path, const std::string& name, const SenderCounts& counts) {
  return {Severity::warning,
          {path, 0, "frames that can be read in what " + name + " sent",
           fmt::format("{}; {} times none", grouped(counts.frames), grouped(counts.refused))},
          "fewer than half of them can be aligned, though their bytes are all in the recording",
          "prefer TCP, which loses and mixes no pieces of frames"};
}

/// Findings about streams that can't become rows: the messages are not of the stated protocol, most
/// frames are refused, or no skeleton is known.
Findings unreadable(const std::string& path, const RecordingSurvey& survey) {
  Findings findings;
  // A set names each stream once, although it may have had several senders.
  std::set<std::string> without_skeleton;
  for (const CountedSender& one : survey.senders) {
    const auto channel =
        std::find_if(survey.channels.begin(), survey.channels.end(),
                     [&](const ChannelSurvey& known) { return known.channel.topic == one.topic; });
    // A sender without a channel has no message in this file.
    if (channel == survey.channels.end()) continue;
    const std::string& protocol = channel->channel.message_encoding;
    if (speaks_another_protocol(protocol, one.counts)) {
      findings.push_back(
          {Severity::warning,
           {path, 0, "frames of " + protocol + " in what " + name_of(one, survey) + " sent",
            grouped(one.counts.messages) + " messages, none of them one"},
           "nothing of it can be aligned as " + protocol,
           "see which port and protocol the device sends to"});
    }
    const auto known = find_recorded_protocol(protocol);
    // Only protocols that are decoded count frames.
    if (!known || one.counts.frames == 0) continue;
    const ProtocolRow& row = row_of(*known);
    if (row.losses == LossNumbers::frame_heads && are_many(one.counts.refused) &&
        one.counts.refused > one.counts.frames) {
      findings.push_back(hardly_read(path, name_of(one, survey), one.counts));
    }
    // The recorder attaches the BVH of a suit under the name of its device.
    const auto& names = survey.attachments;
    const bool has_body = std::find(names.begin(), names.end(), one.stream + ".bvh") != names.end();
    if (row.needs_skeleton && !has_body) without_skeleton.insert(one.stream);
  }
  for (const std::string& stream : without_skeleton) {
    findings.push_back(
        {Severity::note,
         {path, 0, "a skeleton for " + stream, "none"},
         "Noitom's stream does not say whose body it moves; alignment needs it",
         "skeleton = \"a.bvh\" in [stream." + toml_key(stream) + "] of a recording.toml"});
  }
  return findings;
}

/// A name for the recovered file that differs from the damaged one's.
/// The advice must work as written, so it must not overwrite the damaged file.
std::string new_name(const std::string& path) {
  return path == "whole.mcap" ? "recovered.mcap" : "whole.mcap";
}

}  // namespace

Findings judge_survey(const std::string& path, const RecordingSurvey& survey) {
  // Findings of reading the file come first: they may explain all others.
  Findings findings = survey.findings;
  for (const std::string& file : survey.truncated) {
    findings.push_back({Severity::warning,
                        {file, 0, "an index at the recording's end", "none"},
                        "it was not closed: the program or the machine stopped, or the disk did",
                        survey.messages == 0 ? "nothing of it can be read"
                                             : "kinalign recover " + file + " -o " +
                                                   new_name(file) + " gives it one"});
  }
  append(findings, judge_end(path, survey.facts.has_value(), survey.ending));
  if (!survey.steps.empty()) {
    // Several steps are one finding. The largest one shows how bad it was.
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
  // The numbers that this check needs are only in a recording of kinalign.
  if (survey.facts) append(findings, gone(path, survey));
  if (survey.more_marks > 0) {
    findings.push_back({Severity::note,
                        {path, 0, fmt::format("at most {} marks", grouped(most_marks)),
                         grouped(survey.more_marks) + " more"},
                        "alignment leaves them out",
                        ""});
  }
  // The count is in the end record. It is an error: these data existed and are lost.
  if (survey.end && survey.end->dropped > 0) {
    findings.push_back({Severity::error,
                        {path, 0, "every message that reached the recorder",
                         grouped(survey.end->dropped) + " fewer"},
                        "the disk was too slow for too long, and memory full",
                        "record to a disk of the machine itself"});
  }
  append(findings, lacking(path, survey));
  append(findings, numbered(path, survey));
  append(findings, not_recorded(path, survey));
  append(findings, unreadable(path, survey));
  return findings;
}

}  // namespace kinalign
