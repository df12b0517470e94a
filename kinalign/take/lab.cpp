// SPDX-License-Identifier: Apache-2.0
#include "kinalign/take/lab.h"

#include "kinalign/core/numbers.h"
#include "kinalign/protocols/protocols.h"
#include "kinalign/take/manifest.h"

#include <arpa/inet.h>

#include <algorithm>
#include <map>

namespace kinalign {

namespace {

// Names that the recorder uses for its own ports and topics. No device may have such a name.
const std::vector<std::string> own_names{"marks", "trigger", "clock", "counts"};

bool is_one_of(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Port 0 is allowed: the system then chooses a free port.
Result<std::int64_t> parse_port(const std::string& text) {
  std::int64_t port = -1;
  if (parse_integer(text, port) && port >= 0 && port <= 65535) return port;
  return Failure(Error{"", 0, "a port from 0 to 65535", text.empty() ? "nothing" : shown(text)});
}

/// Returns the failure for an option of a device with an unexpected value.
Failure wrong(const DeviceOptions& device, std::string expected, std::string found) {
  return Failure(Error{device.name, 0, std::move(expected), std::move(found)});
}

/// Returns whether the text is an IPv4 or IPv6 address. An interface may follow after '%'; the
/// system checks the interface when the port is opened.
bool is_ip_address(const std::string& text) {
  in6_addr room{};
  return ::inet_pton(AF_INET, text.c_str(), &room) == 1 ||
         ::inet_pton(AF_INET6, text.substr(0, text.find('%')).c_str(), &room) == 1;
}

/// Returns whether this machine opens the connection. Otherwise it waits for the device.
bool connects(const DeviceOptions& device) {
  return find_transport(device.transport) == Transport::tcp;
}

/// Fails if neither the device nor this machine can open the connection.
Result<void> check_place(const DeviceOptions& device, const ProtocolRow& row) {
  const auto transport = find_transport(device.transport);
  // If the protocol needs another transport, no packet would arrive.
  if (transport && !may_come_over(row, *transport)) {
    return wrong(device,
                 "transport " + std::string(name_of(row.transports.front())) +
                     ", the only one of protocol " + device.protocol,
                 device.transport);
  }
  if (connects(device) && (device.address.empty() || device.port <= 0)) {
    return wrong(device, "an address and a port to connect to", "no address or no port");
  }
  if (!device.address.empty() && !is_ip_address(device.address)) {
    return wrong(device, "an IP address (getent hosts NAME shows the address of a host)",
                 shown(device.address));
  }
  if (device.port < 0) return wrong(device, "port to receive on (0: any free port)", "no port");
  return {};
}

/// Returns whether the address means every interface of this machine, IPv4 or IPv6.
bool is_every(const std::string& address) {
  return address.empty() || address == "0.0.0.0" || address == "::";
}

/// Fails if two devices have the same name or port, or if both are devices of nodes.
Result<void> check_pair(const DeviceOptions& device, const DeviceOptions& other) {
  if (other.name == device.name) {
    return wrong(device, "a different name for each device", device.name + " twice");
  }
  // All nodes together are one device; their ids distinguish them.
  const auto protocol = find_protocol(device.protocol);
  if (protocol && row_of(*protocol).has_node_ids && other.protocol == device.protocol) {
    return wrong(device, "one device for all nodes", "a second one, " + other.name);
  }
  const bool serves = !connects(device);  // a missing address means every address
  const bool same_place = other.address == device.address ||
                          (serves && (is_every(device.address) || is_every(other.address)));
  // Port 0 is never the same port. UDP and TCP may use the same number.
  const bool same_port = device.port != 0 && other.port == device.port &&
                         other.transport == device.transport && same_place;
  if (!same_port) return {};
  return wrong(device, "a port of its own", std::to_string(device.port) + ", as " + other.name);
}

bool is_number(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// Fails if two nodes have the same place, or if a place may be another node's id. Messages name a
/// node by its place, or by its id if it has no place. Nodes that are not listed may send too.
Result<void> check_places(const DeviceOptions& device) {
  std::map<std::string, std::string> ids;  // node id by place
  for (const auto& [id, place] : device.nodes) {
    const auto [other, is_new] = ids.emplace(place, id);
    if (!is_new) {
      return wrong(device, "a place of its own for each node",
                   shown(place) + " of nodes " + other->second + " and " + id);
    }
    // A place may be a number only if that number is the node's own id.
    if (place != id && is_number(place)) {
      return wrong(device, "the name of a place, such as waist: a number may be another node's id",
                   shown(place) + " of node " + id);
    }
  }
  return {};
}

/// Fails if an option of the device has no effect for its protocol.
Result<void> check_use(const DeviceOptions& device, const ProtocolRow& row) {
  if (!device.skeleton.empty() && !row.needs_skeleton) {
    return wrong(device, "skeleton only for protocol noitom", "protocol " + device.protocol);
  }
  if (!row.has_node_ids) {
    if (!device.lab_key.empty())
      return wrong(device, "lab_key only for protocol nodes", "protocol " + device.protocol);
    if (!device.nodes.empty())
      return wrong(device, "nodes only for protocol nodes", "protocol " + device.protocol);
  }
  for (const auto& [id, place] : device.nodes) {
    std::uint32_t number = 0;
    // Only the usual form of the number is accepted. Otherwise "07" and "7" would name one node
    // twice.
    if (!parse_integer(id, number) || std::to_string(number) != id) {
      return wrong(device, "a node's id, a whole number, as each key of nodes", shown(id));
    }
    if (place.empty()) return wrong(device, "the place of node " + id, "nothing");
  }
  return check_places(device);
}

/// Checks the name, which appears on terminals and in topics, and names the port.
Result<void> check_name(const DeviceOptions& device) {
  const bool harmless = std::none_of(device.name.begin(), device.name.end(),
                                     [](unsigned char c) { return c < ' ' || c == 0x7f; });
  if (harmless && !is_one_of(own_names, device.name)) return {};
  return Failure(Error{shown(device.name), 0,
                       "a name without control characters, and not marks, trigger, clock or counts",
                       shown(device.name)});
}

}  // namespace

/// An IPv6 address contains colons, so the port is parsed first, from the end.
Result<DeviceOptions> parse_device(const std::string& text) {
  const Failure unlike(Error{"", 0, "NAME=PROTOCOL:PORT, such as imu=nodes:5005", shown(text)});
  const auto equals = text.find('=');
  const auto last = text.rfind(':');
  if (equals == std::string::npos || last == std::string::npos || last < equals) return unlike;
  DeviceOptions device;
  device.name = text.substr(0, equals);
  device.port = KA_TRY(parse_port(text.substr(last + 1)));
  std::string middle =
      text.substr(equals + 1, last - equals - 1);  // PROTOCOL[:TRANSPORT[:ADDRESS]]
  const auto first = std::min(middle.find(':'), middle.size());
  device.protocol = middle.substr(0, first);
  if (!find_protocol(device.protocol)) return Failure(unknown_protocol(device.protocol));
  if (first < middle.size()) {
    middle = middle.substr(first + 1);
    const auto second = std::min(middle.find(':'), middle.size());
    device.transport = middle.substr(0, second);
    if (!find_transport(device.transport)) return Failure(unknown_transport(device.transport));
    if (second < middle.size()) device.address = middle.substr(second + 1);
  }
  return device;
}

void set_device(Lab& lab, const DeviceOptions& stated) {
  const auto known =
      std::find_if(lab.devices.begin(), lab.devices.end(),
                   [&](const DeviceOptions& device) { return device.name == stated.name; });
  if (known == lab.devices.end()) {
    lab.devices.push_back(stated);
    return;
  }
  known->protocol = stated.protocol;
  known->transport = stated.transport;
  known->address = stated.address;
  known->port = stated.port;
}

Result<void> validate(const Lab& lab) {
  // Each device is compared only with earlier devices, so a pair of devices gives one error.
  for (std::size_t i = 0; i < lab.devices.size(); ++i) {
    const DeviceOptions& device = lab.devices[i];
    KA_TRY(check_stream_name(device.name));
    KA_TRY(check_name(device));
    const auto protocol = find_protocol(device.protocol);
    if (!protocol) return wrong(device, "a protocol", "none");
    KA_TRY(check_use(device, row_of(*protocol)));
    KA_TRY(check_place(device, row_of(*protocol)));
    for (std::size_t k = 0; k < i; ++k) KA_TRY(check_pair(device, lab.devices[k]));
  }
  return {};
}

double nominal_rate_hz(const DeviceOptions& device) {
  if (device.rate_hz > 0.0) return device.rate_hz;
  const auto protocol = find_protocol(device.protocol);
  return protocol ? row_of(*protocol).usual_rate_hz : 0.0;
}

/// All options are listed here once. Flags, TOML and help are made from this list.
Fields describe(DeviceOptions& o) {
  return {
      {"protocol", "protocol of the device", &o.protocol, -unlimited, unlimited, protocol_names()},
      {"transport", "udp; tcp: we connect to the device; tcp-listen: it connects to us",
       &o.transport, -unlimited, unlimited, transport_names()},
      {"address",
       "transport tcp: address of the device; others: address of this machine to receive on "
       "(default: all)",
       &o.address},
      {"port", "transport tcp: port of the device; others: port to receive on", &o.port, 0.0,
       65535.0},
      {"skeleton", "protocol noitom: a BVH file with the header that the stream does not contain",
       &o.skeleton},
      {"rate_hz", "nominal rate; 0: the usual rate of the protocol", &o.rate_hz, 0.0, 10'000.0},
      {"required", "whether a take needs it: red while it is missing", &o.required},
      {"lab_key", "protocol nodes: the file of the lab's key", &o.lab_key},
      {"nodes", "protocol nodes: the place of each node by its id", &o.nodes},
  };
}

Fields describe(RecordOptions& o) {
  return {
      {"pre_roll_s", "seconds before the start mark that a take also contains", &o.pre_roll_s, 0.0,
       600.0},
      {"compression",
       "compression of the file's chunks",
       &o.compression,
       -unlimited,
       unlimited,
       {"zstd", "none"}},
  };
}

}  // namespace kinalign
