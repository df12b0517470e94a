// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/recording_session.h"

#include "kinalign/io/little_endian_reader.h"

#include <algorithm>
#include <utility>

namespace kinalign {

namespace {

constexpr Duration between_looks = std::chrono::milliseconds(100);
constexpr std::size_t most_node_sources = 256;
constexpr std::uint64_t most_lives = 1000;  // of senders of a port: each takes a channel

RecordingHead head_of(RecordingFacts facts, const RecordingSession::Options& options, int part) {
  facts.part = part;
  RecordingHead head{
      {std::string(recording_profile), "kinalign " KINALIGN_VERSION}, {to_metadata(facts)}, {}};
  const auto utc = static_cast<std::uint64_t>(to_ns(facts.anchor.utc));
  if (!options.lab_toml.empty()) {
    head.attachments.push_back({utc, utc, "lab.toml", "application/toml", options.lab_toml});
  }
  for (const auto& [stream, bvh] : options.skeletons) {
    head.attachments.push_back({utc, utc, stream + ".bvh", "text/plain", bvh});
  }
  return head;
}

void count(StreamStatus& status, std::size_t bytes, HostTime arrival) {
  ++status.counts.messages;
  status.counts.bytes += bytes;
  status.heard = arrival;
}

}  // namespace

Result<std::unique_ptr<RecordingSession>> RecordingSession::open(Options options, Machine machine) {
  KA_TRY(validate(options.lab));
  std::unique_ptr<RecordingSession> session(new RecordingSession(std::move(options), machine));
  KA_TRY(session->open_ports());
  return session;
}

RecordingSession::RecordingSession(Options options, Machine machine)
    : options_(std::move(options)), machine_(machine), axis_(machine.ports_clock) {
  facts_.host = options_.host;
  facts_.anchor = axis_.watch();
  RecorderOptions recorder;
  recorder.pre_roll = Duration{static_cast<std::int64_t>(options_.lab.record.pre_roll_s * 1e9)};
  recorder.utc_minus_host =
      facts_.anchor.utc.time_since_epoch() - facts_.anchor.raw.time_since_epoch();
  recorder_ = std::make_unique<Recorder>(recorder);
  const McapSchema schema = clock_pair_schema();
  pairs_ = recorder_->add_channel({0, 0, "/clock/host", "json", {}}, &schema);
  const McapSchema counts = sender_counts_schema();
  counts_ = recorder_->add_channel({0, 0, "/counts", "json", {}}, &counts);
}

Result<void> RecordingSession::open_ports() {
  for (std::size_t i = 0; i < options_.lab.devices.size(); ++i) {
    const DeviceOptions& device = options_.lab.devices[i];
    const auto port = static_cast<std::uint16_t>(device.port);
    if (device.protocol == "nodes") {
      NodeReceiverOptions nodes;
      if (!device.address.empty()) nodes.addresses = {device.address};
      nodes.port = port;
      nodes.desk = options_.desk;
      nodes_.emplace(KA_TRY(NodeReceiver::open(nodes, machine_.nodes_clock)));
      nodes_device_ = i;
      nodes_->watch([this](const NodeArrival& arrival, const NodeNews& news, LiveClock&) {
        take_node(arrival, news);
      });
    } else if (device.transport == "udp") {
      ports_.push_back({i, KA_TRY(UdpPieces::open(device.address, port))});
    } else if (device.transport == "tcp") {
      ports_.push_back({i, KA_TRY(TcpPieces::connect(device.address, port))});
    } else {
      ports_.push_back({i, KA_TRY(TcpPieces::listen(device.address, port))});
    }
  }
  return {};
}

/// Only ports where something has come cost a call; connections are looked after with the clock.
void RecordingSession::turn(Duration patience) {
  fds_.clear();
  if (nodes_) fds_.push_back(nodes_->fd());
  for (Port& port : ports_) {
    port.fds_begin = fds_.size();
    std::visit([&](const auto& pieces) { pieces.add_fds(fds_); }, port.pieces);
    port.fds_end = fds_.size();
  }
  waiting_.clear();
  for (const int fd : fds_) waiting_.push_back({fd, POLLIN, 0});
  const auto ms = std::chrono::ceil<std::chrono::milliseconds>(patience).count();
  const bool some = ::poll(waiting_.data(), waiting_.size(), static_cast<int>(ms)) > 0;
  const HostTime now = axis_.now();
  const bool look_after = now >= next_look_;
  if (look_after) next_look_ = now + between_looks;
  if (look_after && nodes_) nodes_->tick();
  if (nodes_ && some && waiting_.front().revents != 0) nodes_->drain();
  for (Port& port : ports_) {
    const auto ready = [&](const pollfd& one) { return one.revents != 0; };
    const auto first = waiting_.begin();
    const bool has_some =
        some && std::any_of(first + static_cast<std::ptrdiff_t>(port.fds_begin),
                            first + static_cast<std::ptrdiff_t>(port.fds_end), ready);
    if (!has_some && !look_after) continue;
    const TakePiece take = [&](const Piece& piece) { take_piece(port, piece); };
    std::visit([&](auto& pieces) { pieces.drain(axis_, take); }, port.pieces);
  }
  tick(now);
}

RecordingSession::Source RecordingSession::new_source(const std::string& topic,
                                                      const RawChannel& raw) {
  Source source;
  source.status.stream = raw.stream;
  source.status.sender = raw.sender;
  source.status.node = raw.node;
  source.status.place = raw.place;
  source.watch = StreamWatch(raw.protocol);
  source.channel = recorder_->add_channel(to_channel(topic, raw));
  return source;
}

/// A new sender, or another in the place of one that fell silent, gets a channel of its own.
void RecordingSession::take_piece(Port& port, const Piece& piece) {
  const DeviceOptions& device = options_.lab.devices[port.device];
  const Senders::Sender& sender = std::visit(
      [&](const auto& pieces) -> const Senders::Sender& {
        return pieces.senders().at(piece.sender);
      },
      port.pieces);
  if (sender.life > most_lives) return;
  if (port.sources.size() <= piece.sender) port.sources.resize(piece.sender + 1);
  Source& source = port.sources[piece.sender];
  if (source.life != sender.life) {
    const std::string number = sender.life == 1 ? "" : "/" + std::to_string(sender.life);
    source = new_source("/" + device.name + "/raw" + number,
                        {device.name, device.protocol, device.transport,
                         endpoint_text(to_string(sender.host), sender.port), "", ""});
    source.life = sender.life;
  }
  recorder_->record(source.channel, piece.arrival, piece.bytes);
  source.watch.feed(piece.bytes);
  count(source.status, piece.bytes.size(), piece.arrival);
}

RecordingSession::NodeSource& RecordingSession::node_source(std::uint32_t node_id,
                                                            const std::string& sender) {
  const auto found = node_sources_.find(node_id);
  if (found != node_sources_.end()) return found->second;
  const DeviceOptions& device = options_.lab.devices[nodes_device_];
  const std::string number = std::to_string(node_id);
  const std::string topic = "/" + device.name + "/" + number;
  const auto place = device.nodes.find(number);
  const RawChannel raw{device.name, "kinalign-node",
                       "udp",       sender,
                       number,      place == device.nodes.end() ? "" : place->second};
  NodeSource source;
  source.raw = new_source(topic + "/raw", raw);
  McapChannel exchanges = to_channel(topic + "/exchange", raw);
  exchanges.message_encoding = exchange_encoding;
  source.exchanges = recorder_->add_channel(std::move(exchanges));
  return node_sources_.emplace(node_id, std::move(source)).first->second;
}

void RecordingSession::take_node(const NodeArrival& arrival, const NodeNews& news) {
  const std::uint32_t id = nodes_->node_id(news.stream);
  if (node_sources_.size() >= most_node_sources && !node_sources_.contains(id)) return;
  NodeSource& source =
      node_source(id, endpoint_text(to_string(arrival.from.host), arrival.from.port));
  std::optional<std::uint64_t> device_ns;
  if (news.exchange) {
    device_ns = static_cast<std::uint64_t>(news.exchange->n_tx.time_since_epoch().count());
    recorder_->record(source.exchanges, arrival.h_rx, to_bytes({nodes_->epoch(), *news.exchange}),
                      device_ns);
  }
  recorder_->record(source.raw.channel, arrival.h_rx, text_of(arrival.bytes), device_ns);
  count(source.raw.status, arrival.bytes.size(), arrival.h_rx);
}

void RecordingSession::tick(HostTime now) {
  recorder_->tick(now);
  if (now < next_second_) return;
  constexpr Duration second = std::chrono::seconds(1);
  const double elapsed =
      next_second_ == HostTime::min() ? 1.0 : seconds(now - next_second_ + second);
  next_second_ = now + second;
  recorder_->record(pairs_, now, to_json(axis_.watch()));
  for (Port& port : ports_) {
    for (Source& source : port.sources) measure(source, elapsed, now);
  }
  for (auto& [id, source] : node_sources_) measure(source.raw, elapsed, now);
}

/// Once a second: the rate, and the counts into the file.
void RecordingSession::measure(Source& source, double elapsed_s, HostTime now) {
  SenderCounts& counts = source.status.counts;
  const std::uint64_t before = std::exchange(source.second_began, counts.messages);
  source.status.rate_hz = static_cast<double>(counts.messages - before) / elapsed_s;
  const SenderCounts watched = source.watch.counts();
  counts.frames = watched.frames;
  counts.order = watched.order;
  counts.refused = watched.refused;
  recorder_->record(counts_, now, to_json(source.status.stream, source.status.sender, counts));
}

Result<void> RecordingSession::start(const std::string& path, const std::string& subject,
                                     const std::string& action) {
  facts_.subject = subject;
  facts_.action = action;
  facts_.first = std::string(file_name(path));
  const auto compression =
      options_.lab.record.compression == "none" ? McapCompression::none : McapCompression::zstd;
  // Asked for on the disk's thread: it owns what it needs.
  auto head = [facts = facts_, options = options_](int part) {
    return head_of(facts, options, part);
  };
  RecordingDisk disk = KA_TRY(RecordingDisk::open(machine_.files, path, std::move(head)));
  disk_ = std::make_unique<DiskThread>(std::move(disk), compression);
  recorder_->start(axis_.now(), [this](McapChunkContent chunk) { disk_->push(std::move(chunk)); });
  return {};
}

void RecordingSession::stop() {
  if (!recording()) return;
  next_second_ = HostTime::min();  // the last counts, too
  tick(axis_.now());
  recorder_->stop();
  disk_->finish();
}

std::optional<DiskStatus> RecordingSession::disk() const {
  return disk_ ? std::optional(disk_->status()) : std::nullopt;
}

std::vector<PartFailure> RecordingSession::take_disk_failures() {
  return disk_ ? disk_->take_failures() : std::vector<PartFailure>();
}

std::vector<StreamStatus> RecordingSession::streams() const {
  std::vector<StreamStatus> all;
  for (const Port& port : ports_) {
    for (const Source& source : port.sources) all.push_back(source.status);
  }
  for (const auto& [id, source] : node_sources_) all.push_back(source.raw.status);
  return all;
}

std::vector<std::pair<std::string, std::uint16_t>> RecordingSession::ports() const {
  std::vector<std::pair<std::string, std::uint16_t>> all;
  for (const Port& port : ports_) {
    const std::uint16_t number =
        std::visit([](const auto& pieces) { return pieces.port(); }, port.pieces);
    all.emplace_back(options_.lab.devices[port.device].name, number);
  }
  if (nodes_) {
    all.emplace_back(options_.lab.devices[nodes_device_].name, nodes_->sockets().front().port());
  }
  return all;
}

std::vector<std::pair<std::string, PortCounts>> RecordingSession::port_counts() const {
  std::vector<std::pair<std::string, PortCounts>> all;
  for (const Port& port : ports_) {
    all.emplace_back(options_.lab.devices[port.device].name,
                     std::visit([](const auto& pieces) { return pieces.counts(); }, port.pieces));
  }
  return all;
}

}  // namespace kinalign
