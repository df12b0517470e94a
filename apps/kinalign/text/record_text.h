// SPDX-License-Identifier: Apache-2.0
// Texts of the verb `record` about a lab: lines for people, members of JSON objects for programs.
// The functions only compute text.
#pragma once

#include "kinalign/capture/recorder/lab_status.h"
#include "kinalign/check/recording_words.h"
#include "kinalign/take/lab.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// A sender is silent if nothing came from it for this time. The table, the lines and the JSON all
/// use this limit.
inline constexpr Duration silent_after = std::chrono::seconds(2);

bool is_silent(const StreamStatus& stream, HostTime now);

/// The status of the stream's node; nullptr if the stream has no node. If two nodes have the same
/// id, the status is that of the node that sent last.
const NodeStatus* node_of(const StreamStatus& stream, const std::vector<NodeStatus>& nodes);

/// The clock of a node, or of a sender that exchanges pings. Empty if the sender has no clock or
/// nothing is known about it yet.
std::optional<SenderClock> clock_of(const StreamStatus& stream, const NodeStatus* node);

/// The names of the device's nodes with places that have sent nothing. If nothing came from the
/// whole device, the device's name.
std::vector<std::string> unseen(const DeviceOptions& device, const LabStatus& status);
/// A line for each name from unseen(): "kinect: no device has connected to port 7201 yet", or at
/// the end of the recording "kinect: nothing came".
std::vector<std::string> unseen_lines(const Lab& lab, const LabStatus& status);

/// The required devices and nodes with places that do not send now, such as "mocap", "imu waist".
/// At the end of a take: those from which nothing came.
std::vector<std::string> missing(const Lab& lab, const LabStatus& status);

/// Keeps the newest one if a device has connected several times from one port.
std::vector<StreamStatus> newest_of_each(const std::vector<StreamStatus>& streams);

double megabytes(std::uint64_t bytes);

/// The name of a stream: "mocap", "imu waist", "imu 7".
std::string name_of(const StreamStatus& stream);

/// A sender's counts: "7,500 messages, 11.1 MB; 3 lost, 1 late". Counts that are 0 are left out.
std::string counts_text(const SenderCounts& counts);
/// A line at the end of a recording: "  mocap from 192.168.7.5:51234: 7,500 messages, 11.1 MB; 3
/// lost".
std::string end_line(const StreamStatus& stream);
/// A line about losses at a port: "  port of mocap: 12 dropped by the kernel". Empty if nothing was
/// lost.
std::string port_line(const std::string& name, const PortCounts& counts, std::uint64_t frames_lost);

/// The JSON about a stream. If its node or sender has a clock, the clock is part of it.
nlohmann::ordered_json json_of(const StreamStatus& stream, const LabStatus& status);

}  // namespace kinalign
