// SPDX-License-Identifier: Apache-2.0
// Reports on a recording while it runs: a table on a terminal, lines of JSON for programs.
#pragma once

#include "apps/cli/console.h"
#include "apps/kinalign/record/disk_forecast.h"
#include "apps/kinalign/record/silence_news.h"
#include "apps/kinalign/text/clock_event_lines.h"
#include "apps/kinalign/text/record_text.h"

#include "kinalign/capture/net/host_clock.h"
#include "kinalign/capture/recorder/session_take.h"

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

class NodeReceiver;
class RecordingSession;

/// Reports what a RecordingSession does. The session calls nothing here; look() polls it.
class RecordHerald {
 public:
  RecordHerald(RecordingSession& session, Console& console);

  /// The ports are open, and the session waits for a start.
  void tell_waiting();
  /// The take that is reported from now on.
  void follow(std::shared_ptr<SessionTake> take);
  void tell_start(const std::string& path);
  /// Called after each turn. Reports marks at once and everything else ten times a second, once
  /// tell_waiting() or tell_start() was called. `typed`: the text that is being typed.
  void look(const std::optional<std::string>& typed);
  /// The disk failed, or does not begin a take's file.
  void tell(const PartFailure& failure);
  /// The disk refuses the end of a take. `ends`: no further take will come, so a single Ctrl-C
  /// gives it up.
  void tell_refused(const Error& why, bool ends);
  /// The disk neither takes nor refuses the end of a take; `waiting_bytes` wait.
  void tell_slow(std::uint64_t waiting_bytes, bool ends);
  /// The disk does not begin a take's file.
  void tell_slow_begin();
  /// The take was given up before it had a file.
  void tell_never_begun(const DiskStatus& disk);
  /// The take is over and written.
  void tell_end();

  /// The disk has only its reserve left: the take has to end.
  bool disk_full() const { return disk_full_; }
  /// True if a warning about unusable data was reported since the last call.
  bool take_warned() { return std::exchange(warned_, false); }
  /// The required devices and nodes from which nothing came in the take that is over.
  std::vector<std::string> unheard_required() const;

 private:
  void look_at_disk(HostTime now);
  void tell_dropped(std::uint64_t dropped);
  void tell(const HeardMark& mark);
  void tell_news();
  void tell_news_of(NodeReceiver& nodes);
  void tell(const Finding& finding);
  void tell(const HostClockEvent& event);
  void tell_who_lacks(const LabStatus& status);
  void tell_who_is_silent(const LabStatus& status);
  void tell_status(const LabStatus& status);
  void show(const LabStatus& status, const std::optional<std::string>& typed);
  std::string disk_line() const;
  LabStatus lab_status() const;
  LabStatus status_at_end() const;

  RecordingSession& session_;
  Console& console_;
  NodeNames names_;
  std::shared_ptr<SessionTake> take_;         // nullptr before the first take
  std::weak_ptr<const SessionTake> watched_;  // the newest take; dropped_told_ and forecast_ belong
                                              // to it
  std::uint64_t dropped_told_ = 0;
  DiskForecast forecast_;
  ClockEventLines clock_news_;
  SilenceNews silence_news_;
  bool disk_full_ = false, warned_ = false, lacks_told_ = false, ports_told_ = false;
  HostTime begun_, next_look_ = HostTime::min(), next_second_ = HostTime::min();
};

}  // namespace kinalign
