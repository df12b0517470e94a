// SPDX-License-Identifier: Apache-2.0
// The devices of a lab and how to record them. lab.toml and the flags of `kinalign record` fill
// these structures. Documented for users in docs/formats/lab_toml.md.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/options.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace kinalign {

/// The source of the data of one device, or of all nodes.
struct DeviceOptions {
  std::string name;               // the stream's name: "mocap", "kinect", "imu"
  std::string protocol;           // a name in protocols/protocols.h; empty: not given
  std::string transport = "udp";  // udp; tcp: we connect to the device; tcp-listen: it connects to
                                  // us
  std::string address;     // the device's, to connect to; else ours to listen on (empty: all)
  std::int64_t port = -1;  // 0: any free one, if we listen; -1: not given
  std::string skeleton;    // for noitom: a BVH file with the header that the stream lacks
  double rate_hz = 0.0;    // nominal, Hz; 0: the protocol's usual one
  bool required = true;    // shown in red while it is missing
  std::string lab_key;     // for nodes: the file of the key
  std::map<std::string, std::string> nodes;  // for nodes: their places by id: "7": "waist"
};

/// The options of recording that concern all devices together.
struct RecordOptions {
  double pre_roll_s = 5.0;           // seconds kept in memory before a take
  std::string compression = "zstd";  // or none
};

/// One lab.toml, with the flags of `kinalign record` applied. Any combination can be built;
/// validate() says which ones can be recorded.
struct Lab {
  std::vector<DeviceOptions> devices;
  RecordOptions record;
};

/// Parses a device as a flag states it: "mocap=noitom:udp:7012",
/// "mocap=noitom:tcp:192.168.7.5:7001", "imu=nodes:5005".
Result<DeviceOptions> parse_device(const std::string& text);

/// Gives the lab's device of that name the protocol, transport, address and port of `stated`; its
/// other options stay. A new name is added as a device.
void set_device(Lab& lab, const DeviceOptions& stated);

/// Fails if an option is missing or has no meaning, or if two devices have one name or one port.
Result<void> validate(const Lab& lab);

/// The rate that the device should send at, frames a second; 0: not known. A device may state its
/// own rate; else it has the usual one of its protocol.
double nominal_rate_hz(const DeviceOptions& device);

/// Names, meanings and ranges of the options, for flags, TOML and --help.
Fields describe(DeviceOptions& options);
Fields describe(RecordOptions& options);

}  // namespace kinalign
