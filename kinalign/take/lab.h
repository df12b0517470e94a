// SPDX-License-Identifier: Apache-2.0
// The devices of a lab and how to record them: lab.toml and the flags of `kinalign record` are
// these structures. Documented for users in docs/recording.md.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/options.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace kinalign {

/// Where a stream of one kind of device comes from.
struct DeviceOptions {
  std::string name;               // the stream's: "mocap", "kinect", "imu"
  std::string protocol;           // a name in protocols/protocols.h; empty: not given
  std::string transport = "udp";  // udp; tcp: we connect; tcp-listen: the device does
  std::string address;            // of the device to connect to; else ours to listen on (all)
  std::int64_t port = -1;         // 0: any free one, where we listen; -1: nobody said
  std::string skeleton;           // of noitom: the BVH file whose header the stream lacks
  double rate_hz = 0.0;           // nominal; 0: the protocol's usual one
  bool required = true;           // red while it is missing
  std::string lab_key;            // of nodes: the file of the key
  std::map<std::string, std::string>
      nodes;  // of nodes: where each is worn, by its id: "7": "waist"
};

struct RecordOptions {
  double pre_roll_s = 5.0;           // kept in memory before a take
  std::string compression = "zstd";  // or none
};

struct Lab {
  std::vector<DeviceOptions> devices;
  RecordOptions record;
};

/// "mocap=noitom:udp:7012", "mocap=noitom:tcp:192.168.7.5:7001", "imu=nodes:5005": a device as a
/// flag says it.
Result<DeviceOptions> parse_device(const std::string& text);

/// The lab's device of that name comes from where `said` says, and stays what it is else; a name
/// that is new is a device more.
void come_from(Lab& lab, const DeviceOptions& said);

/// Fails where a part is missing or of no use, or two devices want one name or one port.
Result<void> validate(const Lab& lab);

/// What it should send, frames a second; 0: nobody knows.
double nominal_rate_hz(const DeviceOptions& device);

/// Names, meanings and ranges of the scalar options, for flags, TOML and --help.
Fields describe(DeviceOptions& options);
Fields describe(RecordOptions& options);

}  // namespace kinalign
