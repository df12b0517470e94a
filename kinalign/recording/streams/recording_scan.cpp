// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/streams/recording_scan.h"

#include "kinalign/core/hash.h"
#include "kinalign/recording/beside.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace kinalign {

namespace {

constexpr std::size_t most_hosts = 8;  // hosts of one stream that are listened to in the first pass

/// The streams to listen to, and their variants.
class Wanted {
 public:
  explicit Wanted(const std::vector<StreamOptions>& streams) {
    for (const StreamOptions& options : streams) {
      for (const StreamFile& file : options.files) {
        const auto wish = wish_of(options, file);
        if (wish) variants_[wish->choice.stream].insert({wish->trackers, wish->body});
      }
    }
  }
  std::set<ListenVariant> variants_of(const std::string& stream) const {
    if (variants_.empty()) return {ListenVariant{}};
    const auto found = variants_.find(stream);
    return found == variants_.end() ? std::set<ListenVariant>{} : found->second;
  }

 private:
  std::map<std::string, std::set<ListenVariant>> variants_;
};

/// The first pass: indexes the files, surveys and hashes them, and learns the devices' clocks.
class Scan {
 public:
  Scan(ScannedRecording& state, std::optional<Wanted> wanted)
      : state_(state), wanted_(std::move(wanted)) {}

  /// Reads one file of the recording.
  Result<void> read(std::size_t part, const Progress& progress) {
    const std::string& path = state_.parts[part].path;
    part_ = part;
    guard_ = {};
    versions_.push_back({path, version_of(path)});
    InputFile file = KA_TRY(InputFile::open(*state_.files, path));
    McapReader reader;
    RecordingSurveyor surveyor(reader);
    Sha256 hash;
    std::uint64_t bytes = 0;
    const auto next = [&]() -> Result<std::string_view> {
      const std::string_view piece = KA_TRY(file.next());
      hash.update(piece);
      bytes += piece.size();
      return piece;
    };
    const auto take = [&](const McapRecord& record) -> Result<void> {
      surveyor.take(record);
      take_record(record, reader);
      return {};
    };
    KA_TRY(read_recording({path, file.size(), next}, reader, take, progress));
    end_chunk();
    state_.surveys.push_back(surveyor.finish(path, bytes));
    state_.input_facts.push_back({std::string(file_name(path)), hash.hex(), bytes});
    judge_file(path, reader);
    is_closed_ = reader.closed();
    return {};
  }

  /// Call after the last file.
  void finish() {
    const std::string& path = state_.parts[part_].path;
    Findings& findings = state_.shared.findings;
    if (!ended_ && is_closed_) findings.push_back(ends_before(path));
    if (more_marks_ > 0) {
      findings.push_back({Severity::warning,
                          Error{path, 0, fmt::format("at most {} marks", most_marks),
                                fmt::format("{} more", more_marks_)},
                          "they are left out", ""});
    }
    if (end_ && end_->dropped > 0) {
      findings.push_back({Severity::warning,
                          Error{path, 0, "every message that reached the recorder",
                                fmt::format("{} fewer, of all devices", end_->dropped)},
                          "the disk was too slow for too long, and memory full", ""});
    }
    state_.chunks =
        std::make_shared<StoredChunks>(*state_.files, std::move(versions_), std::move(chunks_));
  }

 private:
  /// Keeps a record's data for the later passes.
  void take_record(const McapRecord& record, const McapReader& reader) {
    if (const auto* metadata = std::get_if<McapMetadata>(&record)) {
      if (!state_.facts) state_.facts = to_facts(*metadata);
      if (const auto end = to_end(*metadata)) end_ = end;
      ended_ = ended_ || ending_of(*metadata) != Ending::none;
    } else if (const auto* attachment = std::get_if<McapAttachment>(&record)) {
      if (attachment->name.ends_with(".bvh"))
        state_.attachments[attachment->name] = attachment->data;
    } else if (const auto* schema = std::get_if<McapSchema>(&record)) {
      schemas_[schema->id] = *schema;
    } else if (const auto* channel = std::get_if<McapChannel>(&record)) {
      add(*channel);
    } else if (const auto* message = std::get_if<McapMessage>(&record)) {
      take_message(*message, reader);
    }
  }

  /// Each chunk repeats the definitions of its channels, and so does the summary, which may be
  /// damaged. A definition covered by a checksum is preferred.
  void add(const McapChannel& defined) {
    const McapChannel* proved = proved_channel(state_.parts, defined.id);
    const McapChannel& channel = proved == nullptr ? defined : *proved;
    if (state_.channels.contains(channel.id)) return;
    add_json(defined);
    if (channel.topic == marks_topic) mark_channels_.insert(channel.id);
    const auto raw = to_raw(channel);
    if (!raw || mark_channels_.contains(channel.id)) return;
    DeviceChannel& added = state_.channels[channel.id];
    added.raw = *raw;
    added.id = channel.id;
    state_.in_order.push_back(&added);
    if (raw->node.empty() && raw->protocol != exchange_encoding) {
      added.sender = state_.senders[raw->stream].add(raw->sender);
    }
    if (wanted_) listen_to(added);
  }
  void add_json(const McapChannel& channel) {
    const auto schema = schemas_.find(channel.schema_id);
    if (channel.message_encoding != "json" || schema == schemas_.end()) return;
    if (json_channels_.insert(channel.id).second) {
      state_.json.push_back({channel.id, channel.topic, schema->second});
    }
  }

