// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record_stage.h"

#include <algorithm>
#include <utility>

namespace kinalign {

using namespace std::chrono_literals;

namespace {

constexpr Duration one_turn = 50ms;

}  // namespace

/// What comes within that time. Whether to go on.
bool Stage::turn(Duration patience) {
  session_.turn(patience, keyboard_.fd());
  for (const char key : single_keys(keyboard_.read())) {
    if (const auto pressed = keys_.take(key, session_.now())) {
      session_.mark({pressed->first, "keyboard", ""}, pressed->second);
    }
  }
  for (const HeardMark& heard : session_.take_marks()) {
    const Mark::Kind kind = heard.first.mark.kind;
    marks_.push_back(kind);
    if (kind == Mark::Kind::start && !session_.recording()) session_.expect_start(heard.second);
    herald_.tell(heard);
  }
  herald_.look(keys_.typed());
  ends_ = ends_ || interrupted();
  return !ends();
}

/// Whether a mark of that kind came since one was found last; those before it are forgotten.
bool Stage::take_mark(Mark::Kind kind) {
  const auto found = std::find(marks_.begin(), marks_.end(), kind);
  const bool came = found != marks_.end();
  marks_.erase(marks_.begin(), came ? found + 1 : found);
  return came;
}

bool Stage::wait_for_start() {
  while (turn(one_turn)) {
    if (take_mark(Mark::Kind::start)) return true;
  }
  return false;
}

bool Stage::begin(Beginning beginning) {
  begun_ = session_.now();
  session_.start(std::move(beginning.free_path), beginning.subject, beginning.action);
  bool lost_patience = false, slow = false, refused = false;
  for (DiskStatus disk = *session_.disk(); disk.paths.empty() && !disk.finished;
       disk = *session_.disk()) {
    turn(5ms);
    if (disk.refused && !std::exchange(refused, true) && beginning.tries_again) {
      herald_.tell(PartFailure{*disk.refused, ""});
    }
    if (refused && (!beginning.tries_again || ends_)) session_.give_up();
    if (!refused && session_.now() - begun_ > 2s && !std::exchange(slow, true)) {
      herald_.tell_slow_begin();
    }
    if (!interrupted()) continue;
    if (std::exchange(lost_patience, true)) return false;
    listen_anew();
  }
  return true;
}

bool Stage::record(const End& end) {
  const auto goes_on = [&] {
    const bool stopped = take_mark(Mark::Kind::stop) && end.by_mark;
    return !stopped && !(end.seconds && seconds(session_.now() - begun_) >= *end.seconds);
  };
  for (bool going = true; going && goes_on();) going = turn(one_turn);
  listen_anew();  // a Ctrl-C that is pressed twice ends nothing out of order
  session_.stop();
  herald_.end_take();
  return write_rest();
}

/// What the disk refuses is tried again for half a minute: somebody may make room. Devices go on
/// meanwhile, and so do keys and what is told. False: it does not even refuse, and somebody has
/// lost patience.
bool Stage::write_rest() {
  const HostTime begun = session_.now();
  std::optional<HostTime> refused;
  bool slow = false;  // and told to be
  for (DiskStatus disk = *session_.disk(); !disk.finished; disk = *session_.disk()) {
    const HostTime now = session_.now();
    if (disk.refused && !refused) {
      refused = now;
      herald_.tell_refused(*disk.refused);
      listen_anew();
    } else if (!refused && now - begun > 2s && !std::exchange(slow, true)) {
      herald_.tell_slow(disk.waiting_bytes);
      listen_anew();
    }
    turn(5ms);
    const bool again = (refused || slow) && interrupted();
    if (again && !refused) return false;
    if (again || (refused && now - *refused > 30s)) session_.give_up();
  }
  return true;
}

/// To another Ctrl-C.
void Stage::listen_anew() {
  ends_ = ends_ || interrupted();
  take_signals();
}

}  // namespace kinalign
