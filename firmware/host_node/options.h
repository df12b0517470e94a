// SPDX-License-Identifier: Apache-2.0
// The options of host_node.
#pragma once

#include "firmware/host_node/trouble.h"
#include "firmware/node/node_settings.h"

#include <span>
#include <vector>

namespace kinalign {

enum class EventKind { reboot, step, drift, outage_begins, outage_ends, rebind };

/// An event that a simulated node goes through, to see how the host handles it.
struct Event {
  double at_s = 0;  // s since the program's start
  EventKind kind{};
  double value = 0;  // step: s; drift: ppm
};

struct HostNodeOptions {
  bool help = false;
  bool script = false;  // a script from the standard input, for comparison with other boards
  std::string host, port;
  NodeSettings node;  // key and boot id are not set here
  double rate_hz = 15, sample_rate_hz = 100;
  double seconds = 0;  // 0: the node runs until a signal
  double drift_ppm = 0, offset_s = 0;
  bool has_boot_id = false, same_boot_id = false;
  bool clockless = false, orientation = false;
  int sensor_fails_every = 0;
  int battery_mv = 0;
  std::string key_file;
  std::vector<Event> events;  // sorted by their times
};

Tried<HostNodeOptions> options_from(std::span<const char* const> words);
const char* host_node_help();

}  // namespace kinalign
