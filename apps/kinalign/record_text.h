// SPDX-License-Identifier: Apache-2.0
// What `record` says of a lab: a table for people, members of JSON objects for programs. Pure.
#pragma once

#include "kinalign/capture/recording_session.h"

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

/// A line of the table; `bad` lines are of what is missing and required, and of what is lost.
struct TableLine {
  std::string text;
  bool bad = false;
};

/// Head and a line for each sender, each device of which nothing comes, and each port where
/// something was lost before it could be recorded.
std::vector<TableLine> lab_table(const Lab& lab, const LabStatus& status);

/// Devices, and nodes with places, of which nothing came.
std::vector<std::string> unheard(const Lab& lab, const LabStatus& status);

/// The required devices, and nodes that have places, of which nothing comes: "mocap", "imu waist".
std::vector<std::string> missing(const Lab& lab, const LabStatus& status);

/// Of connections that one device made one after another, from one port, the newest alone.
std::vector<StreamStatus> newest_of_each(const std::vector<StreamStatus>& streams);

/// "mocap", "imu waist", "imu 7".
std::string name_of(const StreamStatus& stream);

/// "mocap from 192.168.7.5:51234: 7,500 messages, 11.1 MB; 3 frames lost"
std::string end_line(const StreamStatus& stream);
/// "  port of mocap: 12 dropped by the kernel\n"; empty: nothing worth telling.
std::string port_line(const std::string& name, const PortCounts& counts);

/// The JSON of a stream, with its node's clock where it has one.
std::string json_of(const StreamStatus& stream, const LabStatus& status);

}  // namespace kinalign
