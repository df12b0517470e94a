// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/streams/recording_source.h"

#include "kinalign/formats/bvh/head.h"
#include "kinalign/protocols/protocols.h"
#include "kinalign/recording/streams/senders.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

namespace kinalign {

namespace {

constexpr std::size_t most_names = 32;  // limit on streams or nodes in one message

/// The functions for the device's protocol. Fails if the protocol does not fit the selection.
Result<DeviceProtocol> maker_of(const RawChannel& channel, const DeviceRequest& request) {
  const std::string& file = request.file.path;
  const auto protocol = protocol_of(channel);
  // If no protocol uses the skeleton, the manifest has a mistake.
  if (!request.skeleton.empty() && !(protocol && row_of(*protocol).needs_skeleton)) {
    return Failure(Error{file, 0, "a skeleton only for a noitom stream",
                         "a skeleton for " + shown(channel.stream) + ", whose protocol is " +
                             shown(channel.protocol)});
  }
  if (const auto known = rows_of(protocol, request.trackers)) return *known;
  if (request.trackers) {
    return Failure(Error{file, 0, "trackers only of an xsens stream",
                         shown(channel.stream) + ", of " + shown(channel.protocol)});
  }
  std::string known;
  for (const Protocol one :
       {Protocol::nodes, Protocol::kinect, Protocol::noitom, Protocol::xsens, Protocol::slimevr}) {
    known += (known.empty() ? "" : ", ") + std::string(row_of(one).recorded_name);
  }
  return Failure(Error{file, 0,
                       "stream " + shown(channel.stream) + " of one of the protocols " + known,
                       "'" + shown(channel.protocol) + "', which can't be aligned yet",
                       ErrorKind::no_rows_in_recording});
}

std::string node_name(const RawChannel& raw) {
  return shown(raw.node) + (raw.place.empty() ? "" : " (" + shown(raw.place) + ")");
}

/// One message shows the names, so a limited number is kept.
void remember(std::set<std::string>& names, const std::string& name) {
  if (names.size() < most_names) names.insert(name);
}

/// The channels of the wanted device, and names for an error. One pass over the channels collects
/// both, because the error lists devices that were not chosen.
struct Chosen {
  std::vector<const DeviceChannel*> channels;  // in the order of definition
  std::optional<RawChannel> first;             // the first channel with the device's data
  // The names of all streams, of all nodes, and of the nodes that fit the selection.
  std::set<std::string> streams, nodes, meant;
  DeviceChoice choice;  // the selection, including values that were filled in

  std::vector<std::uint16_t> ids() const {
    std::vector<std::uint16_t> ids;
    for (const DeviceChannel* one : channels) ids.push_back(one->id);
    return ids;
  }
};

/// True if the channel fits the choice. If node or host are left open, the first fitting channel
/// decides them. A selected node may be given by id or by place.
bool is_wanted(const RawChannel& raw, Chosen& chosen) {
  remember(chosen.streams, shown(raw.stream));
  DeviceChoice& choice = chosen.choice;
  if (raw.stream != choice.stream) return false;
  if (!raw.node.empty()) {  // a node may change its address
    remember(chosen.nodes, node_name(raw));
    if (choice.node.empty()) choice.node = raw.node;
    const bool is_meant =
        raw.node == choice.node || (!raw.place.empty() && raw.place == choice.node);
    if (is_meant) remember(chosen.meant, node_name(raw));
    return is_meant;
  }
  const std::string host = host_of(raw.sender);
  if (choice.sender.empty()) choice.sender = host;
  if (choice.left_out.contains(raw.sender)) return false;
  return host == choice.sender || raw.sender == choice.sender;
}

/// Fails if the recording has no such device.
Result<Chosen> choose(const ScannedRecording& state, const DeviceRequest& request) {
  const DeviceChoice& choice = request.choice;
  const std::string& file = state.parts.back().path;
  Chosen chosen;
  chosen.choice = choice;
  for (const DeviceChannel* one : state.in_order) {
    if (!is_wanted(one->raw, chosen)) continue;
    chosen.channels.push_back(one);
    if (!chosen.first && one->raw.protocol != exchange_encoding) chosen.first = one->raw;
  }
  // If a stream has several nodes, the user must select one.
  if (choice.node.empty() && chosen.nodes.size() > 1) {
    return Failure(Error{file, 0, fmt::format("one node of stream {}: select.node", choice.stream),
                         fmt::format("{}", fmt::join(chosen.nodes, ", "))});
  }
  // During a recording, two nodes may have had the same place.
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
        fmt::format("select.stream (or the stream's name) to be one of {}",
                    chosen.streams.empty() ? "those recorded"
                                           : fmt::format("{}", fmt::join(chosen.streams, ", "))),
        chosen.streams.empty() ? "a recording without data of a device"
                               : "'" + shown(choice.stream) + "'"});
  }
  // The stream exists, but this node or sender does not. The error lists the existing ones.
  const bool node = !chosen.nodes.empty();
  const auto table = state.senders.find(choice.stream);
  const auto hosts =
      table == state.senders.end() ? std::vector<std::string>{} : table->second.hosts();
  return Failure(Error{file, 0,
                       fmt::format("of stream {} {}", choice.stream,
                                   node ? fmt::format("node {}", fmt::join(chosen.nodes, ", "))
                                        : fmt::format("select.sender {}", fmt::join(hosts, ", "))),
                       "'" + shown(node ? chosen.choice.node : chosen.choice.sender) + "'",
                       ErrorKind::no_rows_in_recording});
}

