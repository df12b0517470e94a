// SPDX-License-Identifier: Apache-2.0
// Devices, keyboard and marks while takes are awaited and recorded. Takes are told of one after
// another, also where the next one began while the disk still wrote the end of the last.
#pragma once

#include "apps/kinalign/record/mark_keys.h"
#include "apps/kinalign/record/record_herald.h"

#include <memory>
#include <optional>

namespace kinalign {

class Stage {
 public:
  /// `seconds`: each take ends by itself after so long.
  Stage(RecordingSession& session, RecordHerald& herald, std::optional<double> seconds)
      : session_(session), herald_(herald), seconds_(seconds) {}

  /// Waits for a take to begin; nullptr: somebody ended it first.
  std::shared_ptr<SessionTake> next_take();

  /// Until its file is begun or given up, or the take has ended without one; what comes meanwhile
  /// is in it. `tries_again`: what the disk refuses is told, and tried until somebody ends it.
  void begin(SessionTake& take, bool tries_again);

  /// Until a mark, its length, somebody or a full disk has ended it.
  void record(SessionTake& take);

  /// Until all of one that has ended is written or given up. False: the disk stands still, and
  /// somebody has lost patience with it; then nothing may wait for it.
  bool write_rest(SessionTake& take);

  /// No take is to begin any more.
  void end() { ends_ = true; }

  RecordHerald& herald() { return herald_; }
  /// Its program ends without ending it: the terminal is as it was before.
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
  bool pressed_again_ = false;  // Ctrl-C, where it had ended before
};

}  // namespace kinalign
