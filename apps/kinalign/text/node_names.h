// SPDX-License-Identifier: Apache-2.0
// What people read for a node: its device and where it is worn, else its id. What they type, and
// programs read, is the id, or "imu/7" as topics begin.
#pragma once

#include "kinalign/recording/survey.h"
#include "kinalign/take/lab.h"

#include <cstdint>
#include <map>
#include <string>

namespace kinalign {

/// "imu waist", "imu 7"; of a sender that is no node "mocap".
std::string sender_name(const std::string& stream, const std::string& node,
                        const std::string& place);

/// Likewise, the place as a recording has it.
std::string sender_name(const std::string& stream, const std::string& node,
                        const RecordingSurvey& survey);
/// "mocap from 192.168.7.5:51234", "imu waist from 192.168.7.21:4000"
std::string name_of(const CountedSender& sender, const RecordingSurvey& survey);

struct NodeNames {
  std::string device = "node";                  // where no lab says what they are
  std::map<std::string, std::string> places{};  // by id

  /// "waist", "7".
  std::string short_name(std::uint32_t id) const;
  /// "imu waist", "imu 7"
  std::string name(std::uint32_t id) const { return device + " " + short_name(id); }
};

/// Of a lab's nodes.
NodeNames node_names(const Lab& lab);

}  // namespace kinalign
