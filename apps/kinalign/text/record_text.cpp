// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/record_text.h"

#include "apps/kinalign/text/node_names.h"
#include "apps/kinalign/text/node_text.h"
#include "apps/kinalign/text/summary.h"

#include "kinalign/capture/net/followed_clock.h"
#include "kinalign/protocols/protocols.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

/// The names of those nodes in lab.toml that have never sent. Each element of device.nodes is the
/// id and the place of a node; a stream states the id.
std::vector<std::string> unseen_nodes(const DeviceOptions& device, const LabStatus& status) {
  std::vector<std::string> names;
  for (const auto& node : device.nodes) {  // clang 14 can't capture a structured binding
    const bool seen =
        std::any_of(status.streams.begin(), status.streams.end(), [&](const StreamStatus& stream) {
          return stream.stream == device.name && stream.node == node.first;
        });
    if (!seen) names.push_back(sender_name(device.name, node.first, node.second));
  }
  return names;
}

bool is_seen(const DeviceOptions& device, const LabStatus& status) {
  return std::any_of(status.streams.begin(), status.streams.end(),
                     [&](const StreamStatus& stream) { return stream.stream == device.name; });
}

PortCounts counts_of(const DeviceOptions& device, const LabStatus& status) {
  const auto found = std::find_if(status.ports.begin(), status.ports.end(),
                                  [&](const auto& one) { return one.first == device.name; });
  return found == status.ports.end() ? PortCounts() : found->second;
}

/// The text about a device from which no data has come yet.
std::string nothing_yet(const DeviceOptions& device, const PortCounts& counts, std::uint16_t port) {
  // `links` counts TCP connections, so it is 0 for UDP.
  const bool linked = counts.links > 0;
  const auto transport = find_transport(device.transport);
  if (transport == Transport::tcp) {
    return fmt::format("{} {}:{} yet", linked ? "nothing has come from" : "no connection to",
                       device.address, port);
  }
  // With this transport the device connects to the recorder; the device may not be switched on.
  if (transport == Transport::tcp_listen && !linked) {
    return fmt::format("no device has connected to port {} yet", port);
  }
  return fmt::format("nothing has come to port {} yet", port);
}

}  // namespace

double megabytes(std::uint64_t bytes) { return static_cast<double>(bytes) / 1e6; }

bool is_silent(const StreamStatus& stream, HostTime now) {
  return now - stream.last_arrival >= silent_after;
}

const NodeStatus* node_of(const StreamStatus& stream, const std::vector<NodeStatus>& nodes) {
  const NodeStatus* found = nullptr;
  for (const NodeStatus& node : nodes) {
    if (std::to_string(node.node_id) != stream.node) continue;
    // Two nodes with the same id are recorded separately. The status is that of the node that sent
    // last.
    if (found == nullptr || node.last_arrival > found->last_arrival) found = &node;
  }
  return found;
}

// The node receiver knows the clock of a node. The stream itself has the clock of any other sender.
std::optional<SenderClock> clock_of(const StreamStatus& stream, const NodeStatus* node) {
  if (node == nullptr) return stream.clock;
  if (!node->n || !node->stamp) return std::nullopt;
  return sender_clock(*node->stamp, *node->n, node->drift);
}

std::vector<std::string> unseen(const DeviceOptions& device, const LabStatus& status) {
  std::vector<std::string> names = unseen_nodes(device, status);
  // If lab.toml names no nodes, the device's own name is listed instead.
  if (names.empty() && !is_seen(device, status)) names.push_back(device.name);
  return names;
}

std::string name_of(const StreamStatus& stream) {
  return sender_name(stream.stream, stream.node, stream.place);
}

std::vector<std::string> unseen_lines(const Lab& lab, const LabStatus& status) {
  std::vector<std::string> lines;
  for (const DeviceOptions& device : lab.devices) {
    const std::uint16_t port = status.port_numbers.at(device.name);
    const PortCounts counts = counts_of(device, status);
    std::string what;
    // unusable_data() concerns the whole port. It is the reason only if no sender of the device is
    // known.
    if (!is_seen(device, status)) what = unusable_data(counts, fmt::format("to port {}", port));
    if (what.empty()) what = status.ended ? "nothing came" : nothing_yet(device, counts, port);
    for (const std::string& name : unseen(device, status)) {
      lines.push_back(fmt::format("{}: {}", name, what));
    }
  }
  return lines;
}

