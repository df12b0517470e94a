// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/record_stage.h"

#include "kinalign/capture/recorder/recording_session.h"

#include <utility>

namespace kinalign {

using namespace std::chrono_literals;

namespace {

constexpr Duration one_turn = 50ms;     // how long a turn waits for data
constexpr Duration waiting_turn = 5ms;  // the same while the disk is waited for

}  // namespace

/// One turn: receives for at most that time, handles keys and Ctrl-C, reports. False: recording
/// ends.
bool Stage::turn(Duration patience) {
  session_.turn(patience, keyboard_.fd());
  for (const char key : single_keys(keyboard_.read())) {
    if (const auto pressed = keys_.take(key, session_.now())) {
      session_.mark({pressed->first, "keyboard", ""}, pressed->second);
    }
  }
  herald_.look(keys_.typed());
  if (interrupted()) {
    take_every_signal();
    pressed_again_ = ends();
    ends_ = true;
  }
  end_what_is_over();
  return !ends();
}

/// Ends the take when its seconds are over or recording ends.
void Stage::end_what_is_over() {
  if (ends()) session_.obey_no_start();
  if (!session_.recording()) return;
  const HostTime begun = session_.newest_take()->begun;
  const bool over = seconds_ && seconds(session_.now() - begun) >= *seconds_;
  if (over || ends()) session_.stop();
}

std::shared_ptr<SessionTake> Stage::next_take() {
  std::shared_ptr<SessionTake> take = session_.next_take();
  if (!take && !ends()) herald_.tell_waiting();
  for (bool going = !ends(); !take && going; take = session_.next_take()) going = turn(one_turn);
  if (take) herald_.follow(take);
  return take;
}

/// Waits until the take's file is begun. A refusal is reported; without `tries_again` it ends the
/// take.
void Stage::begin(SessionTake& take, bool tries_again) {
  const HostTime begun = session_.now();
  bool slow = false, refused = false;
  for (DiskStatus disk = take.disk.status(); disk.paths.empty() && !disk.finished && !take.end;
       disk = take.disk.status()) {
    turn(waiting_turn);
    if (disk.refused && !std::exchange(refused, true)) {
      if (tries_again) {
        herald_.tell(PartFailure{*disk.refused, ""});
      } else {
        take.disk.give_up();
      }
    }
    if (!refused && session_.now() - begun > 2s && !std::exchange(slow, true)) {
      herald_.tell_slow_begin();
    }
  }
}

void Stage::record(SessionTake& take) {
  while (!take.end) turn(one_turn);
}

/// Waits until the rest of a take is written. A refused write is tried again for 30 s, since the
/// user may make room. Receiving, keys, reports and the next take go on meanwhile. False: the disk
/// neither writes nor refuses, and the user gave up with another Ctrl-C after that was reported.
bool Stage::write_rest(SessionTake& take) {
  const HostTime begun = session_.now();
  std::optional<HostTime> refused;
  bool slow = false;  // reported as slow
  for (DiskStatus disk = take.disk.status(); !disk.finished; disk = take.disk.status()) {
    const HostTime now = session_.now();
    if (disk.refused && !refused) {
      refused = now;
      pressed_again_ = false;
      herald_.tell_refused(*disk.refused, ends());
    } else if (!refused && now - begun > 2s && !std::exchange(slow, true)) {
      pressed_again_ = false;
      herald_.tell_slow(disk.waiting_bytes, ends());
    }
    turn(waiting_turn);
    const bool again = (refused || slow) && std::exchange(pressed_again_, false);
    if (again && !refused) return false;
    if (again || (refused && now - *refused > 30s)) take.disk.give_up();
  }
  return true;
}

}  // namespace kinalign
