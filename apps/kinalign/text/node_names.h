// SPDX-License-Identifier: Apache-2.0
// The names of nodes for people: the device and the place on the body, or the id if no place is
// known. In commands and in JSON a node is named by its id or by its topic, "imu/7".
#pragma once

#include "kinalign/take/lab.h"

#include <cstdint>
#include <map>
#include <string>

namespace kinalign {

/// The names of one device's nodes.
struct NodeNames {
  std::string device = "node";                  // "node" if there is no lab file
  std::map<std::string, std::string> places{};  // places by id: "7" gives "waist"

  /// The place, or the id of a node without a place: "waist", "7".
  std::string short_name(std::uint32_t id) const;
  /// The same with the device: "imu waist", "imu 7".
  std::string name(std::uint32_t id) const { return device + " " + short_name(id); }
};

/// The names of a lab's nodes.
NodeNames node_names(const Lab& lab);

}  // namespace kinalign
