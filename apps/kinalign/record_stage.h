// SPDX-License-Identifier: Apache-2.0
// Devices, keyboard and marks while takes are awaited and recorded.
#pragma once

#include "apps/kinalign/mark_keys.h"
#include "apps/kinalign/record_herald.h"

#include <optional>
#include <string>
#include <vector>

namespace kinalign {

class Stage {
 public:
  Stage(RecordingSession& session, RecordHerald& herald) : session_(session), herald_(herald) {}

  /// False: somebody ended it first.
  bool wait_for_start();
  struct Beginning {
    RecordingSession::FreePath free_path;
    std::string subject, action;
    bool tries_again = false;  // what the disk refuses is told, and tried until somebody ends it
  };
  /// Begins a take, as RecordingSession::start() does; what comes while its file is begun is in it.
  /// Until that is done or refused. False: the disk stands still, as of record().
  bool begin(Beginning beginning);

  struct End {
    std::optional<double> seconds;
    bool by_mark = false;  // that says stop
  };
  /// Until that, somebody or a full disk ends it, and all is written. False: the disk stands still,
  /// and somebody has lost patience with it; then nothing may wait for it any more.
  bool record(const End& end);

  /// No take is to begin any more.
  bool ends() const { return ends_ || herald_.disk_full(); }
  RecordHerald& herald() { return herald_; }
  /// Its program ends without ending it: the terminal is as it was before.
  void leave() { keyboard_.leave(); }

 private:
  bool turn(Duration patience);
  bool take_mark(Mark::Kind kind);
  bool write_rest();
  void listen_anew();

  RecordingSession& session_;
  RecordHerald& herald_;
  Keyboard keyboard_;
  MarkKeys keys_;
  std::vector<Mark::Kind> marks_;
  HostTime begun_{};  // the take
  bool ends_ = false;
};

}  // namespace kinalign
