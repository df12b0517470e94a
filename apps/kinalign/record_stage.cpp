// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record_stage.h"

#include <algorithm>
#include <thread>
#include <utility>

namespace kinalign {

using namespace std::chrono_literals;

/// What comes within a twentieth of a second. Whether to go on.
bool Stage::turn() {
  session_.turn(50ms, keyboard_.fd());
  for (const char key : keyboard_.read()) {
    if (const auto pressed = keys_.take(key, session_.now())) {
      session_.mark({pressed->first, "keyboard", ""}, pressed->second);
    }
  }
  for (const HeardMark& heard : session_.take_marks()) {
    marks_.push_back(heard.first.mark.kind);
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
  while (turn()) {
    if (take_mark(Mark::Kind::start)) return true;
  }
  return false;
}

void Stage::record(const End& end) {
  const HostTime begun = session_.now();
  const auto goes_on = [&] {
    const bool stopped = take_mark(Mark::Kind::stop) && end.by_mark;
    return !stopped && !(end.seconds && seconds(session_.now() - begun) >= *end.seconds);
  };
  for (bool going = true; going && goes_on();) going = turn();
  session_.stop();
  write_rest();
}

/// What the disk refuses is tried again for half a minute: somebody may make room.
void Stage::write_rest() {
  const HostTime latest = session_.now() + 30s;
  bool told = false;
  for (DiskStatus disk = *session_.disk(); !disk.finished; disk = *session_.disk()) {
    if (disk.refused && !std::exchange(told, true)) {
      herald_.tell_refused(*disk.refused);
      take_signals();  // another Ctrl-C
    }
    if (told && (interrupted() || session_.now() > latest)) session_.give_up();
    std::this_thread::sleep_for(5ms);
  }
}

}  // namespace kinalign