/// A device is missing if none of its senders sends now. A node with a place is missing as soon as
/// this node is silent.
std::vector<std::string> missing(const Lab& lab, const LabStatus& status) {
  std::vector<std::string> names;
  for (const DeviceOptions& device : lab.devices) {
    if (!device.required) continue;
    const auto nodes = status.ended ? unseen(device, status) : unseen_nodes(device, status);
    names.insert(names.end(), nodes.begin(), nodes.end());
    if (status.ended) continue;
    bool sends = false;
    for (const StreamStatus& stream : status.streams) {
      if (stream.stream != device.name) continue;
      const bool silent = is_silent(stream, status.now);
      // A sender that restarts has another port and counts as another sender. One that sends is
      // enough.
      sends = sends || !silent;
      // Each node with a place is required.
      if (silent && !stream.place.empty()) names.push_back(name_of(stream));
    }
    // For a device whose nodes lab.toml names, the nodes are listed. Any other device is listed
    // itself.
    if (!sends && device.nodes.empty()) names.push_back(device.name);
  }
  return names;
}

std::vector<StreamStatus> newest_of_each(const std::vector<StreamStatus>& streams) {
  std::vector<StreamStatus> newest;
  for (const StreamStatus& stream : streams) {
    const auto same = std::find_if(newest.begin(), newest.end(), [&](const StreamStatus& other) {
      // A device that reconnects becomes a new sender with the same name.
      return other.stream == stream.stream && other.sender == stream.sender &&
             other.node == stream.node;
    });
    if (same == newest.end()) {
      newest.push_back(stream);
    } else if (same->last_arrival < stream.last_arrival) {
      *same = stream;
    }
  }
  return newest;
}

/// Counts that are 0 are left out.
std::string counts_text(const SenderCounts& counts) {
  std::string losses = counts_in_words({{counts.order.lost, "lost"},
                                        {counts.order.late, "late"},
                                        {counts.order.duplicates, "duplicate"},
                                        {counts.refused, "refused"}});
  if (const std::uint64_t restarts = counts.order.restarts) {
    losses += losses.empty() ? "restarted " : ", restarted ";
    losses += restarts == 1 ? "once" : grouped(restarts) + " times";
  }
  return fmt::format("{} messages, {:.1f} MB{}{}", grouped(counts.messages),
                     megabytes(counts.bytes), losses.empty() ? "" : "; ", losses);
}

std::string end_line(const StreamStatus& stream) {
  return fmt::format("  {} from {}: {}\n", name_of(stream), stream.sender,
                     counts_text(stream.counts));
}

std::string port_line(const std::string& name, const PortCounts& counts,
                      std::uint64_t frames_lost) {
  const std::string text = loss_of(counts, frames_lost);
  return text.empty() ? "" : fmt::format("  port of {}: {}\n", name, text);
}

/// The clock of a node comes from the node receiver. Members that the stream already states are
/// removed from it.
Json json_of(const StreamStatus& stream, const LabStatus& status) {
  Json json = Json::parse(
      // The object begins with the members that the recorder writes into the recording.
      to_json({stream.topic, stream.stream, stream.sender, stream.node, stream.counts}));
  if (!stream.place.empty()) json["place"] = stream.place;
  json["rate_hz"] = stream.rate_hz;
  json["silent_s"] = seconds(status.now - stream.last_arrival);
  if (stream.battery_volts) json["battery_v"] = *stream.battery_volts;
  const NodeStatus* node = node_of(stream, status.nodes);
  if (stream.clock) {
    json["clock"] = {{"host_minus_sender_ns", stream.clock->host_minus_sender.count()},
                     {"drift_ppm", 1e6 * stream.clock->drift}};
    if (const auto half = stream.clock->half_interval) {
      json["clock"]["half_interval_ms"] = 1e3 * seconds(*half);
    }
  }
  if (node == nullptr) return json;
  Json clock = Json::parse(status_json(*node));
  for (const char* in_stream :
       // The object already has these members, for the stream.
       {"event", "stream", "node_id", "address", "accepted", "lost", "rate_hz", "battery_mv"}) {
    clock.erase(in_stream);
  }
  json["clock"] = clock;
  return json;
}

}  // namespace kinalign
