// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/record_stage.h"

#include "kinalign/capture/recorder/recording_session.h"

#include <utility>

namespace kinalign {

using namespace std::chrono_literals;

namespace {

constexpr Duration one_turn = 50ms;
constexpr Duration waiting_turn = 5ms;  // for the disk

}  // namespace

/// What comes within that time. Whether to go on.
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

/// What the disk refuses is tried again for half a minute: somebody may make room. Devices go on
/// meanwhile, and so do keys, what is told, and the next take. False: it does not even refuse, and
/// somebody has lost patience: with another Ctrl-C after that was told.
bool Stage::write_rest(SessionTake& take) {
  const HostTime begun = session_.now();
  std::optional<HostTime> refused;
  bool slow = false;  // and told to be
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
