// SPDX-License-Identifier: Apache-2.0
// Prints what happens while `record` runs: lines and a table on a terminal, JSON for programs.
#pragma once

#include "apps/cli/console.h"
#include "apps/kinalign/record/disk_forecast.h"
#include "apps/kinalign/record/record_status.h"
#include "apps/kinalign/record/silent_senders.h"
#include "apps/kinalign/text/clock_event_lines.h"

#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace kinalign {

/// Prints what happens in a session, in the session's thread. Each change gives one line; the table
/// and the JSON status follow once a second. The weak pointers only tell whether a take is still
/// the same; they do not keep it in memory.
class RecordPrinter {
 public:
  RecordPrinter(RecordingSession& session, Console& console);

  /// Prints that the ports are open and the session waits for a start.
  void print_waiting();
  /// Called after each turn of the session. Prints marks and the file of a new take at once, other
  /// events ten times a second. `typed`: the text that the user is typing.
  void look(const std::optional<std::string>& typed);
  /// Prints that writing to the disk failed, or that the file of a take could not be begun.
  void print(const PartFailure& failure);
  /// Prints that the disk takes long to begin the file of a take.
  void print_slow_begin();
  /// Prints that the disk refuses the end of a take. `ends`: no further take comes, so one Ctrl-C
  /// stops the waiting.
  void print_refused_end(const Error& why, bool ends);
  /// Prints that the disk does not answer while the end of a take is written; `waiting_bytes` are
  /// not written yet.
  void print_slow_end(std::uint64_t waiting_bytes, bool ends);
  /// Prints the end of the oldest take, which was written or given up. Returns its status.
  RecordStatus print_end();

  /// True once the disk has only its reserve left. It stays true, because a full disk ends the
  /// whole recording and not only the take.
  bool disk_full() const { return disk_full_; }
  /// True if a warning about unusable data was printed since the last call.
  bool take_warned() { return std::exchange(warned_, false); }

 private:
  void complain(const std::string& text, const nlohmann::ordered_json& event);
  void print_ports(const std::string& line, const nlohmann::ordered_json& event);
  void print_start();
  void print_events();
  void print_node_events(NodeReceiver& nodes);
  void print(const ReceivedMark& mark);
  void print(const Finding& finding);
  void print(const HostClockEvent& event);
  void print_dropped(std::uint64_t dropped);
  void look_at_disk(const RecordStatus& status);
  void print_unseen(const LabStatus& status);
  void print_silent(const LabStatus& status);
  void print_status_json(const RecordStatus& status);
  void show(const RecordStatus& status, const std::optional<std::string>& typed);
  std::string disk_line() const;

  RecordingSession& session_;
  Console& console_;
  NodeNames names_;
  std::weak_ptr<const SessionTake> started_;      // the take whose file was printed last
  std::weak_ptr<const SessionTake> forecast_of_;  // the take of dropped_ and forecast_
  // The number of lost messages that was printed last.
  std::uint64_t dropped_ = 0;
  DiskForecast forecast_;
  ClockEventLines clock_lines_;
  SilentSenders silent_senders_;
  bool ports_printed_ = false, disk_full_ = false, warned_ = false, unseen_printed_ = false;
  HostTime next_look_ = HostTime::min(), next_second_ = HostTime::min();
};

}  // namespace kinalign
