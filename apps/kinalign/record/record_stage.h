// SPDX-License-Identifier: Apache-2.0
// Runs the session while takes are awaited and recorded. Takes are reported one after another, even
// if the next one began while the disk still wrote the end of the last.
#pragma once

#include "apps/kinalign/record/mark_keys.h"
#include "apps/kinalign/record/record_herald.h"

#include <memory>
#include <optional>

namespace kinalign {

class Stage {
 public:
  /// `seconds`: each take ends after this time, s.
  Stage(RecordingSession& session, RecordHerald& herald, std::optional<double> seconds)
      : session_(session), herald_(herald), seconds_(seconds) {}

  /// Waits for a take to begin. nullptr: recording ended first.
  std::shared_ptr<SessionTake> next_take();

  /// Waits until the take's file is begun or given up, or the take has ended without one. Data that
  /// comes meanwhile is in the take. `tries_again`: a refusal of the disk is reported, and the file
  /// is tried until the user ends it.
  void begin(SessionTake& take, bool tries_again);

  /// Records until a mark, the take's length, the user or a full disk ends the take.
  void record(SessionTake& take);

  /// Waits until the whole ended take is written or given up. False: the disk does not answer and
  /// the user gave up; then nothing may wait for the disk.
  bool write_rest(SessionTake& take);

  /// No further take begins.
  void end() { ends_ = true; }

  RecordHerald& herald() { return herald_; }
  /// Restores the terminal before the process ends without destructors.
  void leave() { keyboard_.leave(); }

 private:
  bool turn(Duration patience);
  void end_what_is_over();
  bool ends() const { return ends_ || herald_.disk_full(); }

  RecordingSession& session_;
  RecordHerald& herald_;
  std::optional<double> seconds_;
  Keyboard keyboard_;
  MarkKeys keys_;
  bool ends_ = false;
  bool pressed_again_ = false;  // another Ctrl-C after the one that ended recording
};

}  // namespace kinalign
