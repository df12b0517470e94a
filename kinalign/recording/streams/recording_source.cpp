// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/streams/recording_source.h"

#include "kinalign/core/hash.h"
#include "kinalign/formats/bvh/head.h"
#include "kinalign/protocols/protocols.h"
#include "kinalign/recording/beside.h"
#include "kinalign/recording/streams/sender_choice.h"
#include "kinalign/recording/survey_parts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <tuple>

namespace kinalign {

namespace {

constexpr std::size_t most_names = 32;  // of streams and nodes in messages
constexpr std::size_t most_hosts = 8;   // of a stream that are listened to in the first pass

DeviceProtocol rows_of(Protocol protocol) {
  switch (protocol) {
    case Protocol::nodes:
      return node_protocol();
    case Protocol::noitom:
      return noitom_protocol();
    case Protocol::xsens:
      return xsens_protocol();
    case Protocol::kinect:
      return kinect_protocol();
    case Protocol::slimevr:
      break;
  }
  return slimevr_protocol();
}

/// nullopt: no rows can be made of it.
std::optional<DeviceProtocol> rows_of(const std::string& recorded_name, bool trackers) {
  const auto protocol = find_recorded_protocol(recorded_name);
  if (!protocol) return std::nullopt;
  if (!trackers) return rows_of(*protocol);
  return row_of(*protocol).has_trackers ? std::optional(xsens_tracker_protocol()) : std::nullopt;
}

Result<DeviceProtocol> protocol_of(const RawChannel& channel, const DeviceWish& wish) {
  const std::string& file = wish.file.path;
  const auto protocol = find_recorded_protocol(channel.protocol);
  if (!wish.skeleton.empty() && !(protocol && row_of(*protocol).needs_skeleton)) {
    return Failure(Error{file, 0, "a skeleton of a noitom stream alone",
                         "one of " + shown(channel.stream) + ", of " + shown(channel.protocol)});
  }
  if (const auto known = rows_of(channel.protocol, wish.trackers)) return *known;
  if (wish.trackers) {
    return Failure(Error{file, 0, "trackers of an xsens stream",
                         shown(channel.stream) + ", of " + shown(channel.protocol)});
  }
  std::string known;
  for (const Protocol one :
       {Protocol::nodes, Protocol::kinect, Protocol::noitom, Protocol::xsens, Protocol::slimevr}) {
    known += (known.empty() ? "" : ", ") + std::string(row_of(one).recorded_name);
  }
  return Failure(Error{file, 0, "of stream " + shown(channel.stream) + " one of: " + known,
                       "'" + shown(channel.protocol) + "', of which no rows can be made yet",
                       ErrorKind::no_rows_in_recording});
}

std::string selected(const StreamOptions& options, const char* key, const std::string& otherwise) {
  const auto found = options.select.find(key);
  return found == options.select.end() ? otherwise : found->second;
}

/// "10.0.0.21" and "1" of "10.0.0.21/1", a tracker's sensor; other nodes are returned as they are.
std::pair<std::string, std::string> tracker_of(const std::string& node) {
  const auto slash = node.rfind('/');
  const bool has_sensor = slash != std::string::npos && slash + 1 < node.size() &&
                          node.find_first_not_of("0123456789", slash + 1) == std::string::npos;
  if (!has_sensor) return {node, ""};
  return {node.substr(0, slash), node.substr(slash + 1)};
}

Result<DeviceWish> wish_of(const StreamOptions& options, const StreamFile& file) {
  for (const auto& [name, value] : options.select) {
    if (name == "stream" || name == "node" || name == "sender" || name == "body") continue;
    if (name == "kind" && (value == "poses" || value == "trackers")) continue;
    return Failure(Error{file.path, 0,
                         "select by stream, node, sender, body or kind (poses, trackers)",
                         shown(name) + " = " + shown(value)});
  }
  DeviceWish wish{options, file, {}};
  wish.trackers = selected(options, "kind", "poses") == "trackers";
  wish.choice = {selected(options, "stream", options.name), selected(options, "node", file.node),
                 selected(options, "sender", "")};
  const auto [tracker, sensor] = tracker_of(wish.choice.node);
  if (wish.choice.sender.empty()) wish.choice.sender = tracker;
  const std::string body = selected(options, "body", sensor);
  if (body.empty()) return wish;
  std::uint64_t id = 0;
  const auto [behind, fault] = std::from_chars(body.data(), body.data() + body.size(), id);
  if (fault == std::errc{} && behind == body.data() + body.size()) {
    wish.body = id;
    return wish;
  }
  return Failure(Error{file.path, 0, "select.body: a whole number", "'" + shown(body) + "'"});
}

/// What a listener is made for beside its device.
struct Variant {
  bool trackers = false;
  std::optional<std::uint64_t> body;

