// SPDX-License-Identifier: Apache-2.0
// What `record` says of a lab: a table for people, members of JSON objects for programs. Pure.
#pragma once

#include "kinalign/capture/nodes/node_status.h"
#include "kinalign/capture/recorder/stream_status.h"
#include "kinalign/take/lab.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

/// A sender of whom nothing came for so long is silent.
inline constexpr Duration silent_after = std::chrono::seconds(2);

/// A lab at one moment.
struct LabStatus {
  HostTime now{}, begun{};  // begun: when its ports were opened
  std::vector<StreamStatus> streams;
  std::vector<NodeStatus> nodes;
  std::vector<std::pair<std::string, PortCounts>> ports{};  // by the device's name
};

bool is_silent(const StreamStatus& stream, HostTime now);

/// The node's present stream: of two nodes of one id the one that was heard last; nullptr: none.
const NodeStatus* node_of(const StreamStatus& stream, const std::vector<NodeStatus>& nodes);

/// Of a node or of a sender that pings; absent: it has none, or nothing is known of it yet.
std::optional<SenderClock> clock_of(const StreamStatus& stream, const NodeStatus* node);

/// "1,234 dropped by the kernel"; empty: nothing was lost. `frames_lost`: of all who send there, by
/// their own numbers.
std::string loss_of(const PortCounts& counts, std::uint64_t frames_lost);
/// The latter.
template <class Sender>
std::uint64_t frames_lost(const std::string& device, const std::vector<Sender>& senders) {
  std::uint64_t lost = 0;
  for (const Sender& sender : senders) {
    if (sender.stream == device) lost += sender.counts.order.lost;
  }
  return lost;
}

/// "181 datagrams came to port 6969, none a frame of nodes": of a port of nodes that no node was
/// heard on, though something came. Empty: nothing did. `to`: "to port 6969".
std::string unheard_but_came(const PortCounts& counts, const std::string& to);

using Ports = std::map<std::string, std::uint16_t>;  // by the device's name

/// Its nodes that have places and were never heard; or itself, where nothing at all came.
std::vector<std::string> unheard_of(const DeviceOptions& device, const LabStatus& status);

/// Devices, and nodes with places, of which nothing came in the present or last take.
std::vector<std::string> unheard_in_take(const Lab& lab, LabStatus status);
/// "kinect: nothing came": a line for each of them.
std::vector<std::string> end_lines_of_unheard(const Lab& lab, LabStatus status, const Ports& ports);

/// "kinect: nobody has connected to port 7201 yet": of each device that is heard on such a port and
/// that lacks, or of whose nodes one does.
std::vector<std::string> lines_of_unheard(const Lab& lab, const LabStatus& status,
                                          const Ports& ports);

/// The required devices, and nodes that have places, of which nothing comes: "mocap", "imu waist".
std::vector<std::string> missing(const Lab& lab, const LabStatus& status);

/// Of connections that one device made one after another, from one port, the newest alone.
std::vector<StreamStatus> newest_of_each(const std::vector<StreamStatus>& streams);

double megabytes(std::uint64_t bytes);

/// "mocap", "imu waist", "imu 7".
std::string name_of(const StreamStatus& stream);

/// "7,500 messages, 11.1 MB; 3 lost, 1 late"
std::string counts_text(const SenderCounts& counts);
/// "  mocap from 192.168.7.5:51234: 7,500 messages, 11.1 MB; 3 lost\n"; empty: nothing came.
std::string end_line(const StreamStatus& stream);
/// "  port of mocap: 12 dropped by the kernel\n"; empty: nothing worth telling.
std::string port_line(const std::string& name, const PortCounts& counts, std::uint64_t frames_lost);

/// A stream, with its node's clock where it has one.
nlohmann::ordered_json json_of(const StreamStatus& stream, const LabStatus& status);

}  // namespace kinalign
