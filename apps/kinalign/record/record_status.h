// SPDX-License-Identifier: Apache-2.0
// All that `record` shows of a session at one moment, for its printers.
#pragma once

#include "apps/kinalign/text/record_text.h"

#include "kinalign/capture/recorder/recording_session.h"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// A copy of the lab's and the disk's status, so a table and a JSON object of one second show the
/// same numbers.
struct RecordStatus {
  LabStatus lab;
  std::optional<DiskStatus> disk;    // absent if no take is in progress or being finished
  std::vector<std::string> missing;  // required devices and nodes: silent; of a take: never seen
};

/// The present status, with the disk of the newest take.
RecordStatus status_now(RecordingSession& session);
/// The status at the end of the oldest take. Later data belongs to the next take.
RecordStatus status_at_end(const RecordingSession& session);

/// The members that the events "status" and "stopped" have in common.
nlohmann::ordered_json json_of(const RecordStatus& status, const RecordingSession& session);

/// The lines about an ended take: files, losses, senders and ports.
std::string end_text(const RecordStatus& status, const RecordingSession& session);

}  // namespace kinalign
