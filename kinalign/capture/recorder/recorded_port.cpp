// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/recorder/recorded_port.h"

#include "kinalign/capture/net/port_error.h"
#include "kinalign/protocols/kinect/binary.h"
#include "kinalign/protocols/kinect/lines.h"
#include "kinalign/wire/little_endian_reader.h"

#include <utility>

namespace kinalign {

namespace {

std::string encoded(const KinectPong& pong, bool as_line) {
  if (as_line) return encode_kinect_line(pong);
  return std::string(text_of(encode_kinect_binary(pong)));
}

}  // namespace

Result<RecordedPort> RecordedPort::open(const DeviceOptions& device, const SipHashKey& secret) {
  const auto protocol = find_protocol(device.protocol);
  if (!protocol) return Failure(unknown_protocol(device.protocol));
  return RecordedPort(device, row_of(*protocol),
                      KA_TRY(with_name(device.name, open_pieces(device))), secret);
}

Result<RecordedPort::Pieces> RecordedPort::open_pieces(const DeviceOptions& device) {
  const auto port = static_cast<std::uint16_t>(device.port);
  const auto transport = find_transport(device.transport);
  if (!transport) return Failure(unknown_transport(device.transport));
  switch (*transport) {
    case Transport::udp:
      return Pieces(KA_TRY(UdpPieces::open(device.address, port)));
    case Transport::tcp:
      return Pieces(KA_TRY(TcpPieces::connect(device.address, port)));
    case Transport::tcp_listen:
      break;
  }
  return Pieces(KA_TRY(TcpPieces::listen(device.address, port)));
}

// A responder exists only if the protocol needs it.
RecordedPort::RecordedPort(DeviceOptions device, const ProtocolRow& protocol, Pieces pieces,
                           const SipHashKey& secret)
    : device_(std::move(device)), protocol_(&protocol), pieces_(std::move(pieces)) {
  switch (protocol.answers) {
    case Answers::kinect_pings:
      kinect_responder_ = std::make_unique<KinectResponder>(secret);
      break;
    case Answers::tracker_handshakes:
      slime_responder_ = std::make_unique<SlimeResponder>(secret);
      break;
    case Answers::node_requests:  // RecordedNodes answers node requests
    case Answers::none:
      break;
  }
}

void RecordedPort::add_fds(std::vector<int>& fds) const {
  std::visit([&](const auto& pieces) { pieces.add_fds(fds); }, pieces_);
}

void RecordedPort::drain(HostAxis& axis, Recorder& recorder) {
  const TakePiece to = [&](const Piece& piece) { take(piece, axis, recorder); };
  std::visit([&](auto& pieces) { pieces.drain(axis, to); }, pieces_);
}

/// Answers are sent before anything is recorded. Work before an answer would increase the delay in
/// one direction only.
void RecordedPort::take(const Piece& piece, HostAxis& axis, Recorder& recorder) {
  Source& source = source_of(piece, recorder);
  source.watch.feed(piece.bytes, piece.arrival, newest_frames_);
  if (kinect_responder_) answer_pings(source, piece, axis, recorder);
  if (slime_responder_) answer_trackers(source, piece);
  source.recorded.record(recorder, piece.arrival, piece.bytes);
}

/// A new sender gets a new channel, even if it takes the number of a silent sender.
RecordedPort::Source& RecordedPort::source_of(const Piece& piece, Recorder& recorder) {
  const std::size_t number = piece.sender;
  const Senders& senders =
      std::visit([](const auto& pieces) -> const Senders& { return pieces.senders(); }, pieces_);
  const Senders::Sender& sender = senders.at(number);
  const bool is_shared = sender.serial > Senders::most_serials;
  if (sources_.size() <= number) sources_.resize(number + 1);
  // The number is now shared by several senders, so they use the common source `others_`.
  if (is_shared) sources_[number].reset();
  std::optional<Source>& source = is_shared ? others_ : sources_[number];
  const NodeAddress address{sender.host, sender.port};
  if (source && source->serial == sender.serial) {
    source->address = address;
    return *source;
  }
  const RawChannel raw{device_.name,
                       std::string(protocol_->recorded_name),
                       device_.transport,
                       is_shared ? "" : endpoint_text(to_string(sender.host), sender.port),
                       "",
                       ""};
  // The old source of this number ends here. Its channel stays in the recording.
  source.emplace(Source{RecordedSource(recorder, topic("raw", sender.serial), raw), raw,
                        StreamWatch(protocol_->protocol, has_datagrams(), raw.sender),
                        sender.serial, address});
  return *source;
}

/// Returns "/kinect/raw" for the first sender of the port and "/kinect/raw/2" for the second.
std::string RecordedPort::topic(const char* content, std::uint64_t serial) const {
  const std::string first = "/" + device_.name + "/" + content;
  if (serial > Senders::most_serials) return first + "/others";
  return serial == 1 ? first : first + "/" + std::to_string(serial);
}

void RecordedPort::answer_pings(Source& source, const Piece& piece, HostAxis& axis,
                                Recorder& recorder) {
  // bytes; prevents amplification with forged addresses
  std::size_t may_send = piece.bytes.size();
  for (const KinectPing& ping : source.watch.pings()) {
    const auto exchange = kinect_responder_->receive(ping, source.address.host, piece.arrival);
    if (!exchange) {
      ++source.pings_refused;
      continue;
    }
    if (const auto pong = kinect_responder_->answer(axis.now())) {
      const std::string bytes = encoded(*pong, source.watch.speaks_lines());
      const bool forgeable = has_datagrams();
      if (!forgeable || bytes.size() <= may_send) {
        may_send -= forgeable ? bytes.size() : 0;
        std::visit([&](auto& pieces) { pieces.send(piece.sender, octets(bytes)); }, pieces_);
      }
    }
    // The exchange channel is added with the first ping, because some senders send no ping.
    if (!source.exchanges) {
      source.clock = std::make_unique<FollowedClock>();
      McapChannel channel = to_channel(topic("exchange", source.serial), source.raw);
      channel.message_encoding = exchange_encoding;
      source.exchanges = recorder.add_channel(std::move(channel));
    }
    source.clock->push(*exchange, axis.epoch());
    const std::int64_t sent_ns = exchange->n_tx.time_since_epoch().count();
    const auto device_ns =
        sent_ns < 0 ? std::nullopt : std::optional(static_cast<std::uint64_t>(sent_ns));
    recorder.record(*source.exchanges, piece.arrival, to_bytes({axis.epoch(), *exchange}),
                    device_ns);
  }
}

/// A tracker that sends a handshake starts new counts, even if another tracker had the address.
void RecordedPort::answer_trackers(Source& source, const Piece& piece) {
  look_at(source);
  const SlimeResult result =
      slime_responder_->receive({octets(piece.bytes), source.address, piece.arrival});
  ++source.verdicts[result.verdict];
  if (result.has_packet) ++source.tracker_packets;
  if (result.restarts_counts) source.counts_before_handshake = source.recorded.status.counts.order;
  send_answers();
}

// Heartbeats and pings are due without a request, so an answer may go to another address than that
// of the last datagram.
void RecordedPort::send_answers() {
  auto* udp = std::get_if<UdpPieces>(&pieces_);  // trackers use UDP only
  if (udp == nullptr) return;
  for (const SlimeSending& sending : slime_responder_->take_sendings()) {
    udp->send_to(sending.to.host, sending.to.port, sending.answer.datagram());
  }
}

// Only SlimeVR trackers expect messages without a request.
void RecordedPort::tick(HostTime now) {
  if (!slime_responder_) return;
  slime_responder_->tick(now);
  send_answers();
}

template <class Visit>
void RecordedPort::for_each_source(Visit visit) {
  for (auto& source : sources_) {
    if (source) visit(*source);
  }
  if (others_) visit(*others_);
}

void RecordedPort::look(HostTime now) {
  for_each_source([&](Source& source) {
    look_at(source);
    find_faults(source);
    source.recorded.take_rate(now);
  });
}

/// Updates the status of a sender, except its numbers of messages and bytes.
void RecordedPort::look_at(Source& source) const {
  SenderCounts& counts = source.recorded.status.counts;
  const SenderCounts watched = source.watch.counts();
  // SlimeResponder decodes trackers, and the watch decodes all other senders. The other number is
  // 0.
  counts.frames = watched.frames + source.tracker_packets;
  if (!slime_responder_) counts.order = watched.order;
  counts.refused = watched.refused + refused(source.verdicts) + source.pings_refused;
  if (source.clock) source.recorded.status.clock = source.clock->now();
  const SlimeDevice* tracker =
      slime_responder_ ? slime_responder_->device_at(source.address) : nullptr;
  // the tracker has another address now; the old address keeps its counts
  if (tracker == nullptr) return;
  counts.order = source.counts_before_handshake;
  counts.order += tracker->numbers.counts();
  if (tracker->battery_volts) source.recorded.status.battery_volts = *tracker->battery_volts;
}

/// Looks for faults of a sender, such as the compressed stream of Axis Studio. The user must be
/// told during the take. A host that reconnects is not reported again.
void RecordedPort::find_faults(const Source& source) {
  const SenderCounts& counts = source.recorded.status.counts;
  // A sender that sends only pings uses the right protocol.
  const bool none = !source.exchanges && speaks_another_protocol(protocol_->recorded_name, counts);
  if (counts.refused == 0 && !none && !source.watch.has_overlap()) return;
  const std::string host = to_string(source.address.host);
  const std::string name = device_.name + " from " + endpoint_text(host, source.address.port);
  Findings findings = source.watch.findings(name);
  append(findings, findings_of(source.verdicts, name));
  if (none) {
    findings.push_back({Severity::warning,
                        Error{name, 0, "frames of " + device_.protocol,
                              std::to_string(counts.messages) + " messages without such a frame"},
                        "all data is recorded, but it can't be aligned as " + device_.protocol,
                        std::string(advice_without_frames(device_.protocol))});
  }
  for (Finding& finding : findings) findings_.add(host, std::move(finding));
}

std::uint16_t RecordedPort::port() const {
  return std::visit([](const auto& pieces) { return pieces.port(); }, pieces_);
}

PortCounts RecordedPort::counts() const {
  return std::visit([](const auto& pieces) { return pieces.counts(); }, pieces_);
}

std::uint64_t RecordedPort::received() const {
  return std::visit([](const auto& pieces) { return pieces.received(); }, pieces_);
}

void RecordedPort::add_streams(std::vector<StreamStatus>& all) {
  for_each_source([&](Source& source) {
    look_at(source);
    all.push_back(source.recorded.status);
  });
}

}  // namespace kinalign
