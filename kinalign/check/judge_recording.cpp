// SPDX-License-Identifier: Apache-2.0
#include "kinalign/check/judge_survey.h"
#include "kinalign/check/recording_words.h"
#include "kinalign/core/numbers.h"
#include "kinalign/protocols/protocols.h"
#include "kinalign/syntax/toml.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>

namespace kinalign {

namespace {

/// Returns whether the port is one of the recorder's own ports. No device can have their names.
bool is_of_marks(const CountedPort& port) {
  return port.stream == "marks" || port.stream == "trigger";
}

/// Makes the findings about one recording. Each function judges one kind of fault.
class RecordingJudge {
 public:
  RecordingJudge(const std::string& path, const RecordingSurvey& survey)
      : survey_(survey), out_{path, survey.findings} {}

  Findings judge() {
    // Findings of the reader are reported first, because they may explain the other findings.
    judge_truncated();
    append(out_.all, judge_end(out_.file, survey_.facts.has_value(), survey_.ending));
    judge_wall_clock();
    // Only a recording of kinalign has the message numbers that this check needs.
    if (survey_.facts) judge_messages();
    if (survey_.more_marks > 0) {
      out_.add(Severity::note, fmt::format("at most {} marks", grouped(most_marks)),
               grouped(survey_.more_marks) + " more", "alignment leaves them out");
    }
    // The end record states this count. It is an error, because these data existed and are lost.
    if (survey_.end && survey_.end->dropped > 0) {
      out_.add(Severity::error, "every message that reached the recorder",
               grouped(survey_.end->dropped) + " fewer",
               "the disk was too slow, and the memory for waiting data was full",
               "record to a local disk");
    }
    for (const auto& [prefix, required] : survey_.expected) {
      if (required) judge_required(prefix);
    }
    for (const CountedSender& one : survey_.senders) judge_numbers(one);
    for (const CountedPort& one : survey_.ports) judge_port(one);
    judge_rows();
    return out_.all;
  }

 private:
  void judge_truncated() {
    for (const std::string& file : survey_.truncated) {
      // The suggested command must work as printed, so it must not overwrite the damaged file.
      const char* whole = file == "whole.mcap" ? "recovered.mcap" : "whole.mcap";
      out_.all.push_back(
          {Severity::warning,
           {file, 0, "an index at the recording's end", "none"},
           "the file was not closed: the program, the machine or the disk stopped",
           survey_.messages == 0
               ? "no message of it can be read"
               : fmt::format("kinalign recover {} -o {} makes a complete file", file, whole)});
    }
  }

  /// All steps of the wall clock are reported as one finding, with the largest step.
  void judge_wall_clock() {
    if (survey_.steps.empty()) return;
    const WallClockStep& worst = *std::max_element(
        survey_.steps.begin(), survey_.steps.end(), [](const auto& a, const auto& b) {
          return std::chrono::abs(a.by) < std::chrono::abs(b.by);
        });
    out_.add(
        Severity::warning, "a wall clock that is not set during the recording",
        fmt::format("set {} times, by up to {:+.3f} s", survey_.steps.size(), seconds(worst.by)),
        "UTC times follow the clock as it was at the beginning; time differences are correct",
        "set the machine's clock before recording: docs/time_server.md");
  }

  /// Reports messages as errors if they reached the recorder and are missing in the file. Gaps in
  /// the recorder's own numbers show most of them. The recorder's counts also show messages missing
  /// at the beginning and end of a topic. The recorder counts messages before it writes them.
  void judge_messages() {
    const auto add = [this](const std::string& expected, std::uint64_t missing) {
      if (missing == 0) return;
      out_.add(Severity::error, expected, grouped(missing) + " missing",
               "these messages reached the recorder and are not in the file",
               "a part of the recording in another folder may have them");
    };
    for (const ChannelSurvey& channel : survey_.channels) {
      add(channel.channel.topic + " with consecutive message numbers", channel.missing);
    }
    // In later parts the counts begin with the recording, not with the file.
    if (survey_.facts->part != 1) return;
    for (const CountedSender& one : survey_.senders) {
      // Missing messages inside the topic have their own finding.
      std::uint64_t known = 0;
      for (const ChannelSurvey& channel : survey_.channels) {
        if (channel.channel.topic == one.topic) known += channel.messages + channel.missing;
      }
      const std::uint64_t counted = one.counts.messages;
      add(fmt::format("the {} messages on {} that were counted", grouped(counted), one.topic),
          counted - std::min(counted, known));
    }
  }

