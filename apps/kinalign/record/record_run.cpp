// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/record_run.h"

#include "apps/cli/program.h"
#include "apps/kinalign/record/take_path.h"

#include "kinalign/core/files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace kinalign {

using namespace std::chrono_literals;

namespace {

constexpr Duration one_turn = 50ms;     // the longest wait for data in one turn
constexpr Duration waiting_turn = 5ms;  // the same while the program waits for the disk

}  // namespace

int RecordRun::operator()() {
  // The path is chosen when a take begins, because the takes before it have their names then.
  const auto free_path = [folder = call_.common.out, subject = job_.subject, action = job_.action] {
    // The folder may have been removed. If it can't be made again, opening the file fails.
    (void)make_folders(folder);
    return free_take_path(folder, subject, action);
  };
  const TakePlan plan{free_path, job_.subject, job_.action};
  using Starts = RecordingSession::Starts;
  // Without --wait the take begins at once and needs no mark.
  if (job_.wait) {
    session_.obey_marks(plan, job_.repeat ? Starts::each : Starts::next);
  } else {
    session_.start(plan);
  }
  std::size_t takes = 0;
  int worst = 0;
  std::vector<std::string> faulty;
  // The oldest take is written to its end first, even if the next one has begun.
  for (; wait_for_take(); ++takes) {
    const std::shared_ptr<SessionTake> take = session_.takes().front();
    const int code = record(*take);
    session_.release_take();
    worst = std::max(worst, code);
    // Without --repeat there is one take, and its exit code is that of the verb.
    if (!job_.repeat) return worst;
    const auto paths = take->disk.status().paths;
    if (code != 0) faulty.push_back(paths.empty() ? "a take without a file" : paths.front());
  }
  if (takes > 0) {
    print_takes(takes, std::move(faulty), worst);
    return worst;
  }
  call_.console.note("kinalign record: stopped before a start came; nothing was recorded");
  return 1;
}

/// One turn of the session: receives data for at most `patience`, handles keys and Ctrl-C, prints.
void RecordRun::turn(Duration patience) {
  // The turn waits for the keyboard and the sockets together, so a key ends the wait.
  session_.turn(patience, keyboard_.fd());
  for (const char key : single_keys(keyboard_.read())) {
    if (const auto pressed = keys_.take(key, session_.now())) {
      // The mark has the time at which the key was read.
      session_.mark({pressed->first, "keyboard", ""}, pressed->second);
    }
  }
  printer_.look(keys_.typed());
  // take_every_signal() forgets the Ctrl-C, so that interrupted() can report a second one.
  if (interrupted()) {
    take_every_signal();
    pressed_again_ = ends();
    ends_ = true;
  }
  end_if_over();
}

/// Ends the take if its length is reached or the recording ends.
void RecordRun::end_if_over() {
  // Start marks are ignored once the recording ends.
  if (ends()) session_.obey_no_start();
  if (!session_.recording()) return;
  const HostTime begun = session_.takes().back()->begun;
  // --seconds counts from the start of the newest take.
  const bool over = job_.seconds && seconds(session_.now() - begun) >= *job_.seconds;
  if (over || ends()) session_.stop();
}

/// Waits until there is a take. Returns false if the recording ended first.
bool RecordRun::wait_for_take() {
  if (session_.takes().empty() && !ends()) printer_.print_waiting();
  while (session_.takes().empty() && !ends()) turn(one_turn);
  return !session_.takes().empty();
}

/// Records a take until it ends, and writes it. Returns its exit code.
int RecordRun::record(SessionTake& take) {
  record_until_end(take);
  // Without --repeat recording ends with the first take.
  if (!job_.repeat) ends_ = true;
  write_rest(take);
  return exit_code(printer_.print_end());
}

