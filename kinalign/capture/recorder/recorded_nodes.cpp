// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/recorder/recorded_nodes.h"

#include "kinalign/capture/net/port_error.h"
#include "kinalign/protocols/protocols.h"
#include "kinalign/wire/little_endian_reader.h"

#include <utility>

namespace kinalign {

namespace {

constexpr std::size_t most_nodes = 256;  // each node uses two channels

/// Without keys, any sender can use any number of node ids. Nodes that were not admitted get no
/// channel, because such senders could use up all channels.
bool is_limited(NodeVerdict verdict) {
  return verdict == NodeVerdict::limited || verdict == NodeVerdict::no_room ||
         verdict == NodeVerdict::wrong_counter || verdict == NodeVerdict::unknown_answer;
}

/// Number of datagrams that the kernel's filter would drop, if the system had one.
std::uint64_t no_frames(const NodeCounts& counts) {
  return counts.refusals[NodeRefusal::too_short] + counts.refusals[NodeRefusal::bad_magic] +
         counts.refusals[NodeRefusal::wrong_length];
}

}  // namespace

Result<std::unique_ptr<RecordedNodes>> RecordedNodes::open(const DeviceOptions& device,
                                                           const NodeResponderOptions& responder,
                                                           ClockReader& clocks,
                                                           Recorder& recorder) {
  NodeReceiverOptions options;
  if (!device.address.empty()) options.addresses = {device.address};
  options.port = static_cast<std::uint16_t>(device.port);
  options.responder = responder;
  NodeReceiver receiver = KA_TRY(with_name(device.name, NodeReceiver::open(options, clocks)));
  return std::unique_ptr<RecordedNodes>(
      new RecordedNodes(device, responder.lab_key.has_value(), std::move(receiver), recorder));
}

RecordedNodes::RecordedNodes(DeviceOptions device, bool keyed, NodeReceiver receiver,
                             Recorder& recorder)
    : device_(std::move(device)),
      keyed_(keyed),
      receiver_(std::move(receiver)),
      recorder_(recorder) {
  receiver_.watch([this](const NodeArrival& arrival, const NodeMessage& message, LiveClock*) {
    take(arrival, message);
  });
}

// The raw bytes are recorded for every node that has a channel.
void RecordedNodes::take(const NodeArrival& arrival, const NodeMessage& message) {
  const bool has_room = nodes_.size() < most_nodes && (keyed_ || !is_limited(message.verdict));
  if (!has_room && !nodes_.contains(message.node_id)) {
    ++without_channel_;
    return;
  }
  Node& node = node_of(message.node_id, arrival.from);
  // The exchange is recorded before the raw datagram. Both have the same arrival.
  std::optional<std::uint64_t> device_ns;
  if (message.exchange) {
    device_ns = static_cast<std::uint64_t>(message.exchange->n_tx.time_since_epoch().count());
    recorder_.record(node.exchanges, arrival.h_rx, to_bytes({receiver_.epoch(), *message.exchange}),
                     device_ns);
  }
  if (message.clockless) {
    recorder_.record(node.exchanges, arrival.h_rx,
                     to_bytes({receiver_.epoch(), *message.clockless}));
  }
  bytes_ += arrival.bytes.size();
  judge(node, message);
  node.raw.record(recorder_, arrival.h_rx, text_of(arrival.bytes), device_ns);
}

// Each node has two channels: raw datagrams, and clock exchanges.
RecordedNodes::Node& RecordedNodes::node_of(std::uint32_t id, const NodeAddress& from) {
  const auto found = nodes_.find(id);
  if (found != nodes_.end()) return found->second;
  // The topic contains the node's id. lab.toml may give no place for the node.
  const std::string number = std::to_string(id);
  const auto place = device_.nodes.find(number);
  const RawChannel raw{device_.name,
                       std::string(row_of(Protocol::nodes).recorded_name),
                       std::string(name_of(Transport::udp)),
                       endpoint_text(to_string(from.host), from.port),
                       number,
                       place == device_.nodes.end() ? "" : place->second};
  const std::string topic = "/" + device_.name + "/" + number;
  McapChannel exchanges = to_channel(topic + "/exchange", raw);
  exchanges.message_encoding = exchange_encoding;
  const std::uint16_t channel = recorder_.add_channel(std::move(exchanges));
  return nodes_.emplace(id, Node{RecordedSource(recorder_, topic + "/raw", raw), channel})
      .first->second;
}

/// Counts a datagram by its verdict. A held datagram counts only as a message. It may belong to the
/// node's next session, or it may be a replayed recording.
void RecordedNodes::judge(Node& node, const NodeMessage& message) {
  SenderCounts& counts = node.raw.status.counts;
  switch (message.verdict) {
    case NodeVerdict::accepted:
      break;
    case NodeVerdict::held:
      return;
    case NodeVerdict::duplicate:
      ++counts.order.duplicates;
      return;
    case NodeVerdict::replayed:
    case NodeVerdict::earlier_session:
      ++counts.order.late;
      return;
    default:
      ++counts.refused;
      return;
  }
  ++counts.frames;
  node.raw.status.samples += message.readings.size();
  if (!message.exchange) return;
  const BootKey before = std::exchange(node.boot, message.exchange->boot);
  // The first frame is not a restart, although its boot differs from the initial 0.
  if (before != node.boot && counts.frames > 1) ++counts.order.restarts;
  if (message.late) ++counts.order.late;
}

void RecordedNodes::look(HostTime now) {
  count_lost();
  for (auto& [id, node] : nodes_) node.raw.take_rate(now);
}

/// Reports datagrams that are not frames of nodes, for example those of another device. They are
/// not recorded, so the user must be told during the take.
///
/// Frames lost at a full buffer are subtracted. Such a loss is noticed only when the node's next
/// frame arrives. Therefore the number of dropped datagrams of one second ago is used.
void RecordedNodes::find_foreign() {
  PortCounts counts = this->counts();
  counts.dropped = std::exchange(dropped_, counts.dropped);
  std::uint64_t lost = 0;
  for (const auto& [id, node] : nodes_) lost += node.raw.status.counts.order.lost;
  const std::uint64_t came = foreign_datagrams(counts, lost);
  if (!are_many(came)) return;
  findings_.add("",
                {Severity::warning,
                 Error{device_.name, 0, "only frames of nodes at port " + std::to_string(port()),
                       std::to_string(came) + " other datagrams"},
                 "they are dropped and not recorded",
                 "check the port and the protocol that each device sends to"});
}

// One node may have several streams of the receiver. `before` contains the losses of earlier
// sessions.
void RecordedNodes::count_lost() {
  for (const NodeStatus& status : receiver_.status()) {
    const auto found = nodes_.find(status.node_id);
    if (found == nodes_.end()) continue;
    Lost& lost = found->second.lost[status.stream];
    // The receiver counts only the losses of the present session. When a new session begins, the
    // losses so far are added to `before`.
    if (std::exchange(lost.sessions, status.sessions) != status.sessions) {
      lost.before += lost.present;
    }
    lost.present = status.lost;
    StreamStatus& stream = found->second.raw.status;
    if (status.battery_mv) stream.battery_volts = 1e-3 * *status.battery_mv;
  }
  for (auto& [id, node] : nodes_) {
    std::uint64_t& lost = node.raw.status.counts.order.lost;
    // The sum is computed anew each time, because losses may shrink when late frames arrive.
    lost = 0;
    for (const auto& [stream, of_one] : node.lost) lost += of_one.before + of_one.present;
  }
}

// If the system has the kernel filter, foreign datagrams do not arrive. They count as dropped with
// or without the filter.
PortCounts RecordedNodes::counts() const {
  const NodeCounts& counts = receiver_.counts();
  PortCounts out;
  out.pieces = counts.verdicts.total() - no_frames(counts);
  out.bytes = bytes_;
  out.refused = counts.verdicts[NodeVerdict::refused] - no_frames(counts) +
                receiver_.not_unicast() + receiver_.from_port_0() + without_channel_;
  out.dropped = receiver_.dropped() + no_frames(counts);
  out.sifted = true;
  return out;
}

void RecordedNodes::add_streams(std::vector<StreamStatus>& all) {
  count_lost();
  for (const auto& [id, node] : nodes_) all.push_back(node.raw.status);
}

}  // namespace kinalign