/// Reports the progress. Fails if the user pressed Ctrl-C.
Result<void> report_chunk(const Progress& progress, const MessagePass& pass) {
  if (go_on(progress, "reading again", pass.done(), pass.all())) return {};
  return Failure(interruption());
}

/// The listener of the first pass if it took exactly these channels. Otherwise a new listener reads
/// the device's messages again.
Result<std::unique_ptr<DeviceListener>> listener_of(ScannedRecording& state, const Chosen& chosen,
                                                    const DeviceProtocol& protocol,
                                                    ListenVariant variant,
                                                    const Progress& progress) {
  const auto found = state.listening.find(key_of(*chosen.first, variant));
  // A listener can be used only once, because finish() moves its data away.
  const bool is_same = found != state.listening.end() && found->second.listener &&
                       found->second.channels == chosen.ids();
  if (is_same) return std::move(found->second.listener);
  auto listener = protocol.listen(variant.body);
  MessagePass pass(state.chunks, chosen.ids());
  const auto take = [&](const ChunkMessage& message) -> Result<void> {
    listener->take({&state.channels.at(message.channel).raw, message.channel,
                    arrival_of(message.log_time, state.survey.facts->utc_minus_host()),
                    message.data});
    return {};
  };
  while (KA_TRY(pass.next_chunk(take))) KA_TRY(report_chunk(progress, pass));
  return listener;
}

/// A device whose clock is known, so that rows can be made.
struct ReadyDevice {
  std::shared_ptr<const LearnedDevice> device;
  std::unique_ptr<DeviceListener> listener;
  DeviceProtocol protocol;
};

/// Learns the clock of the chosen device. Fails if the device gives no rows.
Result<ReadyDevice> learn(ScannedRecording& state, const Chosen& chosen,
                          const DeviceRequest& request, const Progress& progress) {
  const DeviceProtocol protocol = KA_TRY(maker_of(*chosen.first, request));
  LearnedDevice learned;
  learned.channel = *chosen.first;
  const auto attached = state.attachments.find(request.choice.stream + ".bvh");
  if (attached != state.attachments.end()) learned.skeleton = attached->second;
  // A skeleton in the manifest replaces the recording's own skeleton.
  if (!request.skeleton.empty()) learned.skeleton = request.skeleton;
  learned.utc_minus_host = state.survey.facts->utc_minus_host();
  auto listener =
      KA_TRY(listener_of(state, chosen, protocol, {request.trackers, request.body}, progress));
  KA_TRY(listener->finish(request, learned));
  return ReadyDevice{std::make_shared<const LearnedDevice>(std::move(learned)), std::move(listener),
                     protocol};
}

/// Adds a finding if numbers are missing between the device's messages.
Findings judge_missing(const ScannedRecording& state, const Chosen& chosen) {
  std::uint64_t missing = 0;
  for (const DeviceChannel* one : chosen.channels) missing += one->missing;
  if (missing == 0) return {};
  return {{Severity::warning,
           Error{state.parts.back().path, 0, "every message that reached the recorder",
                 fmt::format("{} messages of {} missing", missing, chosen.choice.stream)},
           "the file is damaged, or the recording continues in a part that was not found", ""}};
}

/// Adds a finding if stamps do not rise. After a restart of the device's clock, delayed samples can
/// have earlier times than the samples before them.
Findings judge_order(const std::string& file, const DeviceStream& stream) {
  StampSurveyor on_axis;
  for (const Time stamp : *stream.stamps) {
    const Time at = take_time(stream.clock, stamp);
    on_axis.add({&at, 1});
  }
  const std::uint64_t rising = on_axis.result().kept();
  // The survey counts stamps that rise on the device's own clock. If fewer rise on the take's axis,
  // some are out of order.
  if (rising >= stream.survey.kept()) return {};
  return {
      {Severity::warning,
       Error{file, 0, "samples with rising times",
             fmt::format("{} that step back", stream.survey.kept() - rising)},
       "align leaves these samples out",
       "check whether the device restarted, or the recording computer slept, while samples were "
       "still on the network"}};
}

/// The header of the rows. It reads until the header is known. If there are no rows, it reads to
/// the end, because an error there may explain why.
template <class Frames>
Result<typename DevicePass<Frames>::Header> header_of(const DevicePasses<Frames>& passes,
                                                      bool any_rows, const Progress& progress) {
  DevicePass<Frames> pass = passes();
  Frames block;
  while (pass.header() == nullptr || !any_rows) {
    if (!KA_TRY(pass.next(block, progress))) break;
  }
  return *pass.header();
}

