// SPDX-License-Identifier: Apache-2.0
// Tells what happens while a lab is recorded: a table on a terminal, lines of JSON for programs.
#pragma once

#include "apps/cli/console.h"
#include "apps/kinalign/record/disk_forecast.h"
#include "apps/kinalign/record/silence_news.h"
#include "apps/kinalign/text/clock_news.h"
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

class RecordHerald {
 public:
  RecordHerald(RecordingSession& session, Console& console);

  /// Ports are open, and a start is waited for.
  void tell_waiting();
  /// The take that is told of from now on.
  void follow(std::shared_ptr<SessionTake> take);
  void tell_start(const std::string& path);
  /// Asked after each turn, it tells of marks at once and looks ten times a second at all else, as
  /// soon as it has told what it waits for or that a take has begun. `typed`: a text that is being
  /// typed.
  void look(const std::optional<std::string>& typed);
  /// The disk failed, or does not begin a take's file.
  void tell(const PartFailure& failure);
  /// The disk does not take the end of a take. `ends`: no other is to come, so that one Ctrl-C is
  /// enough to give it up.
  void tell_refused(const Error& why, bool ends);
  /// Nor does it refuse it: so many bytes wait.
  void tell_slow(std::uint64_t waiting_bytes, bool ends);
  /// Nor does it begin its file.
  void tell_slow_begin();
  /// A take is given up before it had a file.
  void tell_never_begun(const DiskStatus& disk);
  /// The take is over and written.
  void tell_end();

  /// The disk has nothing left but its reserve: the take has to end.
  bool disk_full() const { return disk_full_; }
  /// Something of what devices send can't be used, and was told since this was asked last.
  bool take_warned() { return std::exchange(warned_, false); }
  /// Required devices and nodes of which nothing came in the take that is over.
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
  std::shared_ptr<SessionTake> take_;         // nullptr: none has begun
  std::weak_ptr<const SessionTake> watched_;  // the newest, for which both that follow are
  std::uint64_t dropped_told_ = 0;
  DiskForecast forecast_;
  ClockNews clock_news_;
  SilenceNews silence_news_;
  bool disk_full_ = false, warned_ = false, lacks_told_ = false, ports_told_ = false;
  HostTime begun_, next_look_ = HostTime::min(), next_second_ = HostTime::min();
};

}  // namespace kinalign
