// SPDX-License-Identifier: Apache-2.0
// Marks from the keyboard while a take is recorded: s start, e stop, t T-pose. Enter begins a text
// and ends it; the mark's stamp is that of the first Enter. Esc drops the text.
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

/// The single keys among the bytes that a terminal sent. Keys that send several bytes, such as an
/// arrow (Esc and more), are left out.
std::string single_keys(std::string_view sent);

/// Two states: single keys are marks, or a text is being typed. In the second state s, e and t are
/// letters.
class MarkKeys {
 public:
  /// The mark that a key pressed at `now` completes, with its stamp; absent if it completes none.
  std::optional<std::pair<Mark, HostTime>> take(char key, HostTime now);
  /// The text typed so far; absent if none is typed.
  std::optional<std::string> typed() const;

 private:
  struct Text {
    std::string text;
    HostTime begun{};
  };
  std::optional<Text> text_;
};

/// The keys of this program's terminal one by one, not echoed. No keys come if stdin is no
/// terminal, or if another program is in its foreground.
/// The mode of the terminal is changed for the whole program, so it must be restored before the
/// program ends in any way.
class Keyboard {
 public:
  Keyboard();
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;
  ~Keyboard() { leave(); }

  /// The descriptor to poll; absent: no keys come.
  std::optional<int> fd() const;
  /// Restores the terminal; no keys come any more.
  void leave();
  /// The bytes since the last call.
  std::string read();

 private:
  std::optional<termios> before_;  // the mode to be restored
};

}  // namespace kinalign
