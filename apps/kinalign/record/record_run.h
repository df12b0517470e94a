// SPDX-License-Identifier: Apache-2.0
// Runs a recording session, in which takes are recorded one after another. The next take may begin
// while the end of the last one is still being written.
#pragma once

#include "apps/kinalign/record/mark_keys.h"
#include "apps/kinalign/record/record_job.h"
#include "apps/kinalign/record/record_printer.h"

#include <memory>
#include <string>
#include <vector>

namespace kinalign {

/// Records the takes of a session. Invariant: this object works on the session's oldest take, and
/// releases it after printing its end.
class RecordRun {
 public:
  RecordRun(const RecordJob& job, Call& call, RecordingSession& session)
      : job_(job), call_(call), session_(session), printer_(session, call.console) {}

  /// Records one take, or with --repeat several, until the recording ends. Returns the worst exit
  /// code.
  int operator()();

 private:
  void turn(Duration patience);
  void end_if_over();
  bool ends() const { return ends_ || printer_.disk_full(); }
  bool wait_for_take();
  int record(SessionTake& take);
  void record_until_end(SessionTake& take);
  void write_rest(SessionTake& take);
  int exit_code(const RecordStatus& status);
  // Ends the process without destructors; the definition gives the reason.
  [[noreturn]] void leave();
  void print_takes(std::size_t takes, std::vector<std::string> faulty, int worst);

  const RecordJob& job_;
  Call& call_;
  RecordingSession& session_;
  RecordPrinter printer_;
  Keyboard keyboard_;
  MarkKeys keys_;
  // True after the first Ctrl-C or, without --repeat, after the take. No new take begins then.
  bool ends_ = false;
  bool pressed_again_ = false;  // true: Ctrl-C came again after recording had ended
};

}  // namespace kinalign
