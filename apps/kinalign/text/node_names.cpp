// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/node_names.h"

#include "kinalign/protocols/protocols.h"

#include <algorithm>

namespace kinalign {

// A sender that is no node is called by its device.
std::string sender_name(const std::string& stream, const std::string& node,
                        const std::string& place) {
  if (node.empty()) return stream;
  return stream + " " + (place.empty() ? node : place);
}

std::string sender_name(const std::string& stream, const std::string& node,
                        const RecordingSurvey& survey) {
  // Places are found by "stream/node", as the recording states them.
  const auto place = survey.places.find(stream + "/" + node);
  return sender_name(stream, node, place == survey.places.end() ? "" : place->second);
}

std::string name_of(const CountedSender& sender, const RecordingSurvey& survey) {
  return sender_name(sender.stream, sender.node, survey) +
         (sender.sender.empty() ? "" : " from " + sender.sender);
}

std::string NodeNames::short_name(std::uint32_t id) const {
  const std::string number = std::to_string(id);
  const auto place = places.find(number);
  return place == places.end() ? number : place->second;
}

NodeNames node_names(const Lab& lab) {
  const auto nodes =
      // A lab has at most one device of nodes, which stands for all of them.
      std::find_if(lab.devices.begin(), lab.devices.end(), [](const DeviceOptions& device) {
        const auto protocol = find_protocol(device.protocol);
        return protocol && row_of(*protocol).has_node_ids;
      });
  return nodes == lab.devices.end() ? NodeNames{} : NodeNames{nodes->name, nodes->nodes};
}

}  // namespace kinalign