  auto operator<=>(const Variant&) const = default;
};

/// Listens to the channels of one device.
class Listening {
 public:
  explicit Listening(Variant variant) : variant_(variant) {}

  /// Channels are defined before their messages come.
  void define(std::uint16_t id, const RawChannel& raw) {
    channels_.push_back(id);
    if (!chosen_ && raw.protocol != exchange_encoding) chosen_ = raw;
  }
  void take(const RecordedMessage& message) {
    if (!chosen_) {  // exchanges before the first payload
      if (early_.size() < most_early) early_.push_back({message, std::string(message.payload)});
      return;
    }
    if (!begin()) return;
    for (Early& early : early_) {
      early.message.payload = early.payload;
      listener_->take(early.message);
    }
    early_.clear();
    listener_->take(message);
  }

  const std::vector<std::uint16_t>& channels() const { return channels_; }  // as defined
  /// The device's first channel of payloads.
  const std::optional<RawChannel>& chosen() const { return chosen_; }
  /// After the last message, once. nullptr: no rows can be made of the protocol.
  std::unique_ptr<DeviceListener> release() { return begin() ? std::move(listener_) : nullptr; }
  bool is_released() const { return begun_ && !listener_; }

 private:
  bool begin() {
    if (begun_) return listener_ != nullptr;
    begun_ = true;
    const auto protocol = rows_of(chosen_->protocol, variant_.trackers);
    if (protocol) listener_ = protocol->listen(variant_.body);
    return listener_ != nullptr;
  }

  static constexpr std::size_t most_early = 1000;
  struct Early {
    RecordedMessage message;
    std::string payload;
  };
  Variant variant_;
  std::vector<std::uint16_t> channels_;
  std::optional<RawChannel> chosen_;
  std::vector<Early> early_;
  bool begun_ = false;
  std::unique_ptr<DeviceListener> listener_;
};

/// A device by its stream and node id or, without one, by its sender's host.
using DeviceKey = std::tuple<std::string, std::string, std::string, Variant>;

struct DeviceChannel {
  RawChannel raw;
  std::uint16_t id = 0;
  std::optional<std::size_t> sender{};  // its number on the stream's roll
  std::optional<std::uint32_t> last_number{};
  std::uint64_t missing = 0;  // messages between others
  std::vector<Listening*> listening{};
};

std::string node_name(const RawChannel& raw) {
  return shown(raw.node) + (raw.place.empty() ? "" : " (" + shown(raw.place) + ")");
}

void remember(std::set<std::string>& names, const std::string& name) {
  if (names.size() < most_names) names.insert(name);
}

}  // namespace

struct RecordingSource::State {
  FileSystem* files = nullptr;
  std::string path;
  RecordingParts parts;
  std::vector<InputFacts> input_facts;
  std::vector<RecordingSurvey> surveys;  // by part
  SharedFile shared;
  std::shared_ptr<const StoredChunks> chunks;
  std::optional<RecordingFacts> facts;
  std::map<std::uint16_t, DeviceChannel> channels;
  std::vector<const DeviceChannel*> in_order;      // as they were defined
  std::map<std::string, SenderRoll> senders;       // by stream, without its nodes
  std::map<std::string, std::string> attachments;  // BVH headers, by name
  std::map<DeviceKey, Listening> listening;
  std::vector<JsonChannel> json;

