// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/mark_keys.h"

#include <poll.h>
#include <unistd.h>

#include <array>

namespace kinalign {

namespace {

// The largest length of a text in bytes, also in marks that programs send (docs/formats/marks.md).
constexpr std::size_t most_text = 500;
constexpr char escape = 0x1b, backspace = 0x08, del = 0x7f;

bool is_enter(char key) { return key == '\n' || key == '\r'; }

/// Removes the last character, which may have several bytes in UTF-8.
void erase_last(std::string& text) {
  // In UTF-8 a character goes on with bytes 10xxxxxx. The loop removes them, and the line after it
  // the first byte.
  while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xC0U) == 0x80U) {
    text.pop_back();
  }
  if (!text.empty()) text.pop_back();
}

std::optional<Mark::Kind> kind_of(char key) {
  if (key == 's') return Mark::Kind::start;
  if (key == 'e') return Mark::Kind::stop;
  if (key == 't') return Mark::Kind::t_pose;
  return std::nullopt;
}

}  // namespace

/// By ECMA-48 an arrow key, for example, sends Esc [, bytes below 0x40 and a last byte. Other keys
/// send Esc O and one byte.
std::string single_keys(std::string_view sent) {
  std::string keys;
  for (std::size_t i = 0; i < sent.size(); ++i) {
    // The byte after Esc tells whether a sequence follows. An Esc at the end of the bytes is the
    // key Esc.
    const char next = sent[i] == escape && i + 1 < sent.size() ? sent[i + 1] : '\0';
    if (next != '[' && next != 'O') {
      keys += sent[i];
      continue;
    }
    // After the next lines i is the index of the sequence's last byte; the for loop then goes on
    // behind it.
    i += 2;
    while (next == '[' && i < sent.size() && sent[i] >= 0x20 && sent[i] < 0x40) ++i;
  }
  return keys;
}

std::optional<std::pair<Mark, HostTime>> MarkKeys::take(char key, HostTime now) {
  if (!text_) {
    // Enter begins a text, and the mark is complete at the next Enter.
    if (is_enter(key)) text_ = Text{"", now};
    const auto kind = kind_of(key);
    if (!kind) return std::nullopt;
    return std::pair(Mark{*kind, "", std::nullopt, ""}, now);
  }
  if (is_enter(key)) {
    // The second Enter ends the text. An empty or forbidden text gives no mark.
    const Text done = *std::exchange(text_, std::nullopt);
    if (done.text.empty() || !is_mark_text(done.text)) return std::nullopt;
    // The mark has the time of the first Enter, because the user marked that moment and typed
    // afterwards.
    return std::pair(Mark{Mark::Kind::text, done.text, std::nullopt, ""}, done.begun);
  }
  if (key == escape) {
    text_.reset();
  } else if (key == backspace || key == del) {
    erase_last(text_->text);
    // Control characters are not allowed in a mark. Bytes of UTF-8 characters are 0x80 or more and
    // are accepted.
  } else if ((static_cast<unsigned char>(key) >= 0x20 || key == '\t') &&
             text_->text.size() < most_text) {
    text_->text += key;
  }
  return std::nullopt;
}

std::optional<std::string> MarkKeys::typed() const {
  return text_ ? std::optional(text_->text) : std::nullopt;
}

Keyboard::Keyboard() {
  termios mode{};
  // Only a program in the foreground may change the terminal; the system would stop any other.
  const bool ours = ::isatty(STDIN_FILENO) != 0 && ::tcgetpgrp(STDIN_FILENO) == ::getpgrp() &&
                    ::tcgetattr(STDIN_FILENO, &mode) == 0;
  if (!ours) return;
  before_ = mode;
  mode.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);  // Ctrl-C still sends a signal
  ::tcsetattr(STDIN_FILENO, TCSANOW, &mode);
}

void Keyboard::leave() {
  if (before_) ::tcsetattr(STDIN_FILENO, TCSANOW, &*before_);
  before_.reset();
}

std::optional<int> Keyboard::fd() const {
  const bool ours = before_ && ::tcgetpgrp(STDIN_FILENO) == ::getpgrp();
  return ours ? std::optional(STDIN_FILENO) : std::nullopt;
}

std::string Keyboard::read() {
  // read() would wait for a byte, so poll() first tells whether there is one.
  pollfd waiting{STDIN_FILENO, POLLIN, 0};
  if (!fd() || ::poll(&waiting, 1, 0) <= 0) return {};
  std::array<char, 64> keys{};
  const ssize_t got = ::read(STDIN_FILENO, keys.data(), keys.size());
  // A closed terminal has no mode to restore.
  if (got <= 0) before_.reset();  // the terminal was closed
  return {keys.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0))};
}

}  // namespace kinalign