// Makes the stream of a device. The stamps are computed here, so that the memory of the listener is
// free before rows are made.
Result<DeviceStream> stream_of(const ScannedRecording& state, const Chosen& chosen,
                               const DeviceRequest& request, ReadyDevice ready,
                               const Progress& progress) {
  DeviceStream out;
  // The listener gives the stamps of all rows in their order without making rows.
  auto stamps = std::make_shared<std::vector<Time>>();
  ready.listener->stamp_rows(*ready.device, [&](Time stamp) { stamps->push_back(stamp); });
  ready.listener.reset();
  StampSurveyor surveyor;
  surveyor.add(*stamps);
  out.survey = surveyor.result();
  out.stamps = stamps;
  out.clock = ready.device->clock.time;
  out.findings = judge_missing(state, chosen);
  append(out.findings, judge_order(request.file.path, out));
  append(out.findings, ready.device->findings);

  // All passes share the channels, which must exist longer than this function.
  std::map<std::uint16_t, RawChannel> channels;
  for (const DeviceChannel* one : chosen.channels) channels[one->id] = one->raw;
  const auto shared =
      std::make_shared<const std::map<std::uint16_t, RawChannel>>(std::move(channels));
  // This object only shows the kind of frames that the protocol makes. Each pass makes its own
  // object.
  AnyDeviceRows any = ready.protocol.rows(request, ready.device);
  KA_TRY(std::visit(
      [&]<class Frames>(std::unique_ptr<DeviceRows<Frames>>&) -> Result<void> {
        const DevicePasses<Frames> passes = [chunks = state.chunks, ids = chosen.ids(), shared,
                                             request, device = ready.device,
                                             protocol = ready.protocol] {
          auto rows = protocol.rows(request, device);
          return DevicePass<Frames>(MessagePass(chunks, ids), shared, device->utc_minus_host,
                                    std::get<std::unique_ptr<DeviceRows<Frames>>>(std::move(rows)));
        };
        out.header = KA_TRY(header_of(passes, !stamps->empty(), progress));
        out.passes = passes;
        return {};
      },
      any));
  return out;
}

}  // namespace

// A chunk may complete no row, so chunks are read until there is a row.
template <class Frames>
Result<bool> DevicePass<Frames>::next(Frames& block, const Progress& progress) {
  block = {};
  while (block.size() == 0 && !ended_) {
    const auto take = [&](const ChunkMessage& message) {
      return rows_->take({&channels_->at(message.channel), message.channel,
                          arrival_of(message.log_time, utc_minus_host_), message.data},
                         block);
    };
    if (KA_TRY(messages_.next_chunk(take))) {
      KA_TRY(report_chunk(progress, messages_));
      continue;
    }
    ended_ = true;
    KA_TRY(rows_->finish(block));
  }
  return block.size() > 0;
}
template class DevicePass<ClipFrames>;
template class DevicePass<PointFrames>;
template class DevicePass<ImuSamples>;

Result<std::shared_ptr<RecordingSource>> RecordingSource::open(
    FileSystem& files, const std::string& path, Devices devices,
    const std::vector<StreamOptions>& wanted, const Progress& progress) {
  const auto* listen_to = devices == Devices::learned ? &wanted : nullptr;
  return std::shared_ptr<RecordingSource>(
      new RecordingSource(KA_TRY(scan_recording(files, path, listen_to, progress))));
}

Result<DeviceStream> RecordingSource::stream(const StreamOptions& options, const StreamFile& file,
                                             const Progress& progress) {
  DeviceRequest request = KA_TRY(request_of(options, file));
  // The file of the skeleton is read only once, so that all passes use the same skeleton.
  if (!options.skeleton.empty()) {
    request.skeleton = KA_TRY(read_bvh_head(*state_.files, options.skeleton));
  }
  if (!state_.survey.facts) {
    return Failure(Error{state_.parts.back().path, 0, "a recording of kinalign's",
                         "an MCAP file of another program"});
  }
  const bool any_sender = request.choice.sender.empty();
  const SenderTable& senders = state_.senders[request.choice.stream];
  // The sender with the most messages must be known before the channels are chosen.
  senders.complete(request.choice);
  const Chosen chosen = KA_TRY(choose(state_, request).map_error([&](Error error) {
    return with_nodes(request, survey(), std::move(error));
  }));
  ReadyDevice ready = KA_TRY(learn(state_, chosen, request, progress).map_error([&](Error error) {
    return with_senders(std::move(error), request.choice.sender, senders);
  }));
  DeviceStream out = KA_TRY(stream_of(state_, chosen, request, std::move(ready), progress));
  // Findings about senders come last, because they assume that the chosen sender gave rows.
  append(out.findings, judge_senders(request, any_sender, senders));
  return out;
}

}  // namespace kinalign
