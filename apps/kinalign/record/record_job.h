// SPDX-License-Identifier: Apache-2.0
// Turns the flags of `record` and the lab's file into the options of a session.
#pragma once

#include "apps/cli/console.h"

#include "kinalign/capture/recorder/recording_session.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// The values of the flags and settings of `record`. `options` holds those that the library
/// describes itself.
struct RecordJob {
  std::string subject, action;
  std::vector<std::string> devices;
  std::string lab_key;
  std::optional<double> seconds;
  std::optional<std::int64_t> marks_port, trigger_port, live_port;
  bool wait = false, repeat = false;
  RecordOptions options;
};

/// The lab of the devices in a lab.toml. --device changes where the data of a device comes from, or
/// adds a device.
Result<Lab> lab_of(const RecordJob& job, std::vector<DeviceOptions> in_file);

/// The options with all files read that the devices need. Problems of the lab are refused by the
/// console (exit code 2).
/// It opens no socket and writes no file, so a fault here leaves nothing behind.
Result<RecordingSession::Options> session_options(const RecordJob& job, Call& call);

/// Advice for a port of the lab that could not be opened: the flag or file to change. The error's
/// file is the device's name, "marks" or "trigger".
Advice lab_port_advice(const RecordJob& job, const Lab& lab, const Call& call);

}  // namespace kinalign
