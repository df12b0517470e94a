// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/streams/recording_scan.h"

#include "kinalign/core/hash.h"
#include "kinalign/recording/record_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace kinalign {

namespace {

constexpr std::size_t most_hosts = 8;  // hosts per stream that get a listener

/// For each stream, the wanted variants of its rows. If a stream is wanted with two bodies, or with
/// trackers, too, each variant gets its own listener.
using Wanted = std::map<std::string, std::set<ListenVariant>>;
Wanted wanted_of(const std::vector<StreamOptions>& streams) {
  Wanted wanted;
  for (const StreamOptions& options : streams) {
    for (const StreamFile& file : options.files) {
      // If the selection of a stream is wrong, the stream is left out here. Opening the stream
      // later reports the error.
      const auto request = request_of(options, file);
      if (request) wanted[request->choice.stream].insert({request->trackers, request->body});
    }
  }
  return wanted;
}

/// The first pass: indexes, surveys and hashes the files, and learns the devices' clocks. Each file
/// is read only once, because recordings are larger than memory and disks are slow.
class Scan {
 public:
  Scan(ScannedRecording& state, std::optional<Wanted> wanted)
      : state_(state), wanted_(std::move(wanted)) {}

  Result<void> read(const Progress& progress) {
    std::vector<StoredChunks::File> versions;
    for (const RecordingPart& part : state_.parts) {
      // The versions are stored before reading, so that a change during the pass is noticed later.
      versions.push_back({part.path, version_of(part.path)});
      state_.input_facts.push_back({std::string(file_name(part.path)), "", 0});
    }
    std::vector<Sha256> hashes(state_.parts.size());
    const auto hash = [&](std::size_t part, std::string_view piece) {
      hashes[part].update(piece);
      state_.input_facts[part].bytes += piece.size();
    };
    RecordStream stream = KA_TRY(RecordStream::open(*state_.files, state_.parts, progress, hash));
    while (const McapRecord* record = KA_TRY(stream.next())) {
      surveyor_.take(*record);
      take_record(*record, stream);
    }
    // The end of the recording closes the last chunk.
    end_chunk();
    state_.chunks =
        std::make_shared<StoredChunks>(*state_.files, std::move(versions), std::move(chunks_));
    for (std::size_t k = 0; k < hashes.size(); ++k) state_.input_facts[k].sha256 = hashes[k].hex();
    for (auto& [id, channel] : state_.channels) channel.missing = stream.numbers().missing(id);
    state_.survey = surveyor_.finish(state_.path, stream);
    judge(stream);
    return {};
  }

 private:
  /// Keeps the data of a record that later passes need.
  void take_record(const McapRecord& record, const RecordStream& stream) {
    if (const auto* attachment = std::get_if<McapAttachment>(&record)) {
      if (attachment->name.ends_with(".bvh"))
        state_.attachments[attachment->name] = attachment->data;
    } else if (const auto* schema = std::get_if<McapSchema>(&record)) {
      schemas_[schema->id] = *schema;
    } else if (const auto* channel = std::get_if<McapChannel>(&record)) {
      add(*channel);
    } else if (const auto* message = std::get_if<McapMessage>(&record)) {
      take_message(*message, stream);
    }
  }

  /// Each chunk repeats the definitions of its channels. The summary repeats them, too, but may be
  /// damaged. The first definition is kept.
  void add(const McapChannel& channel) {
    if (state_.channels.contains(channel.id)) return;
    add_json(channel);
    const auto raw = to_raw(channel);
    // The channel of marks looks like a device's channel, but is not a stream.
    if (!raw || channel.topic == marks_topic) return;
    DeviceChannel& added = state_.channels[channel.id];
    added.raw = *raw;
    added.id = channel.id;
    state_.in_order.push_back(&added);
    if (raw->node.empty() && raw->protocol != exchange_encoding) {
      // The id identifies a node, whatever its address, so nodes are not listed as senders.
      added.sender = state_.senders[raw->stream].add(raw->sender);
    }
    if (wanted_) listen_to(added);
  }
  void add_json(const McapChannel& channel) {
    const auto schema = schemas_.find(channel.schema_id);
    if (channel.message_encoding != "json" || schema == schemas_.end()) return;
    // Viewers show the recorder's own channels and need their schemas.
    if (json_channels_.insert(channel.id).second) {
      state_.json.push_back({channel.id, channel.topic, schema->second});
    }
  }

  /// Assigns a channel to the listeners of its device. Each variant has its own listener.
  void listen_to(DeviceChannel& channel) {
    const RawChannel& raw = channel.raw;
    // If no streams are named, every stream gets a listener with default options.
    const std::set<ListenVariant> variants =
        wanted_->empty() ? std::set{ListenVariant{}} : (*wanted_)[raw.stream];
    for (const ListenVariant& variant : variants) {
      const DeviceKey key = key_of(raw, variant);
      auto found = state_.listening.find(key);
      if (found == state_.listening.end()) {
        // Any program may send to a port. The limit prevents a listener for each of very many
        // hosts.
        if (raw.node.empty() && ++hosts_[raw.stream] > most_hosts) continue;
        const auto protocol = rows_of(protocol_of(raw), variant.trackers);
        auto listener = protocol ? protocol->listen(variant.body) : nullptr;
        found = state_.listening.emplace(key, Listening{std::move(listener)}).first;
      }
      found->second.channels.push_back(channel.id);
      channel.listening.push_back(&found->second);
    }
  }

