// SPDX-License-Identifier: Apache-2.0
// All that `record` shows of a session at one moment, for its printers.
#pragma once

#include "apps/kinalign/text/record_text.h"

#include "kinalign/capture/live/live_port.h"
#include "kinalign/capture/recorder/recording_session.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

/// A copy of everything at one moment, so a table and a JSON object of one second show the same
/// numbers.
struct RecordStatus {
  LabStatus lab;
  std::optional<DiskStatus> disk;    // absent if no take is in progress or being finished
  std::uint64_t waiting_bytes = 0;   // of all takes
  std::vector<std::string> missing;  // required devices and nodes: silent; of a take: never seen
  std::vector<std::pair<std::string, MarkPortCounts>> mark_ports;
  std::optional<LivePortCounts> live;  // absent without a live port
};

/// The present status, with the disk of the newest take. `begun`: when the ports were opened.
RecordStatus status_now(RecordingSession& session, HostTime begun);
/// The status at the end of the oldest take. Later data belongs to the next take.
RecordStatus status_at_end(RecordingSession& session, HostTime begun);

/// The members that the events "status" and "stopped" have in common.
nlohmann::ordered_json json_of(const RecordStatus& status);

/// The lines about an ended take: files, losses, senders and ports.
std::string end_text(const Lab& lab, const RecordStatus& status);

}  // namespace kinalign