  /// Warns if a required device has no message in the recording. `prefix` is the begin of its
  /// topics: "mocap" or, for a node, "imu/7".
  void judge_required(const std::string& prefix) {
    for (const ChannelSurvey& one : survey_.channels) {
      // A channel without messages does not count.
      if (one.channel.topic.starts_with("/" + prefix + "/") && one.messages > 0) return;
    }
    // The part before '/' is the device, because a port belongs to a device.
    const std::size_t slash = std::min(prefix.find('/'), prefix.size());
    const std::string device = prefix.substr(0, slash);
    const std::string node = prefix.substr(std::min(slash + 1, prefix.size()));
    const std::string unusable = unusable_at(device);
    out_.add(Severity::warning, "messages of " + sender_name(device, node, survey_),
             unusable.empty() ? "none" : "none: " + unusable,
             "the recording has no data of a device that the lab requires",
             unusable.empty()
                 ? "check that it sends to the recording machine; docs/recording.md"
                 : "check that it sends to this port, and other devices to their own ports; "
                   "docs/recording.md");
  }

  /// Returns text about datagrams at the port of a device without recorded data, or "" if there
  /// were none. Such datagrams mean that a device uses the wrong port; without them, it is probably
  /// switched off.
  std::string unusable_at(const std::string& device) const {
    const auto is_of_device = [&device](const auto& one) { return one.stream == device; };
    const auto port = std::find_if(survey_.ports.begin(), survey_.ports.end(), is_of_device);
    const bool sent = std::any_of(survey_.senders.begin(), survey_.senders.end(), is_of_device);
    return sent || port == survey_.ports.end() ? "" : unusable_data(port->counts, "to its port");
  }

  /// Notes about frames that did not reach the recorder and about restarts, from the device's own
  /// numbers. The frames were lost on the network or in the device. The finding is only a note,
  /// since nothing can be repaired.
  void judge_numbers(const CountedSender& one) {
    const SequenceCounts& order = one.counts.order;
    if (order.lost > 0) {
      // The share of lost frames refers to all frame numbers that the sender used.
      const std::uint64_t all = order.lost + frames_or_messages(one.counts);
      out_.add(Severity::note, "every frame that " + name_of(one, survey_) + " sent",
               fmt::format("{} lost of {}", grouped(order.lost), grouped(all)),
               "by the sender's own numbers; they did not reach the recorder, or were never sent");
    }
    if (order.restarts > 0) {
      out_.add(Severity::note, "one run of " + name_of(one, survey_),
               grouped(order.restarts + 1) + " runs: it restarted",
               "each run has its own clock; the time between two runs is unknown");
    }
  }

  /// Findings about data that arrived at a port and is not in the recording.
  void judge_port(const CountedPort& port) {
    PortCounts counts = port.counts;
    if (counts.sifted) {
      judge_nodes_port(port);
      return;
    }
    // Other programs may send such datagrams without harm, but one of them may have been meant as a
    // mark.
    if (is_of_marks(port) && counts.refused > 0) {
      out_.add(Severity::note, "only marks at the port of " + port.stream,
               grouped(counts.refused) + " datagrams that are not marks",
               "record reported the first one of each reason",
               "docs/formats/marks.md says how a mark is sent");
      counts.refused = 0;
    }
    const std::string lost = loss_of(counts, 0);
    if (lost.empty()) return;
    out_.add(Severity::warning, "all data that arrived at the port of " + port.stream, lost,
             "this data reached the recording machine but is not in the recording",
             "check what else the machine does while it records");
  }

