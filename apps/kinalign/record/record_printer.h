// SPDX-License-Identifier: Apache-2.0
// Prints what happens in a recording session: lines and a table on a terminal, JSON for programs.
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

/// Runs in the thread of the session. Lines are printed once for each change; the table and the
/// JSON status once a second. Weak pointers tell takes apart without keeping them.
class RecordPrinter {
 public:
  RecordPrinter(RecordingSession& session, Console& console);

  /// The ports are open, and the session waits for a start.
  void print_waiting();
  /// Called after each turn. Prints marks and a take's new file at once, and everything else ten
  /// times a second. `typed`: the text that is being typed.
  void look(const std::optional<std::string>& typed);
  /// The disk failed, or does not begin a take's file.
  void print(const PartFailure& failure);
  /// The disk does not begin a take's file.
  void print_slow_begin();
  /// The disk refuses the end of a take. `ends`: no further take will come, so a single Ctrl-C
  /// gives it up.
  void print_refused_end(const Error& why, bool ends);
  /// The disk neither takes nor refuses the end of a take; `waiting_bytes` wait.
  void print_slow_end(std::uint64_t waiting_bytes, bool ends);
  /// The oldest take is written or given up. Returns its status.
  RecordStatus print_end();

  /// The disk has only its reserve left: the take has to end.
  /// Never reset: a full disk ends the recording, not only the take.
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
  std::weak_ptr<const SessionTake> forecast_of_;  // dropped_ and forecast_ belong to this take
  std::uint64_t dropped_ = 0;                     // messages lost as printed last
  DiskForecast forecast_;
  ClockEventLines clock_lines_;
  SilentSenders silent_senders_;
  bool ports_printed_ = false, disk_full_ = false, warned_ = false, unseen_printed_ = false;
  HostTime next_look_ = HostTime::min(), next_second_ = HostTime::min();
};

}  // namespace kinalign
