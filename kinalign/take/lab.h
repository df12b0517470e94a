// SPDX-License-Identifier: Apache-2.0
// The devices of a lab and how to record them. lab.toml and the flags of `kinalign record` set
// these structures. The user's page is docs/formats/lab_toml.md.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/options.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace kinalign {

/// The source of data of one device, or of all inertial nodes together.
struct DeviceOptions {
  std::string name;               // the stream's name: "mocap", "kinect", "imu"
  std::string protocol;           // a name in protocols/protocols.h; empty: not given
  std::string transport = "udp";  // udp; tcp: this machine connects to the device; tcp-listen: the
                                  // device connects to this machine
  std::string address;     // for tcp the device's address; otherwise this machine's address on
                           // which to listen (empty: all)
  std::int64_t port = -1;  // 0: any free port, when listening; -1: not given
  std::string skeleton;    // for noitom: a BVH file with the hierarchy that the stream lacks
  double rate_hz = 0.0;    // nominal, Hz; 0: the usual rate of the protocol
  bool required = true;    // the user is warned while the device is missing
  std::string lab_key;     // for nodes: path of the key file
  std::map<std::string, std::string> nodes;  // for nodes: place by node id, such as "7": "waist"
};

/// Options of recording that apply to all devices.
struct RecordOptions {
  double pre_roll_s = 5.0;           // seconds kept in memory before a take
  std::string compression = "zstd";  // "zstd" or "none"
};

/// The content of one lab.toml, changed by the flags of `kinalign record`. Any combination can be
/// constructed; validate() checks whether it can be recorded.
struct Lab {
  std::vector<DeviceOptions> devices;
  RecordOptions record;
};

/// Parses a device in the form of a flag: "mocap=noitom:udp:7012",
/// "mocap=noitom:tcp:192.168.7.5:7001", "imu=nodes:5005".
Result<DeviceOptions> parse_device(const std::string& text);

/// Sets protocol, transport, address and port of the lab's device with the name of `stated`. Other
/// options of that device stay. If no device has the name, a new device is added.
void set_device(Lab& lab, const DeviceOptions& stated);

/// Fails if an option is missing or has no effect, or if two devices have the same name or port.
Result<void> validate(const Lab& lab);

/// Returns the rate at which the device should send, in frames per second; 0: not known. A rate in
/// the device's options overrides the usual rate of its protocol.
double nominal_rate_hz(const DeviceOptions& device);

/// Names, meanings and ranges of the options, for flags, TOML and --help.
Fields describe(DeviceOptions& options);
Fields describe(RecordOptions& options);

}  // namespace kinalign
