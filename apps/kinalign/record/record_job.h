// SPDX-License-Identifier: Apache-2.0
// What is to be recorded: the flags of `record` and the lab's file become a session's options.
#pragma once

#include "apps/cli/console.h"
#include "apps/kinalign/record/lab_advice.h"

#include "kinalign/capture/recorder/recording_session.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

struct RecordJob {
  std::string subject, action;
  std::vector<std::string> devices;
  std::string lab_key;
  std::optional<double> seconds;
  std::optional<std::int64_t> marks_port, trigger_port, live_port;
  bool wait = false, repeat = false;
  RecordOptions options;
};

/// What --device says, over the devices of a lab.toml.
Result<Lab> lab_of(const RecordJob& job, std::vector<DeviceOptions> in_file);

/// Where the lab that is to be recorded is said.
LabSources sources_of(const RecordJob& job, const Call& call);

/// With all files read that the devices need. What is wrong with the lab the console refuses.
Result<RecordingSession::Options> session_options(const RecordJob& job, Call& call);

}  // namespace kinalign
