// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/streams/device_rows.h"

#include "kinalign/core/numbers.h"
#include "kinalign/protocols/protocols.h"

namespace kinalign {

namespace {

/// The functions that make rows from a protocol's poses, points or inertial samples.
DeviceProtocol functions_of(Protocol protocol) {
  switch (protocol) {
    case Protocol::nodes:
      return node_protocol();
    case Protocol::noitom:
      return noitom_protocol();
    case Protocol::xsens:
      return xsens_protocol();
    case Protocol::kinect:
      return kinect_protocol();
    // This case ends the switch, so that every path of the function returns a value.
    case Protocol::slimevr:
      break;
  }
  return slimevr_protocol();
}

/// The value of a key in `select`; `otherwise` if the user did not give the key.
std::string selected(const StreamOptions& options, const char* key, const std::string& otherwise) {
  const auto found = options.select.find(key);
  return found == options.select.end() ? otherwise : found->second;
}

/// Splits a tracker's name into address and sensor: "10.0.0.21/1" gives "10.0.0.21" and "1". Other
/// names are returned unchanged with an empty sensor.
std::pair<std::string, std::string> tracker_of(const std::string& node) {
  const auto slash = node.rfind('/');
  const bool has_sensor = slash != std::string::npos && slash + 1 < node.size() &&
                          node.find_first_not_of("0123456789", slash + 1) == std::string::npos;
  if (!has_sensor) return {node, ""};
  return {node.substr(0, slash), node.substr(slash + 1)};
}

}  // namespace

std::optional<DeviceProtocol> rows_of(std::optional<Protocol> protocol, bool trackers) {
  if (!protocol) return std::nullopt;
  // Some protocols also transport the samples of inertial trackers in the same stream.
  if (!trackers) return functions_of(*protocol);
  return row_of(*protocol).has_trackers ? std::optional(xsens_tracker_protocol()) : std::nullopt;
}

Result<DeviceRequest> request_of(const StreamOptions& options, const StreamFile& file) {
  // An unknown key would be ignored without notice, so it is refused.
  for (const auto& [name, value] : options.select) {
    if (name == "stream" || name == "node" || name == "sender" || name == "body") continue;
    if (name == "kind" && (value == "poses" || value == "trackers")) continue;
    return Failure(Error{file.path, 0,
                         "select by stream, node, sender, body or kind (poses, trackers)",
                         shown(name) + " = " + shown(value)});
  }
  DeviceRequest request{options, file, {}};
  request.trackers = selected(options, "kind", "poses") == "trackers";
  request.choice = {selected(options, "stream", options.name), selected(options, "node", file.node),
                    selected(options, "sender", "")};
  // A tracker's name begins with its address, so the address also selects the sender.
  const auto [tracker, sensor] = tracker_of(request.choice.node);
  if (request.choice.sender.empty()) request.choice.sender = tracker;
  const std::string body = selected(options, "body", sensor);
  if (body.empty()) return request;
  std::uint64_t id = 0;
  if (parse_integer(body, id)) {
    request.body = id;
    return request;
  }
  return Failure(Error{file.path, 0, "select.body: a whole number", "'" + shown(body) + "'"});
}

}  // namespace kinalign
