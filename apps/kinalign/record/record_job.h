// SPDX-License-Identifier: Apache-2.0
// Turns the flags and settings of `record` and the file lab.toml into the options of a recording
// session.
#pragma once

#include "apps/cli/console.h"

#include "kinalign/capture/recorder/recording_session.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// The values of the flags and settings of `record`. `options` has those settings that the library
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

/// The lab: the devices of a lab.toml, changed by the --device flags. Such a flag changes where the
/// data of a device comes from, or adds a device.
Result<Lab> lab_of(const RecordJob& job, std::vector<DeviceOptions> in_file);

/// The options of the session. All files that the devices name are read. An error in the lab is
/// wrong use (exit code 2). The function opens no socket and writes no file, so an error leaves no
/// traces.
Result<RecordingSession::Options> session_options(const RecordJob& job, Call& call);

/// Advice for a port of the lab that could not be opened: the flag or file that the user can
/// change. The error's file is the device's name, "marks" or "trigger".
Advice lab_port_advice(const RecordJob& job, const Lab& lab, const Call& call);

}  // namespace kinalign
