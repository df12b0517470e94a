// SPDX-License-Identifier: Apache-2.0
// A table of the devices' protocols, one row each. Other code uses a row or switches over the enum.
// No other code compares names of protocols or transports.
//
// To add a protocol, make a room (folder) below this one. Then add an enumerator and a row here,
// and a case in each switch over the enum. There are two such switches: the decoder while recording
// (capture/recorder/stream_watch.cpp) and the rows for alignment
// (recording/streams/device_rows.cpp).
#pragma once

#include "kinalign/core/error.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The order of the enumerators is the order in messages and in --help.
enum class Protocol : std::uint8_t { nodes, noitom, xsens, kinect, slimevr };

/// `tcp`: kinalign connects to the device. `tcp_listen`: the device connects to kinalign.
enum class Transport : std::uint8_t { udp, tcp, tcp_listen };

/// The kind of rows into which the alignment converts a stream.
enum class ProtocolRows : std::uint8_t { clip, points, imu };

/// The numbers in a sender's data by which lost messages are counted.
enum class LossNumbers : std::uint8_t {
  datagrams,   // each datagram has a number
  frames,      // each frame has a number, in every datagram of the frame
  frame_heads  // each frame has a number, in its first datagram only
};

/// The messages of a device that the recorder answers.
enum class Answers : std::uint8_t {
  none,
  node_requests,      // time requests of inertial nodes
  kinect_pings,       // time requests of a Kinect's sender
  tracker_handshakes  // a SlimeVR tracker sends no samples before an answer
};

struct ProtocolRow {
  Protocol protocol;
  std::string_view name;                  // name in lab.toml and --device: "nodes"
  std::string_view recorded_name;         // name in recordings: "kinalign-node"
  std::span<const Transport> transports;  // the first one is the default
  ProtocolRows rows;
  LossNumbers losses;
  Answers answers = Answers::none;
  double usual_rate_hz = 0.0;   // 0: the rate differs from device to device
  bool needs_skeleton = false;  // the stream contains no skeleton, so the user must give a BVH file
  bool has_trackers = false;    // the stream also has inertial samples: select.kind = "trackers"
  bool has_frame_decoder =
      false;                  // the recorder decodes frames and reports a stream without frames
  bool has_node_ids = false;  // senders state ids, so one device of a lab represents all of them
  bool is_named_by_address = false;  // the name is address and sensor number
};

/// All rows, in the order of the enum.
std::span<const ProtocolRow> protocol_rows();
const ProtocolRow& row_of(Protocol protocol);

/// Finds a protocol by its name in lab.toml and --device. The result is empty for any other text.
std::optional<Protocol> find_protocol(std::string_view name);
/// Finds a protocol by its name in recordings. The result is empty for any other text, which a
/// later version of kinalign may have written.
std::optional<Protocol> find_recorded_protocol(std::string_view recorded_name);
/// The error "expected a known protocol (nearest: kinect), found "kinet"".
Error unknown_protocol(std::string_view name);
std::vector<std::string> protocol_names();

/// The transport's name: "udp", "tcp" or "tcp-listen".
std::string_view name_of(Transport transport);
/// Finds a transport by its name. The result is empty for any other text.
std::optional<Transport> find_transport(std::string_view name);
/// The error "expected a known transport (nearest: udp), found "udb"".
Error unknown_transport(std::string_view name);
std::vector<std::string> transport_names();

/// True if each datagram contains whole messages. False for a connection, whose bytes may be cut
/// anywhere, and for an unknown transport.
bool is_datagrams(std::string_view transport);

/// True if a device with this protocol may use the transport. kinalign checks this when it reads
/// lab.toml and --device.
bool may_come_over(const ProtocolRow& row, Transport transport);

}  // namespace kinalign
