// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/error.h"

#include "kinalign/core/utf8.h"

namespace kinalign {

namespace {

/// True for characters that move a terminal's cursor or change the writing direction. The codes
/// U+0080 to U+009F belong to them, because terminals obey these, too.
bool is_control(char32_t code) {
  const auto within = [code](char32_t first, char32_t last) {
    return code >= first && code <= last;
  };
  const bool cursor = code < 0x20 || within(0x7f, 0x9f);
  const bool marks = code == 0x61c || within(0x200e, 0x200f);
  return cursor || marks || within(0x202a, 0x202e) || within(0x2066, 0x2069);
}

/// Replaces control characters and bytes that are not UTF-8 by '?'. Control characters in `but` are
/// kept. Each invalid byte becomes one '?', so the rest of a damaged text stays readable.
std::string without_controls(std::string_view text, std::string_view but = "") {
  std::string out;
  while (!text.empty()) {
    const Character next = first_character(text);
    const bool wanted = but.find(text.front()) != std::string_view::npos;
    if (next.code && (wanted || !is_control(*next.code))) {
      out += text.substr(0, next.bytes);
    } else {
      out += '?';
    }
    text.remove_prefix(next.bytes);
  }
  return out;
}

}  // namespace

std::string to_string(const Error& error) {
  std::string text = without_controls(error.file);  // a name may contain any byte
  // Without a file name the place reads "line 12".
  if (error.line > 0) text += (text.empty() ? "line " : ":") + std::to_string(error.line);
  if (!text.empty()) text += ": ";
  text += "expected " + harmless(error.expected);
  if (!error.found.empty()) text += ", found " + harmless(error.found);
  return text;
}

std::string shown(std::string_view text) {
  constexpr std::size_t most = 40;
  if (text.size() <= most) return without_controls(text);
  // A byte of the form 10xxxxxx continues a character. The cut moves back to a character's first
  // byte.
  std::size_t cut = most;  // a UTF-8 character has at most four bytes
  while (cut > most - 3 && (static_cast<unsigned char>(text[cut]) & 0xc0U) == 0x80U) --cut;
  std::string out = without_controls(text.substr(0, cut)) + "...";
  return out;
}

std::string harmless(std::string_view text) { return without_controls(text, "\n"); }

std::string_view to_string(Severity severity) {
  switch (severity) {
    case Severity::note:
      return "note";
    case Severity::warning:
      return "warning";
    case Severity::error:
      return "error";
  }
  return "";
}

}  // namespace kinalign