/// Runs the session until a mark, the take's length, the user or a full disk ends the take. If the
/// disk refuses the take's file, the program tries again. If recording does not wait for marks, the
/// take is given up instead.
void RecordRun::record_until_end(SessionTake& take) {
  const HostTime begun = session_.now();
  bool slow = false, refused = false;
  // The disk's threads change the status, so it is copied again after each turn.
  for (DiskStatus disk = take.disk.status(); !take.end && !disk.finished;
       disk = take.disk.status()) {
    // Short turns show soon that the file has begun.
    turn(disk.paths.empty() ? waiting_turn : one_turn);
    if (!disk.paths.empty()) continue;
    if (disk.refused && !std::exchange(refused, true)) {
      if (job_.wait) {
        printer_.print(PartFailure{*disk.refused, ""});
      } else {
        take.disk.give_up();
      }
    }
    // If the disk does not answer for 2 s, the user is told once.
    if (!refused && session_.now() - begun > 2s && !std::exchange(slow, true)) {
      printer_.print_slow_begin();
    }
  }
}

/// Waits until the end of a take is written or given up. A refused write is tried again for 30 s,
/// since the user may make room on the disk. Meanwhile the session goes on: data, keys, output and
/// the next take. If the disk neither writes nor refuses, the user is told, and another Ctrl-C ends
/// the process.
void RecordRun::write_rest(SessionTake& take) {
  const HostTime begun = session_.now();
  std::optional<HostTime> refused;
  bool slow = false;  // true: the user was told that the disk is slow
  for (DiskStatus disk = take.disk.status(); !disk.finished; disk = take.disk.status()) {
    const HostTime now = session_.now();
    if (disk.refused && !refused) {
      refused = now;
      // The user learns of the fault from this message, so only a Ctrl-C after it counts.
      pressed_again_ = false;
      printer_.print_refused_end(*disk.refused, ends());
    } else if (!refused && now - begun > 2s && !std::exchange(slow, true)) {
      pressed_again_ = false;
      printer_.print_slow_end(disk.waiting_bytes, ends());
    }
    turn(waiting_turn);
    const bool again = (refused || slow) && std::exchange(pressed_again_, false);
    // If the disk hangs inside a system call, only the end of the process stops the waiting.
    if (again && !refused) leave();
    if (again || (refused && now - *refused > 30s)) take.disk.give_up();
  }
}

/// Ends the process while the disk does not answer and the user has given up. No objects are
/// destroyed, because the disk's threads still use them.
void RecordRun::leave() {
  for (const auto& take : session_.takes()) {
    const DiskStatus disk = take->disk.status();
    if (disk.finished && !disk.refused) continue;  // the whole take is on the disk
    const bool begun = !disk.paths.empty();
    call_.console.report(Error{begun ? disk.paths.front() : call_.common.out, 0,
                               begun ? "the end of the take on the disk" : "a file for the take",
                               "a disk that does not respond"});
  }
  (void)call_.console.finish();
  keyboard_.leave();
  std::_Exit(failed);
}

/// The exit code of a take: 0 if the whole take is on the disk and there was no fault or warning.
int RecordRun::exit_code(const RecordStatus& status) {
  const DiskStatus& disk = *status.disk;
  const bool warned = printer_.take_warned();
  if (disk.refused) {
    call_.console.report(*disk.refused);
    return failed;
  }
  // A take has a second file if writing to the first one failed.
  const bool whole = disk.dropped == 0 && disk.paths.size() == 1 && !printer_.disk_full();
  return whole && status.missing.empty() && !warned ? 0 : 1;
}

/// Prints the last line of --repeat: the number of takes, and those whose exit code was not 0.
void RecordRun::print_takes(std::size_t takes, std::vector<std::string> faulty, int worst) {
  constexpr std::size_t most_named = 8;
  std::string text = fmt::format("kinalign record: {} take{}", takes, takes == 1 ? "" : "s");
  if (faulty.size() > most_named) {
    const std::size_t more = faulty.size() - most_named;
    faulty.resize(most_named);
    faulty.push_back(fmt::format("{} more", more));
  }
  if (!faulty.empty()) {
    text += fmt::format("; exit code {} because of the messages above about {}", worst,
                        fmt::join(faulty, ", "));
  }
  call_.console.note(harmless(text));
}

}  // namespace kinalign
