// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record_text.h"

#include "apps/kinalign/json_text.h"
#include "apps/kinalign/node_text.h"
#include "apps/kinalign/summary.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

/// A sender in whose place another is heard is shown for so long.
constexpr Duration forgotten_after = std::chrono::seconds(30);

double megabytes(std::uint64_t bytes) { return static_cast<double>(bytes) / 1e6; }

bool is_silent(const StreamStatus& stream, HostTime now) {
  return now - stream.heard >= silent_after;
}

/// The node's present stream: of two nodes of one id the one that was heard last.
const NodeStatus* node_of(const StreamStatus& stream, const std::vector<NodeStatus>& nodes) {
  const NodeStatus* found = nullptr;
  for (const NodeStatus& node : nodes) {
    if (std::to_string(node.node_id) != stream.node) continue;
    if (found == nullptr || node.heard > found->heard) found = &node;
  }
  return found;
}

/// Host minus node, and half the certified interval: "-1000.0031 s ± 1.04 ms".
std::string clock_cell(const NodeStatus* node) {
  if (node == nullptr || !node->n || !node->stamp) return "";
  const ClockStamp& stamp = *node->stamp;
  if (stamp.certainty != Certainty::certified) return "not locked";
  const Duration offset = stamp.time.time_since_epoch() - node->n->time_since_epoch();
  return fmt::format("{:.4f} s ± {:.2f} ms", seconds(offset),
                     1e3 * seconds(*stamp.latest - *stamp.earliest) / 2);
}

std::string rate_cell(const StreamStatus& stream, double nominal_hz) {
  const std::string rate = fmt::format("{:.1f}", stream.rate_hz);
  return nominal_hz > 0 ? fmt::format("{} of {:g}", rate, nominal_hz) : rate;
}

std::string row(const std::array<std::string, 10>& cells) {
  std::string line = fmt::format("{:<18} {:>12} {:>7} {:>5} {:>5} {:>8} {:>22} {:>7} {:>7}  {}",
                                 cells[0], cells[1], cells[2], cells[3], cells[4], cells[5],
                                 cells[6], cells[7], cells[8], cells[9]);
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

/// Whether another sender of the same device is heard: a program that was started again has
/// another port. Nodes stand each for itself.
bool is_replaced(const StreamStatus& stream, const LabStatus& status) {
  return stream.node.empty() &&
         std::any_of(status.streams.begin(), status.streams.end(), [&](const StreamStatus& other) {
           return other.stream == stream.stream && !is_silent(other, status.now);
         });
}

std::string stream_row(const StreamStatus& stream, const DeviceOptions& device,
                       const LabStatus& status) {
  const NodeStatus* node = node_of(stream, status.nodes);
  const SequenceCounts& order = stream.counts.order;
  return row({name_of(stream), rate_cell(stream, nominal_rate_hz(device)), grouped(order.lost),
              grouped(order.late), grouped(order.duplicates),
              fmt::format("{:.1f} s", seconds(status.now - stream.heard)), clock_cell(node),
              node != nullptr && node->n ? fmt::format("{:+.1f}", 1e6 * node->drift) : "",
              stream.battery_volts ? fmt::format("{:.2f} V", *stream.battery_volts) : "",
              fmt::format("{:.1f} MB  {} {}", megabytes(stream.counts.bytes), device.transport,
                          stream.sender)});
}

/// Its nodes that have places and that were never heard.
std::vector<std::string> unheard_nodes(const DeviceOptions& device, const LabStatus& status) {
  std::vector<std::string> names;
  for (const auto& node : device.nodes) {  // clang 14 can't hand a structured binding on
    const bool heard =
        std::any_of(status.streams.begin(), status.streams.end(), [&](const StreamStatus& stream) {
          return stream.stream == device.name && stream.node == node.first;
        });
    if (!heard) names.push_back(device.name + " " + node.second);
  }
  return names;
}

bool is_heard(const DeviceOptions& device, const LabStatus& status) {
  return std::any_of(status.streams.begin(), status.streams.end(),
                     [&](const StreamStatus& stream) { return stream.stream == device.name; });
}

/// Its unheard nodes; or itself, where nothing at all came.
std::vector<std::string> unheard_of(const DeviceOptions& device, const LabStatus& status) {
  std::vector<std::string> names = unheard_nodes(device, status);
  if (names.empty() && !is_heard(device, status)) names.push_back(device.name);
  return names;
}

/// "1,234 dropped by the kernel"; empty: nothing.
std::string loss_of(const PortCounts& counts) {
  std::string text;
  for (const auto& [count, what] :
       {std::pair(counts.dropped, counts.sifted ? "thrown away: no frames of nodes, or no room"
                                                : "dropped by the kernel"),
        std::pair(counts.refused, "refused, not recorded"), std::pair(counts.cut, "cut"),
        std::pair(counts.unsent, "answers not sent")}) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", grouped(count), what);
  }
  return text;
}

