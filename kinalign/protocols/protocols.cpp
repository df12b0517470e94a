// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/protocols.h"

#include "kinalign/core/nearest_name.h"

#include <algorithm>

namespace kinalign {

namespace {

// The names in the order of Transport.
constexpr std::array<std::string_view, 3> transport_table{"udp", "tcp", "tcp-listen"};

constexpr std::array udp_only{Transport::udp};
constexpr std::array any_transport{Transport::udp, Transport::tcp, Transport::tcp_listen};

constexpr std::array<ProtocolRow, 5> table{{
    {.protocol = Protocol::nodes,
     .name = "nodes",
     .recorded_name = "kinalign-node",
     .transports = udp_only,
     .rows = ProtocolRows::imu,
     .losses = LossNumbers::datagrams,
     .answers = Answers::node_requests,
     .has_node_ids = true},
    {.protocol = Protocol::noitom,
     .name = "noitom",
     .recorded_name = "noitom",
     .transports = any_transport,
     .rows = ProtocolRows::clip,
     .losses = LossNumbers::frame_heads,
     .needs_skeleton = true,
     .has_frame_decoder = true},
    {.protocol = Protocol::xsens,
     .name = "xsens",
     .recorded_name = "xsens",
     .transports = any_transport,
     .rows = ProtocolRows::clip,
     .losses = LossNumbers::frames,
     .has_trackers = true,
     .has_frame_decoder = true},
    {.protocol = Protocol::kinect,
     .name = "kinect",
     .recorded_name = "kinect",
     .transports = any_transport,
     .rows = ProtocolRows::points,
     .losses = LossNumbers::frames,
     .answers = Answers::kinect_pings,
     .usual_rate_hz = 30.0,
     .has_frame_decoder = true},
    {.protocol = Protocol::slimevr,
     .name = "slimevr",
     .recorded_name = "slimevr",
     .transports = udp_only,
     .rows = ProtocolRows::imu,
     .losses = LossNumbers::datagrams,
     .answers = Answers::tracker_handshakes,
     .has_frame_decoder = true,
     .is_named_by_address = true},
}};

// A row at the wrong position would give a protocol the properties of another protocol, so the
// compiler checks the order.
constexpr bool is_in_order() {
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (static_cast<std::size_t>(table[i].protocol) != i) return false;
  }
  return true;
}
static_assert(is_in_order(), "row_of() takes the enumerator as the index");

std::optional<Protocol> find_by(std::string_view ProtocolRow::*name, std::string_view text) {
  const auto* found = std::find_if(table.begin(), table.end(),
                                   [&](const ProtocolRow& row) { return row.*name == text; });
  return found == table.end() ? std::nullopt : std::optional(found->protocol);
}

}  // namespace

std::span<const ProtocolRow> protocol_rows() { return table; }

const ProtocolRow& row_of(Protocol protocol) { return table[static_cast<std::size_t>(protocol)]; }

std::optional<Protocol> find_protocol(std::string_view name) {
  return find_by(&ProtocolRow::name, name);
}

std::optional<Protocol> find_recorded_protocol(std::string_view recorded_name) {
  return find_by(&ProtocolRow::recorded_name, recorded_name);
}

Error unknown_protocol(std::string_view name) {
  return unknown_name(name, "a known protocol", protocol_names());
}

std::vector<std::string> protocol_names() {
  std::vector<std::string> names;
  for (const ProtocolRow& row : table) names.emplace_back(row.name);
  return names;
}

std::string_view name_of(Transport transport) {
  return transport_table[static_cast<std::size_t>(transport)];
}

std::optional<Transport> find_transport(std::string_view name) {
  const auto found = std::find(transport_table.begin(), transport_table.end(), name);
  if (found == transport_table.end()) return std::nullopt;
  return static_cast<Transport>(found - transport_table.begin());
}

Error unknown_transport(std::string_view name) {
  return unknown_name(name, "a known transport", transport_names());
}

std::vector<std::string> transport_names() {
  return {transport_table.begin(), transport_table.end()};
}

bool is_datagrams(std::string_view transport) {
  return find_transport(transport) == Transport::udp;
}

bool may_come_over(const ProtocolRow& row, Transport transport) {
  return std::find(row.transports.begin(), row.transports.end(), transport) != row.transports.end();
}

}  // namespace kinalign