  void take_message(const McapMessage& message, const RecordStream& stream) {
    const auto found = state_.channels.find(message.channel);
    const bool is_device = found != state_.channels.end();
    const bool is_json = json_channels_.contains(message.channel);
    // A file without facts comes from another program, and its times have another meaning.
    const bool counts = surveyor_.facts() && message.log_time <= latest_log_time;
    if (!counts || !(is_device || is_json)) return;
    add_to_index(message.channel, stream);
    if (is_device) pass_on(found->second, message);
  }

  void pass_on(DeviceChannel& from, const McapMessage& message) {
    const HostTime arrival = arrival_of(message.log_time, surveyor_.facts()->utc_minus_host());
    // Nodes are not counted as senders, because their ids identify them.
    if (from.sender) state_.senders[from.raw.stream].count(*from.sender, arrival);
    for (const Listening* one : from.listening) {
      if (one->listener) one->listener->take({&from.raw, from.id, arrival, message.data});
    }
  }

  /// Adds the last message to the index of its chunk. Later passes skip messages that are not in
  /// the index.
  void add_to_index(std::uint16_t channel, const RecordStream& stream) {
    const McapReader& reader = stream.reader();
    if (chunk_.end == 0 || chunk_.part != stream.part() || chunk_.at != reader.at()) {
      end_chunk();
      chunk_.part = static_cast<std::uint32_t>(stream.part());
      chunk_.is_truncated = reader.in_truncated_chunk();
      chunk_.at = reader.at();
      chunk_.size = reader.size();
    }
    // The messages between the last indexed message and this one were damaged or duplicate. They
    // are marked to be skipped.
    for (; chunk_.end < stream.place(); ++chunk_.end) chunk_.left_out.push_back(chunk_.end);
    ++chunk_.end;
    auto& channels = chunk_.channels;
    // The list is sorted, so that MessagePass can search it quickly.
    const auto at = std::lower_bound(channels.begin(), channels.end(), channel);
    if (at == channels.end() || *at != channel) channels.insert(at, channel);
  }
  void end_chunk() {
    if (chunk_.end > 0) chunks_.push_back(std::move(chunk_));
    chunk_ = {};
  }

  /// Keeps the marks. Adds findings about damage, truncated files and missing parts of the
  /// recording.
  void judge(const RecordStream& stream) {
    const RecordingSurvey& survey = state_.survey;
    const std::string& last = state_.parts.back().path;
    for (const auto& [recorded, log_time] : survey.marks) {
      // A later log time is damaged and can't be a stamp.
      if (log_time > latest_log_time) continue;
      const Time at{Duration{static_cast<std::int64_t>(log_time)}};
      state_.shared.marks.push_back({at, name_of(recorded.mark.kind), recorded.mark.text,
                                     recorded.mark.latency, recorded.source});
    }
    Findings& findings = state_.shared.findings;
    findings = stream.findings();
    for (const std::string& path : survey.truncated) {
      findings.push_back({Severity::warning,
                          Error{path, 0, "a file that was closed", "a truncated file"},
                          "all data before the end of the file was read",
                          "kinalign recover makes a complete file of it"});
    }
    append(findings, judge_end(last, survey.facts.has_value(), survey.ending));
    if (survey.more_marks > 0) {
      findings.push_back({Severity::warning,
                          Error{last, 0, fmt::format("at most {} marks", most_marks),
                                fmt::format("{} more", survey.more_marks)},
                          "further marks are left out", ""});
    }
    if (survey.end && survey.end->dropped > 0) {
      findings.push_back({Severity::warning,
                          Error{last, 0, "every message that reached the recorder",
                                fmt::format("{} fewer, all devices together", survey.end->dropped)},
                          "the disk was too slow, and the memory for waiting data was full", ""});
    }
    append(findings, judge_parts(*state_.files, state_.parts, Severity::note));
  }

  ScannedRecording& state_;
  std::optional<Wanted> wanted_;  // empty: no device gets a listener
  RecordingSurveyor surveyor_;
  std::vector<StoredChunk> chunks_;
  StoredChunk chunk_;  // the chunk of the last message
  std::map<std::uint16_t, McapSchema> schemas_;
  std::set<std::uint16_t> json_channels_;
  std::map<std::string, std::size_t> hosts_;  // number of hosts of each stream
};

}  // namespace

Result<ScannedRecording> scan_recording(FileSystem& files, const std::string& path,
                                        const std::vector<StreamOptions>* wanted,
                                        const Progress& progress) {
  ScannedRecording scanned;
  scanned.files = &files;
  scanned.path = path;
  scanned.parts = KA_TRY(find_parts(files, {path}));
  Scan scan(scanned, wanted != nullptr ? std::optional(wanted_of(*wanted)) : std::nullopt);
  KA_TRY(scan.read(progress));
  return scanned;
}

}  // namespace kinalign
