// SPDX-License-Identifier: Apache-2.0
// The names of nodes for people: the device and the place where the node is worn, else its id.
// Users type, and programs read, the id, or "imu/7" as in topics.
#pragma once

#include "kinalign/take/lab.h"

#include <cstdint>
#include <map>
#include <string>

namespace kinalign {

/// The names of one device's nodes. A node without a place is called by its id.
struct NodeNames {
  std::string device = "node";                  // the name if there is no lab file
  std::map<std::string, std::string> places{};  // by id: "7" gives "waist"

  /// "waist", "7".
  std::string short_name(std::uint32_t id) const;
  /// "imu waist", "imu 7"
  std::string name(std::uint32_t id) const { return device + " " + short_name(id); }
};

/// The names of a lab's nodes.
NodeNames node_names(const Lab& lab);

}  // namespace kinalign