  Duration utc_minus_host() const {
    if (!facts) return {};
    return facts->anchor.utc.time_since_epoch() - facts->anchor.raw.time_since_epoch();
  }
};

namespace {

/// Which streams are to be listened to, and in which variants.
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
  std::set<Variant> variants_of(const std::string& stream) const {
    if (variants_.empty()) return {Variant{}};
    const auto found = variants_.find(stream);
    return found == variants_.end() ? std::set<Variant>{} : found->second;
  }

 private:
  std::map<std::string, std::set<Variant>> variants_;
};

/// The first pass: indexes the files, surveys and hashes them, and listens to the devices.
class Scan {
 public:
  Scan(RecordingSource::State& state, std::optional<Wanted> wanted)
      : state_(state), wanted_(std::move(wanted)) {}

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

  /// After the last file.
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

  /// Each chunk names its channels again, and so does a summary, which may be damaged.
  void add(const McapChannel& defined) {
    const McapChannel* proved = proved_channel(state_.parts, defined.id);
    const McapChannel& channel = proved == nullptr ? defined : *proved;
    if (state_.channels.contains(channel.id)) return;
    add_json(defined);
    if (channel.topic == marks_topic) mark_channels_.insert(channel.id);
    const auto raw = to_raw(channel);
    if (!raw || mark_channels_.contains(channel.id)) {
      others_.insert(channel.id);
      return;
    }
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

  void listen_to(DeviceChannel& channel) {
    const RawChannel& raw = channel.raw;
    const std::string host = raw.node.empty() ? host_of(raw.sender) : "";
    for (const Variant& variant : wanted_->variants_of(raw.stream)) {
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

  void take_message(const McapMessage& message, const McapReader& reader) {
    const std::uint32_t place = place_of(reader);
    const bool counts = guard_.believes(message, reader.unchecked()) && state_.facts &&
                        message.log_time <= latest_log_time &&
                        !stands_elsewhere(state_.parts, part_, message);
    const auto found = state_.channels.find(message.channel);
    const bool is_device = found != state_.channels.end();
    const bool is_json = json_channels_.contains(message.channel);
    if (!counts || !(is_device || others_.contains(message.channel))) {
      chunk_.left_out.push_back(place);
      return;
    }
    if (is_device || is_json) note_channel(message.channel);
    if (mark_channels_.contains(message.channel)) take_mark(message);
    if (is_device) hear(found->second, message);
  }

  void hear(DeviceChannel& from, const McapMessage& message) {
    const auto log = Duration{static_cast<std::int64_t>(message.log_time)};
    const HostTime arrival{log - state_.utc_minus_host()};
    if (from.sender) state_.senders[from.raw.stream].hear(*from.sender, arrival);
    const std::uint32_t step = message.sequence - from.last_number.value_or(message.sequence - 1);
    from.last_number = message.sequence;
    if (step > 1 && step < 1U << 31U) from.missing += step - 1;
    for (Listening* one : from.listening) {
      one->take({&from.raw, from.id, arrival, message.data});
    }
  }

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

  /// The message's place in its chunk, of those that the reader yields.
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

  RecordingSource::State& state_;
  std::optional<Wanted> wanted_;  // absent: no device is listened to
  std::size_t part_ = 0;
  NumberGuard guard_;
  std::vector<StoredChunks::File> versions_;
  std::vector<StoredChunk> chunks_;
  StoredChunk chunk_;  // that messages come from
  bool is_in_chunk_ = false;
  std::uint32_t places_ = 0;
  std::map<std::uint16_t, McapSchema> schemas_;
  std::set<std::uint16_t> mark_channels_, json_channels_, others_;
  std::map<std::string, std::size_t> hosts_;  // by stream: how many
  std::uint64_t more_marks_ = 0;              // than are looked at
  std::optional<RecordingEnd> end_;
  bool ended_ = false;  // or torn for good
  bool is_closed_ = false;
};

/// The channels of a wish, and what its error needs.
struct Chosen {
  std::vector<const DeviceChannel*> channels;   // as they were defined
  std::optional<RawChannel> first;              // of payloads
  std::set<std::string> streams, nodes, meant;  // that are there; that the wish's node names
  DeviceChoice choice;                          // with what it left open

  std::vector<std::uint16_t> ids() const {
    std::vector<std::uint16_t> ids;
    for (const DeviceChannel* one : channels) ids.push_back(one->id);
    return ids;
  }
};

bool is_wanted(const RawChannel& raw, Chosen& chosen) {
  remember(chosen.streams, shown(raw.stream));
  DeviceChoice& choice = chosen.choice;
  if (raw.stream != choice.stream) return false;
  if (!raw.node.empty()) {  // a node may come from another address after a while
    remember(chosen.nodes, node_name(raw));
    if (choice.node.empty()) choice.node = raw.node;
    const bool is_meant =
        raw.node == choice.node || (!raw.place.empty() && raw.place == choice.node);
    if (is_meant) remember(chosen.meant, node_name(raw));
    return is_meant;
  }
  const std::string host = host_of(raw.sender);
  if (choice.sender.empty()) choice.sender = host;
  if (choice.passed_over.contains(raw.sender)) return false;
  return host == choice.sender || raw.sender == choice.sender;
}

/// Fails where the recording has no such device.
Result<Chosen> choose(const RecordingSource::State& state, const DeviceWish& wish) {
  const DeviceChoice& choice = wish.choice;
  const std::string& file = state.parts.back().path;
  Chosen chosen;
  chosen.choice = choice;
  for (const DeviceChannel* one : state.in_order) {
    if (!is_wanted(one->raw, chosen)) continue;
    chosen.channels.push_back(one);
    if (!chosen.first && one->raw.protocol != exchange_encoding) chosen.first = one->raw;
  }
  if (choice.node.empty() && chosen.nodes.size() > 1) {
    return Failure(Error{file, 0, fmt::format("one node of stream {}: select.node", choice.stream),
                         fmt::format("{}", fmt::join(chosen.nodes, ", "))});
  }
  if (chosen.meant.size() > 1) {
    return Failure(Error{
        file, 0,
        fmt::format("one node of stream {} that is called {}", choice.stream, shown(choice.node)),
        fmt::format("{}", fmt::join(chosen.meant, ", "))});
  }
  if (chosen.first) return chosen;
  if (chosen.streams.count(choice.stream) == 0) {
    return Failure(Error{
        file, 0,
        fmt::format("select.stream, or a stream's name, of {}",
                    chosen.streams.empty() ? "those recorded"
                                           : fmt::format("{}", fmt::join(chosen.streams, ", "))),
        chosen.streams.empty() ? "a recording in which nothing was heard"
                               : "'" + shown(choice.stream) + "'"});
  }
  const bool node = !chosen.nodes.empty();
  const auto roll = state.senders.find(choice.stream);
  const auto hosts =
      roll == state.senders.end() ? std::vector<std::string>{} : roll->second.hosts();
  return Failure(Error{file, 0,
                       fmt::format("of stream {} {}", choice.stream,
                                   node ? fmt::format("node {}", fmt::join(chosen.nodes, ", "))
                                        : fmt::format("select.sender {}", fmt::join(hosts, ", "))),
                       "'" + shown(node ? chosen.choice.node : chosen.choice.sender) + "'",
                       ErrorKind::no_rows_in_recording});
}

/// Goes once more over the messages of a device that the first pass did not listen to as a whole.
Result<std::unique_ptr<DeviceListener>> listen_again(const RecordingSource::State& state,
                                                     const Chosen& chosen, Variant variant) {
  Listening listening(variant);
  std::map<std::uint16_t, const RawChannel*> raw;
  for (const DeviceChannel* one : chosen.channels) {
    listening.define(one->id, one->raw);
    raw[one->id] = &one->raw;
  }
  MessagePass pass(state.chunks, chosen.ids());
  const auto take = [&](const ChunkMessage& message) -> Result<void> {
    const auto log = Duration{static_cast<std::int64_t>(message.log_time)};
    listening.take({raw[message.channel], message.channel, HostTime{log - state.utc_minus_host()},
                    message.data});
    return {};
  };
  while (KA_TRY(pass.next_chunk(take))) {
  }
  return listening.release();
}

/// The listener of the first pass where it has heard the same channels, else that of another pass.
Result<std::unique_ptr<DeviceListener>> listener_of(RecordingSource::State& state,
                                                    const Chosen& chosen, Variant variant) {
  const RawChannel& first = *chosen.first;
  const DeviceKey key{first.stream, first.node, first.node.empty() ? host_of(first.sender) : "",
                      variant};
  const auto found = state.listening.find(key);
  const bool is_same = found != state.listening.end() && !found->second.is_released() &&
                       found->second.channels() == chosen.ids();
  if (is_same) return found->second.release();
  return listen_again(state, chosen, variant);
}

struct Heard {
  std::shared_ptr<const HeardDevice> device;
  std::unique_ptr<DeviceListener> listener;
  DeviceProtocol protocol;
};

/// Fails where no rows could be made of the device.
Result<Heard> hear(RecordingSource::State& state, const Chosen& chosen, const DeviceWish& wish) {
  const DeviceProtocol protocol = KA_TRY(protocol_of(*chosen.first, wish));
  HeardDevice heard;
  heard.channel = *chosen.first;
  const auto attached = state.attachments.find(wish.choice.stream + ".bvh");
  if (attached != state.attachments.end()) heard.skeleton = attached->second;
  if (!wish.skeleton.empty()) heard.skeleton = wish.skeleton;
  heard.utc_minus_host = state.utc_minus_host();
  auto listener = KA_TRY(listener_of(state, chosen, {wish.trackers, wish.body}));
  KA_TRY(listener->finish(wish, heard));
  return Heard{std::make_shared<const HeardDevice>(std::move(heard)), std::move(listener),
               protocol};
}

/// That messages between others are missing.
Findings judge_missing(const RecordingSource::State& state, const Chosen& chosen) {
  std::uint64_t missing = 0;
  for (const DeviceChannel* one : chosen.channels) missing += one->missing;
  if (missing == 0) return {};
  return {{Severity::warning,
           Error{state.parts.back().path, 0, "every message that reached the recorder",
                 fmt::format("{} of {} missing between others", missing, chosen.choice.stream)},
           "damage in the file, or a recording that went on in another part", ""}};
}

/// Reads as far as the header needs; to the end where there are no rows, which may have a reason.
template <class Frames>
Result<typename DevicePass<Frames>::Header> header_of(const DevicePasses<Frames>& passes,
                                                      bool any_rows) {
  DevicePass<Frames> pass = passes();
  Frames block;
  while (pass.header() == nullptr || !any_rows) {
    if (!KA_TRY(pass.next(block))) break;
  }
  return *pass.header();
}

Result<DeviceStream> stream_of(const RecordingSource::State& state, const Chosen& chosen,
                               const DeviceWish& wish, Heard heard) {
  DeviceStream out;
  auto stamps = std::make_shared<std::vector<Time>>();
  heard.listener->stamp_rows(*heard.device, [&](Time stamp) { stamps->push_back(stamp); });
  heard.listener.reset();
  StampSurveyor surveyor;
  surveyor.add(*stamps);
  out.survey = surveyor.result();
  out.stamps = stamps;
  out.clock = heard.device->clock.time;
  out.findings = judge_missing(state, chosen);
  append(out.findings, heard.device->findings);
  out.skeleton_path = wish.skeleton.empty() ? "" : wish.options.skeleton;

  std::map<std::uint16_t, RawChannel> channels;
  for (const DeviceChannel* one : chosen.channels) channels[one->id] = one->raw;
  const auto shared =
      std::make_shared<const std::map<std::uint16_t, RawChannel>>(std::move(channels));
  AnyDeviceRows any = heard.protocol.rows(wish, heard.device);
  KA_TRY(std::visit(
      [&]<class Frames>(std::unique_ptr<DeviceRows<Frames>>&) -> Result<void> {
        const DevicePasses<Frames> passes = [chunks = state.chunks, ids = chosen.ids(), shared,
                                             wish, device = heard.device,
                                             protocol = heard.protocol] {
          auto rows = protocol.rows(wish, device);
          return DevicePass<Frames>(MessagePass(chunks, ids), shared, device->utc_minus_host,
                                    std::get<std::unique_ptr<DeviceRows<Frames>>>(std::move(rows)));
        };
        out.header = KA_TRY(header_of(passes, !stamps->empty()));
        out.passes = passes;
        return {};
      },
      any));
  return out;
}

}  // namespace

template <class Frames>
Result<bool> DevicePass<Frames>::next(Frames& block) {
  block = {};
  while (block.size() == 0 && !ended_) {
    const auto take = [&](const ChunkMessage& message) {
      const auto log = Duration{static_cast<std::int64_t>(message.log_time)};
      return rows_->take({&channels_->at(message.channel), message.channel,
                          HostTime{log - utc_minus_host_}, message.data},
                         block);
    };
    if (KA_TRY(messages_.next_chunk(take))) continue;
    ended_ = true;
    KA_TRY(rows_->finish(block));
  }
  return block.size() > 0;
}
template class DevicePass<ClipFrames>;
template class DevicePass<PointFrames>;
template class DevicePass<ImuSamples>;

RecordingSource::RecordingSource(std::unique_ptr<State> state) : state_(std::move(state)) {}
RecordingSource::~RecordingSource() = default;

Result<std::shared_ptr<RecordingSource>> RecordingSource::open(
    FileSystem& files, const std::string& path, Devices devices,
    const std::vector<StreamOptions>& wanted, const Progress& progress) {
  auto state = std::make_unique<State>();
  state->files = &files;
  state->path = path;
  state->parts = KA_TRY(parts_from(files, path, progress));
  Scan scan(*state,
            devices == Devices::heard ? std::optional(Wanted(wanted)) : std::optional<Wanted>());
  for (std::size_t part = 0; part < state->parts.size(); ++part) KA_TRY(scan.read(part, progress));
  scan.finish();
  append(state->shared.findings, judge_parts(state->parts, PartsBehind::read));
  append(state->shared.findings, judge_namesakes(files, state->parts.front().path));
  return std::shared_ptr<RecordingSource>(new RecordingSource(std::move(state)));
}

const std::string& RecordingSource::path() const { return state_->path; }
const RecordingParts& RecordingSource::parts() const { return state_->parts; }
const RecordingSurvey& RecordingSource::first_survey() const { return state_->surveys.front(); }
RecordingSurvey RecordingSource::survey() const {
  return join_surveys(state_->parts, state_->surveys);
}
const std::vector<InputFacts>& RecordingSource::facts() const { return state_->input_facts; }
SharedFile RecordingSource::shared() const { return state_->shared; }
const std::vector<JsonChannel>& RecordingSource::json_channels() const { return state_->json; }
MessagePass RecordingSource::messages_of(std::vector<std::uint16_t> channels) const {
  return {state_->chunks, std::move(channels)};
}

Result<DeviceStream> RecordingSource::stream(const StreamOptions& options, const StreamFile& file) {
  DeviceWish wish = KA_TRY(wish_of(options, file));
  if (!options.skeleton.empty()) {
    wish.skeleton = KA_TRY(read_bvh_head(*state_->files, options.skeleton));
  }
  if (!state_->facts) {
    return Failure(Error{state_->parts.back().path, 0, "a recording of kinalign's",
                         "an MCAP file of another program"});
  }
  const bool any_sender = wish.choice.sender.empty();
  KA_TRY(choose(*state_, wish).map_error([&](Error error) {
    return with_nodes(wish, survey(), std::move(error));
  }));
  const auto roll = state_->senders.find(wish.choice.stream);
  const SenderRoll senders = roll == state_->senders.end() ? SenderRoll() : roll->second;
  std::optional<Error> why;  // no rows came of the busiest one
  for (const DeviceChoice& choice : choices(wish.choice, senders)) {
    wish.choice = choice;
    const Chosen chosen = KA_TRY(choose(*state_, wish));
    auto heard = hear(*state_, chosen, wish);
    if (!heard) {
      if (!why) why = with_senders(heard.error(), choice.sender, senders);
      continue;
    }
    DeviceStream out = KA_TRY(stream_of(*state_, chosen, wish, *std::move(heard)));
    append(out.findings, judge_senders(wish, any_sender, senders));
    return out;
  }
  return Failure(*why);
}

}  // namespace kinalign
