// SPDX-License-Identifier: Apache-2.0
// Marks from the keyboard while a take is recorded: s start, e stop, t T-pose; Enter begins a text
// and ends it, which is stamped when it was begun. Esc gives it up.
#pragma once

#include "kinalign/protocols/marks/mark.h"

#include <termios.h>

#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace kinalign {

inline constexpr const char* mark_keys_text =
    "s start  e stop  t T-pose  Enter a text  Ctrl-C ends";

/// Of what a terminal sent at once the single keys: an arrow, say, is Esc and more, and none.
std::string single_keys(std::string_view sent);

class MarkKeys {
 public:
  /// What a key that was pressed at `now` completes, and its stamp.
  std::optional<std::pair<Mark, HostTime>> take(char key, HostTime now);
  /// The text so far, while one is typed.
  std::optional<std::string> typed() const;

 private:
  struct Text {
    std::string text;
    HostTime begun{};
  };
  std::optional<Text> text_;
};

/// The keys of this program's terminal one by one, not shown. None where stdin is no terminal, or
/// another program's at the moment.
class Keyboard {
 public:
  Keyboard();
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;
  ~Keyboard() { leave(); }

  /// To wait for; absent: no keys come.
  std::optional<int> fd() const;
  /// The terminal is as it was before, and no keys come any more.
  void leave();
  /// What was pressed since.
  std::string read();

 private:
  std::optional<termios> before_;  // to be restored
};

}  // namespace kinalign