  /// A filter of the kernel drops and counts datagrams that are not frames of nodes, for example
  /// those of another device. Many such datagrams are a warning; `record` uses the same limit.
  void judge_nodes_port(const CountedPort& port) {
    // Examples are frames of a node without the lab's key.
    if (port.counts.refused > 0) {
      out_.add(Severity::note, "only frames of the lab's nodes at the port of " + port.stream,
               grouped(port.counts.refused) + " refused datagrams",
               "a missing node may have sent them, for example without the lab's key",
               "record reported the node and the reason");
    }
    const std::uint64_t foreign =
        foreign_datagrams(port.counts, frames_lost(port.stream, survey_.senders));
    if (foreign == 0) return;
    out_.add(are_many(foreign) ? Severity::warning : Severity::note,
             "only frames of nodes at the port of " + port.stream,
             fmt::format("{}{} other datagrams", foreign < port.counts.dropped ? "at least " : "",
                         grouped(foreign)),
             "they were dropped and are not in the recording",
             "check the port and the protocol that each device sends to");
  }

  /// Findings about streams that can't be aligned. Their messages have another protocol than
  /// stated, most frames are refused, or there is no skeleton.
  void judge_rows() {
    // A set, because a stream with several senders must be named once.
    std::set<std::string> without_skeleton;
    for (const CountedSender& one : survey_.senders) {
      const auto channel = std::find_if(
          survey_.channels.begin(), survey_.channels.end(),
          [&one](const ChannelSurvey& known) { return known.channel.topic == one.topic; });
      // A sender without a channel has no message in this file.
      if (channel == survey_.channels.end()) continue;
      const std::string& protocol = channel->channel.message_encoding;
      const SenderCounts& counts = one.counts;
      if (speaks_another_protocol(protocol, counts)) {
        out_.add(Severity::warning, "frames of " + protocol + " from " + name_of(one, survey_),
                 grouped(counts.messages) + " messages without such a frame",
                 "this data can't be aligned as " + protocol,
                 std::string(advice_without_frames(protocol)));
      }
      const auto known = find_recorded_protocol(protocol);
      // Frames are counted only for protocols that are decoded.
      if (!known || counts.frames == 0) continue;
      const ProtocolRow& row = row_of(*known);
      // A suit's frame is sent in several datagrams, which do not state their frame. If some are
      // lost or out of order, the frame can't be assembled.
      if (row.losses == LossNumbers::frame_heads && are_many(counts.refused) &&
          counts.refused > counts.frames) {
        out_.add(
            Severity::warning, "readable frames from " + name_of(one, survey_),
            fmt::format("{} readable, {} not", grouped(counts.frames), grouped(counts.refused)),
            "fewer than half of the frames can be aligned, although the recording has all their "
            "bytes",
            "use TCP, which neither loses nor mixes pieces of frames");
      }
      // The recorder attaches the suit's BVH file under the name of the device.
      const auto& names = survey_.attachments;
      const bool has_body =
          std::find(names.begin(), names.end(), one.stream + ".bvh") != names.end();
      if (row.needs_skeleton && !has_body) without_skeleton.insert(one.stream);
    }
    for (const std::string& stream : without_skeleton) {
      out_.add(Severity::note, "a skeleton for " + stream, "none",
               "Noitom's stream does not say whose body it moves; alignment needs it",
               "skeleton = \"a.bvh\" in [stream." + toml_key(stream) + "] of a recording.toml");
    }
  }

  const RecordingSurvey& survey_;
  FileFindings out_;
};

}  // namespace

Findings judge_survey(const std::string& path, const RecordingSurvey& survey) {
  return RecordingJudge(path, survey).judge();
}

}  // namespace kinalign
