// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/survey.h"

#include "kinalign/documents/lab_toml.h"
#include "kinalign/protocols/protocols.h"
#include "kinalign/protocols/slimevr/packet.h"
#include "kinalign/recording/kinect_survey.h"
#include "kinalign/wire/little_endian_reader.h"

#include <algorithm>
#include <array>

namespace kinalign {

namespace {

/// The sensors whose rotations the datagram contains, one bit each. The result is 0 if the datagram
/// is not from a tracker.
std::uint32_t rotating_sensors(std::string_view payload) {
  std::uint32_t sensors = 0;
  SlimeDatagram datagram;
  if (!decode_slime(octets(payload), datagram)) return sensors;
  for (const SlimePacket& packet : datagram.packets) {
    const auto* motion = std::get_if<SlimeMotion>(&packet);
    const bool rotates = motion != nullptr && motion->rotation && !motion->is_correction;
    if (rotates && motion->sensor < 32) sensors |= 1U << motion->sensor;
  }
  return sensors;
}

// This limits the memory, because a damaged file may name any number of senders.
constexpr std::size_t most_counted = 4096;

/// Replaces earlier counts with the same key. Counts only grow within a take, so the last message
/// of a sender contains everything. A damaged message that can't be decoded is ignored.
template <class Key, class Counted>
void keep_last(const Key& key, const Counted& counted, std::map<Key, Counted>& last) {
  if (last.size() < most_counted || last.contains(key)) last.insert_or_assign(key, counted);
}

/// Adds the places of all nodes in lab.toml, even of nodes that never sent data. A lab.toml that
/// can't be read is ignored.
void add_places(std::string_view lab_toml, std::map<std::string, std::string>& places) {
  const auto devices = read_devices(lab_toml, "lab.toml");
  if (!devices) return;
  for (const DeviceOptions& device : *devices) {
    for (const auto& [id, place] : device.nodes) places[device.name + "/" + id] = place;
  }
}

}  // namespace

/// Completes the survey after the last record.
RecordingSurvey RecordingSurveyor::finish(const std::string& path, const RecordStream& stream) {
  for (auto& [id, channel] : channels_) {
    channel.missing = stream.numbers().missing(id);
    survey_.channels.push_back(std::move(channel));
  }
  // A topic begins with stream and node, so sorting by topic groups them. Channels with the same
  // topic stay in the order of their ids.
  std::stable_sort(survey_.channels.begin(), survey_.channels.end(),
                   [](const auto& a, const auto& b) { return a.channel.topic < b.channel.topic; });
  for (auto& [key, counted] : senders_) survey_.senders.push_back(std::move(counted));
  for (auto& [key, counted] : ports_) survey_.ports.push_back(std::move(counted));
  survey_.unchecked = stream.unchecked();
  if (auto anchor = utc_anchor(clock_)) survey_.steps = std::move(anchor->steps);
  survey_.findings = stream.findings();
  append(survey_.findings, kinects_.findings(path));
  survey_.bytes = stream.bytes();
  survey_.truncated = stream.truncated();
  survey_.ending = stream.ending();
  return std::move(survey_);
}

/// Adds a channel. The first definition is kept, so that a damaged summary can't override the
/// definitions in the data section.
void RecordingSurveyor::add(const McapChannel& channel) {
  const auto [known, is_new] = channels_.try_emplace(channel.id);
  // A message before the definition may have created the channel, which then has no topic yet.
  if (!is_new && !known->second.channel.topic.empty()) return;
  known->second.channel = channel;
  const auto raw = to_raw(channel);
  if (raw) kinects_.add(channel.id, *raw);
  if (raw && !raw->place.empty()) survey_.places[raw->stream + "/" + raw->node] = raw->place;
}

void RecordingSurveyor::add(const McapMetadata& metadata) {
  if (auto devices = to_expected_devices(metadata)) survey_.expected = *std::move(devices);
  if (const auto end = to_end(metadata)) survey_.end = end;
  if (survey_.facts) return;
  survey_.facts = to_facts(metadata);
  // The clock pairs show steps of the wall clock. The anchor is the first pair.
  if (survey_.facts) clock_.push_back(survey_.facts->anchor);
}

void RecordingSurveyor::add(const McapAttachment& attachment) {
  survey_.attachments.push_back(attachment.name);
  if (attachment.name == "lab.toml") add_places(attachment.data, survey_.places);
}

void RecordingSurveyor::add(const McapMessage& message) {
  ++survey_.messages;
  ChannelSurvey& channel = channels_[message.channel];
  channel.channel.id = message.channel;  // needed if the channel has no definition
  if (channel.messages == 0) channel.first = message.log_time;
  channel.first = std::min(channel.first, message.log_time);
  channel.last = std::max(channel.last, message.log_time);
  ++channel.messages;
  channel.bytes += message.data.size();
  if (find_recorded_protocol(channel.channel.message_encoding) == Protocol::slimevr) {
    channel.sensors |= rotating_sensors(message.data);
  }
  kinects_.take(message.channel, message.data);
  // Files of other programs may use the same topics for other contents.
  if (survey_.facts && channel.channel.message_encoding == "json") {
    add_own(channel.channel.topic, message);
  }
}

/// Takes a message of the recorder itself: counts, a mark or a pair of clocks.
void RecordingSurveyor::add_own(std::string_view topic, const McapMessage& message) {
  if (topic == sender_counts_topic) {
    const auto one = to_counted_sender(message.data);
    if (one) keep_last({one->topic, one->stream, one->sender, one->node}, *one, senders_);
  } else if (topic == port_counts_topic) {
    const auto one = to_counted_port(message.data);
    if (one) keep_last(one->stream, *one, ports_);
  } else if (topic == marks_topic) {
    add_mark(message);
  } else if (topic == host_clock_topic) {
    if (const auto pair = to_clock_pair(message.data)) clock_.push_back(*pair);
  }
}

void RecordingSurveyor::add_mark(const McapMessage& message) {
  auto mark = to_mark(message.data);
  if (!mark) return;
  if (survey_.marks.size() < most_marks) {
    survey_.marks.emplace_back(*std::move(mark), message.log_time);
  } else {
    ++survey_.more_marks;
  }
}

Findings judge_end(const std::string& path, bool is_ours, Ending ending) {
  if (!is_ours || ending != Ending::none) return {};
  return {{Severity::warning,
           Error{path, 0, "a recording's last file", "a file without the end of the recording"},
           "the disk accepted no more data; later data is in another file, if one could be written",
           "look for the next part (such as take.part2.mcap) where it was recorded; kinalign "
           "recover joins all parts"}};
}

Result<bool> is_recording(FileSystem& files, const std::string& path) {
  const InputFile file = KA_TRY(InputFile::open(files, path));
  // A file that is shorter than the magic is not an MCAP file.
  std::array<char, mcap_magic.size()> head{};
  const std::size_t got = KA_TRY(file.read_at(0, head));
  return looks_like_recording(std::string_view(head.data(), got));
}

}  // namespace kinalign
