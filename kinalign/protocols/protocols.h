// SPDX-License-Identifier: Apache-2.0
// The protocols of the devices, one row each. The rest of the program asks a row or switches over
// the enum; no other code compares names of protocols or transports.
//
// To add a protocol: make a room below this one, an enumerator and a row here, and a case in each
// switch over the enum. There are two: the decoder while recording
// (capture/recorder/stream_watch.cpp), and the rows for alignment
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

/// In the order in which messages and --help list them.
enum class Protocol : std::uint8_t { nodes, noitom, xsens, kinect, slimevr };

/// `tcp`: kinalign connects to the device. `tcp_listen`: the device connects to kinalign.
enum class Transport : std::uint8_t { udp, tcp, tcp_listen };

/// Kind of rows into which alignment converts a stream.
enum class ProtocolRows : std::uint8_t { clip, points, imu };

/// The numbers of the sender by which lost messages are counted.
enum class LossNumbers : std::uint8_t {
  datagrams,   // each datagram has a number
  frames,      // each frame has a number, in every datagram of the frame
  frame_heads  // each frame has a number, in its first datagram only
};

/// Messages of the sender that the recorder answers.
enum class Answers : std::uint8_t {
  none,
  node_requests,      // time requests of inertial nodes
  kinect_pings,       // time requests of a Kinect's sender
  tracker_handshakes  // handshakes: a SlimeVR tracker sends no samples before an answer
};

struct ProtocolRow {
  Protocol protocol;
  std::string_view name;                  // in lab.toml and --device: "nodes"
  std::string_view recorded_name;         // in recordings: "kinalign-node"
  std::span<const Transport> transports;  // the first one is the default
  ProtocolRows rows;
  LossNumbers losses;
  Answers answers = Answers::none;
  double usual_rate_hz = 0.0;   // 0: differs from device to device
  bool needs_skeleton = false;  // the stream does not name a skeleton; a BVH file must describe it
  bool has_trackers = false;  // the same stream also has inertial samples: select.kind = "trackers"
  bool has_frame_decoder =
      false;                  // the recorder decodes frames, so a stream without any is noticed
  bool has_node_ids = false;  // senders state their ids; one device of a lab then stands for all of
                              // them
  bool is_named_by_address = false;  // senders state no ids; the name is made of the address and a
                                     // sensor's number
};

/// Every row, in the order of the enum.
std::span<const ProtocolRow> protocol_rows();
const ProtocolRow& row_of(Protocol protocol);

/// Finds a protocol by its name in lab.toml and --device. Absent for any other text.
std::optional<Protocol> find_protocol(std::string_view name);
/// Finds a protocol by its name in recordings. Absent for any other text; a later version may have
/// written it.
std::optional<Protocol> find_recorded_protocol(std::string_view recorded_name);
/// The error "expected a known protocol (nearest: kinect), found "kinet"".
Error unknown_protocol(std::string_view name);
std::vector<std::string> protocol_names();

/// The transport's name: "udp", "tcp" or "tcp-listen".
std::string_view name_of(Transport transport);
/// Finds a transport by that name. Absent for any other text.
std::optional<Transport> find_transport(std::string_view name);
/// The error "expected a known transport (nearest: udp), found "udb"".
Error unknown_transport(std::string_view name);
std::vector<std::string> transport_names();

/// True if each datagram holds whole messages. False for a connection, which delivers bytes cut
/// anywhere, and for an unknown transport.
bool is_datagrams(std::string_view transport);

/// True if a device with this protocol may use the transport. Checked when lab.toml and --device
/// are read.
bool may_come_over(const ProtocolRow& row, Transport transport);

}  // namespace kinalign
