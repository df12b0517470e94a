// SPDX-License-Identifier: Apache-2.0
// The state of a session at one moment, as `record` prints it.
#pragma once

#include "apps/kinalign/text/record_text.h"

#include "kinalign/capture/recorder/recording_session.h"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// Copies of the lab's and the disk's status. They make sure that the table and the JSON of one
/// second show the same numbers.
struct RecordStatus {
  LabStatus lab;
  std::optional<DiskStatus> disk;  // empty if no take is being recorded or written
  // Required devices and nodes that are silent now. At a take's end: those that never sent.
  std::vector<std::string> missing;
};

/// The present status, with the disk's status for the newest take.
RecordStatus status_now(RecordingSession& session);
/// The status at the end of the oldest take. Later data is not counted, since it belongs to the
/// next take.
RecordStatus status_at_end(const RecordingSession& session);

/// The JSON members that the events "status" and "stopped" share.
nlohmann::ordered_json json_of(const RecordStatus& status, const RecordingSession& session);

/// The lines about an ended take: its files, losses, senders and ports.
std::string end_text(const RecordStatus& status, const RecordingSession& session);

}  // namespace kinalign
