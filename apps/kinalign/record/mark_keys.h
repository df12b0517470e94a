// SPDX-License-Identifier: Apache-2.0
// Marks from the keyboard while a take is recorded. The keys s, e and t mark the start, the end and
// a T-pose. Enter begins a text and ends it; the mark has the time of the first Enter. Esc drops
// the text.
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

/// The keys among the bytes that a terminal sent. Keys that send several bytes, such as an arrow
/// key, are left out.
std::string single_keys(std::string_view sent);

/// Turns keys into marks. There are two states: a single key is a mark, or the user types a text.
/// While a text is typed, s, e and t are letters.
class MarkKeys {
 public:
  /// Handles a key pressed at `now`. Returns the mark that this key completes, with its time; empty
  /// if it completes no mark.
  std::optional<std::pair<Mark, HostTime>> take(char key, HostTime now);
  /// The text typed so far. Empty if no text is being typed.
  std::optional<std::string> typed() const;

 private:
  struct Text {
    std::string text;
    HostTime begun{};
  };
  std::optional<Text> text_;
};

/// Reads single keys from the terminal of this program, which does not show them. No keys come if
/// stdin is no terminal or another program is in its foreground. The terminal's mode is changed for
/// the whole program, so it must be restored before the program ends.
class Keyboard {
 public:
  Keyboard();
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;
  ~Keyboard() { leave(); }

  /// The descriptor to wait for. Empty if no keys come.
  std::optional<int> fd() const;
  /// Restores the terminal. No keys come after this call.
  void leave();
  /// The bytes that were typed since the last call.
  std::string read();

 private:
  std::optional<termios> before_;  // the terminal's mode before the change
};

}  // namespace kinalign
