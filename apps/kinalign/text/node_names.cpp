// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/node_names.h"

#include "kinalign/protocols/protocols.h"

#include <algorithm>

namespace kinalign {

std::string NodeNames::short_name(std::uint32_t id) const {
  const std::string number = std::to_string(id);
  const auto place = places.find(number);
  return place == places.end() ? number : place->second;
}

NodeNames node_names(const Lab& lab) {
  const auto nodes =
      // A lab has at most one device of inertial nodes; all nodes of the lab belong to it.
      std::find_if(lab.devices.begin(), lab.devices.end(), [](const DeviceOptions& device) {
        const auto protocol = find_protocol(device.protocol);
        return protocol && row_of(*protocol).has_node_ids;
      });
  return nodes == lab.devices.end() ? NodeNames{} : NodeNames{nodes->name, nodes->nodes};
}

}  // namespace kinalign
