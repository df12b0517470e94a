// SPDX-License-Identifier: Apache-2.0
// The text of `record` about a lab: a table for people, members of JSON objects for programs. Pure
// functions.
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

/// A sender is silent if nothing came from it for this time.
/// The table, the lines and the JSON use the same limit.
inline constexpr Duration silent_after = std::chrono::seconds(2);

bool is_silent(const StreamStatus& stream, HostTime now);

/// The node's status; of two nodes with one id, the one that sent last. nullptr if there is
/// none.
const NodeStatus* node_of(const StreamStatus& stream, const std::vector<NodeStatus>& nodes);

/// The clock of a node, or of a sender that pings. Absent if the sender has none, or nothing is
/// known of it yet.
std::optional<SenderClock> clock_of(const StreamStatus& stream, const NodeStatus* node);

/// The device's nodes that have places and sent nothing; the device itself if nothing came from it.
std::vector<std::string> unseen(const DeviceOptions& device, const LabStatus& status);
/// A line for each of them: "kinect: nobody has connected to port 7201 yet"; at the end "kinect:
/// nothing came".
std::vector<std::string> unseen_lines(const Lab& lab, const LabStatus& status);

/// The required devices, and their nodes with places, from which nothing comes now or, at the end
/// of a take, nothing came: "mocap", "imu waist".
std::vector<std::string> missing(const Lab& lab, const LabStatus& status);

/// Only the newest of several connections that one device made one after another from one port.
std::vector<StreamStatus> newest_of_each(const std::vector<StreamStatus>& streams);

double megabytes(std::uint64_t bytes);

/// "mocap", "imu waist", "imu 7".
std::string name_of(const StreamStatus& stream);

/// "7,500 messages, 11.1 MB; 3 lost, 1 late"
std::string counts_text(const SenderCounts& counts);
/// "  mocap from 192.168.7.5:51234: 7,500 messages, 11.1 MB; 3 lost
/// ".
std::string end_line(const StreamStatus& stream);
/// "  port of mocap: 12 dropped by the kernel
/// ". Empty if nothing was lost.
std::string port_line(const std::string& name, const PortCounts& counts, std::uint64_t frames_lost);

/// A stream, with the clock of its node or sender if it has one.
nlohmann::ordered_json json_of(const StreamStatus& stream, const LabStatus& status);

}  // namespace kinalign