  /// Assigns a channel to the listeners of its device, one for each variant.
  void listen_to(DeviceChannel& channel) {
    const RawChannel& raw = channel.raw;
    const std::string host = raw.node.empty() ? host_of(raw.sender) : "";
    for (const ListenVariant& variant : wanted_->variants_of(raw.stream)) {
      const DeviceKey key{raw.stream, raw.node, host, variant};
      auto found = state_.listening.find(key);
      if (found == state_.listening.end()) {
        if (!host.empty() && ++hosts_[raw.stream] > most_hosts) continue;
        found = state_.listening.emplace(key, Listening(variant)).first;
      }
      found->second.define(channel.id, raw);
      channel.listening.push_back(&found->second);
    }
  }

  // A message that does not count is stored in the index as left out, so that later passes skip it.
  void take_message(const McapMessage& message, const McapReader& reader) {
    const std::uint32_t place = place_of(reader);
    const bool counts = guard_.believes(message, reader.unchecked()) && state_.facts &&
                        message.log_time <= latest_log_time &&
                        !stands_elsewhere(state_.parts, part_, message);
    const auto found = state_.channels.find(message.channel);
    const bool is_device = found != state_.channels.end();
    const bool is_json = json_channels_.contains(message.channel);
    if (counts && mark_channels_.contains(message.channel)) take_mark(message);
    if (!counts || !(is_device || is_json)) {
      chunk_.left_out.push_back(place);
      return;
    }
    note_channel(message.channel);
    if (is_device) hear(found->second, message);
  }

  void hear(DeviceChannel& from, const McapMessage& message) {
    const HostTime arrival = arrival_of(message.log_time, state_.utc_minus_host());
    if (from.sender) state_.senders[from.raw.stream].count(*from.sender, arrival);
    const std::uint32_t step = message.sequence - from.last_number.value_or(message.sequence - 1);
    from.last_number = message.sequence;
    if (step > 1 && step < 1U << 31U) from.missing += step - 1;
    for (Listening* one : from.listening) {
      one->take({&from.raw, from.id, arrival, message.data});
    }
  }

  /// Keeps a mark. Marks beyond most_marks are only counted.
  void take_mark(const McapMessage& message) {
    auto& marks = state_.shared.marks;
    if (marks.size() >= most_marks) {
      ++more_marks_;
      return;
    }
    auto said = to_mark(message.data);
    if (!said) return;
    const Time at{Duration{static_cast<std::int64_t>(message.log_time)}};
    marks.push_back({at, name_of(said->mark.kind), std::move(said->mark.text), said->mark.latency,
                     std::move(said->source)});
  }

  /// The index of the message in its chunk, among the messages that the reader returns.
  std::uint32_t place_of(const McapReader& reader) {
    if (!is_in_chunk_ || chunk_.at != reader.at()) {
      end_chunk();
      is_in_chunk_ = true;
      chunk_.part = static_cast<std::uint32_t>(part_);
      chunk_.is_torn = reader.in_torn_chunk();
      chunk_.at = reader.at();
      chunk_.size = reader.size();
    }
    return places_++;
  }
  void end_chunk() {
    if (is_in_chunk_ && !chunk_.channels.empty()) chunks_.push_back(std::move(chunk_));
    chunk_ = {};
    is_in_chunk_ = false;
    places_ = 0;
  }
  void note_channel(std::uint16_t id) {
    auto& channels = chunk_.channels;
    const auto at = std::lower_bound(channels.begin(), channels.end(), id);
    if (at == channels.end() || *at != id) channels.insert(at, id);
  }

  /// Reports damage and truncation of a file.
  void judge_file(const std::string& path, const McapReader& reader) {
    Findings& findings = state_.shared.findings;
    for (Finding finding : reader.findings()) {
      finding.what.file = path;
      findings.push_back(std::move(finding));
    }
    append(findings, judge_strays(path, guard_));
    if (reader.closed()) return;
    findings.push_back(
        {Severity::warning, Error{path, 0, "a file that was closed", "one that breaks off"},
         "everything up to the break was read", "kinalign recover makes a whole file of it"});
  }

  ScannedRecording& state_;
  std::optional<Wanted> wanted_;  // absent: no device is listened to
  std::size_t part_ = 0;
  NumberGuard guard_;
  std::vector<StoredChunks::File> versions_;
  std::vector<StoredChunk> chunks_;
  StoredChunk chunk_;  // the chunk of the present messages
  bool is_in_chunk_ = false;
  std::uint32_t places_ = 0;
  std::map<std::uint16_t, McapSchema> schemas_;
  std::set<std::uint16_t> mark_channels_, json_channels_;
  std::map<std::string, std::size_t> hosts_;  // hosts of each stream
  std::uint64_t more_marks_ = 0;              // marks beyond most_marks
  std::optional<RecordingEnd> end_;
  bool ended_ = false;  // the recording has ended, or recover found it truncated
  bool is_closed_ = false;
};

}  // namespace

Result<ScannedRecording> scan_recording(FileSystem& files, const std::string& path,
                                        const ListenTo& listen, const Progress& progress) {
  ScannedRecording scanned;
  scanned.files = &files;
  scanned.path = path;
  scanned.parts = KA_TRY(parts_from(files, path, progress));
  Scan scan(scanned, listen.any ? std::optional(Wanted(listen.wanted)) : std::nullopt);
  for (std::size_t part = 0; part < scanned.parts.size(); ++part) KA_TRY(scan.read(part, progress));
  scan.finish();
  append(scanned.shared.findings, judge_parts(scanned.parts, PartsBehind::read));
  append(scanned.shared.findings, judge_namesakes(files, scanned.parts.front().path));
  return scanned;
}

}  // namespace kinalign