std::string port_loss(const std::string& device, const LabStatus& status) {
  const auto port = std::find_if(status.ports.begin(), status.ports.end(),
                                 [&](const auto& one) { return one.first == device; });
  return port == status.ports.end() ? "" : loss_of(port->second);
}

}  // namespace

std::string name_of(const StreamStatus& stream) {
  if (stream.node.empty()) return stream.stream;
  return stream.stream + " " + (stream.place.empty() ? stream.node : stream.place);
}

std::vector<std::string> unheard(const Lab& lab, const LabStatus& status) {
  std::vector<std::string> all;
  for (const DeviceOptions& device : lab.devices) {
    const auto of_one = unheard_of(device, status);
    all.insert(all.end(), of_one.begin(), of_one.end());
  }
  return all;
}

std::vector<TableLine> lab_table(const Lab& lab, const LabStatus& status) {
  std::vector<TableLine> lines{{row({"device", "rate/s", "lost", "late", "twice", "heard", "clock",
                                     "ppm", "battery", "recorded"}),
                                false}};
  for (const DeviceOptions& device : lab.devices) {
    for (const StreamStatus& stream : status.streams) {
      if (stream.stream != device.name) continue;
      const bool silent = is_silent(stream, status.now);
      const bool replaced = silent && is_replaced(stream, status);
      if (replaced && status.now - stream.heard >= forgotten_after) continue;
      lines.push_back({stream_row(stream, device, status), device.required && silent && !replaced});
    }
    for (const std::string& name : unheard_of(device, status)) {
      lines.push_back(
          {fmt::format("{:<18} nothing yet, {:.0f} s", name, seconds(status.now - status.begun)),
           device.required});
    }
    if (const std::string lost = port_loss(device.name, status); !lost.empty()) {
      lines.push_back({fmt::format("{:<18} {}", device.name, lost), true});
    }
  }
  return lines;
}

std::vector<std::string> missing(const Lab& lab, const LabStatus& status) {
  std::vector<std::string> names;
  for (const DeviceOptions& device : lab.devices) {
    if (!device.required) continue;
    bool alive = false;
    for (const StreamStatus& stream : status.streams) {
      if (stream.stream != device.name) continue;
      const bool silent = is_silent(stream, status.now);
      alive = alive || !silent;
      if (silent && !stream.place.empty()) names.push_back(name_of(stream));
    }
    const auto unheard = unheard_nodes(device, status);
    names.insert(names.end(), unheard.begin(), unheard.end());
    if (!alive && device.nodes.empty()) names.push_back(device.name);
  }
  return names;
}

std::vector<StreamStatus> newest_of_each(const std::vector<StreamStatus>& streams) {
  std::vector<StreamStatus> newest;
  for (const StreamStatus& stream : streams) {
    const auto same = std::find_if(newest.begin(), newest.end(), [&](const StreamStatus& other) {
      return other.stream == stream.stream && other.sender == stream.sender &&
             other.node == stream.node;
    });
    if (same == newest.end()) {
      newest.push_back(stream);
    } else if (same->heard < stream.heard) {
      *same = stream;
    }
  }
  return newest;
}

std::string end_line(const StreamStatus& stream) {
  const SenderCounts& counts = stream.counts;
  std::string line = fmt::format("  {} from {}: {} messages, {:.1f} MB", name_of(stream),
                                 stream.sender, grouped(counts.messages), megabytes(counts.bytes));
  std::string_view between = "; ";
  for (const auto& [count, what] :
       {std::pair(counts.order.lost, "lost"), std::pair(counts.order.late, "late"),
        std::pair(counts.order.duplicates, "twice"), std::pair(counts.refused, "refused")}) {
    if (count == 0) continue;
    line += fmt::format("{}{} {}", between, grouped(count), what);
    between = ", ";
  }
  return line + "\n";
}

std::string port_line(const std::string& name, const PortCounts& counts) {
  const std::string text = loss_of(counts);
  return text.empty() ? "" : fmt::format("  port of {}: {}\n", name, text);
}

std::string json_of(const StreamStatus& stream, const LabStatus& status) {
  Json json = Json::parse(to_json(stream.stream, stream.sender, stream.node, stream.counts));
  if (!stream.place.empty()) json["place"] = stream.place;
  json["rate_hz"] = stream.rate_hz;
  json["silent_s"] = seconds(status.now - stream.heard);
  if (stream.battery_volts) json["battery_v"] = *stream.battery_volts;
  const NodeStatus* node = node_of(stream, status.nodes);
  if (node == nullptr) return json_text(json);
  Json clock = Json::parse(status_json(*node));
  for (const char* said_above :
       {"event", "stream", "node_id", "address", "accepted", "lost", "rate_hz", "battery_mv"}) {
    clock.erase(said_above);
  }
  json["clock"] = clock;
  return json_text(json);
}

}  // namespace kinalign
