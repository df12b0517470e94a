// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/error.h"

namespace kinalign {

namespace {

/// Bytes of the control character that `text` begins with; 0 where it begins with none. Those of
/// one byte, U+0080 to U+009F, which terminals obey too, and the ones that turn the direction of
/// writing (U+200E, U+200F, U+202A to U+202E, U+2066 to U+2069).
std::size_t control_size(std::string_view text) {
  const auto byte = [text](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  if (byte(0) < 0x20 || byte(0) == 0x7f) return 1;
  if (byte(0) == 0xc2 && byte(1) >= 0x80 && byte(1) <= 0x9f) return 2;
  if (byte(0) != 0xe2) return 0;
  const unsigned last = byte(2);
  const bool marks = last == 0x8e || last == 0x8f || (last >= 0xaa && last <= 0xae);
  const bool isolates = last >= 0xa6 && last <= 0xa9;
  return (byte(1) == 0x80 && marks) || (byte(1) == 0x81 && isolates) ? 3 : 0;
}

std::string without_controls(std::string_view text, std::string_view but = "") {
  std::string out;
  while (!text.empty()) {
    const std::size_t control = control_size(text);
    const bool kept = control == 0 || but.find(text.front()) != std::string_view::npos;
    out += kept ? text.front() : '?';
    text.remove_prefix(kept ? 1 : control);
  }
  return out;
}

}  // namespace

std::string to_string(const Error& error) {
  std::string text = without_controls(error.file);  // a file's name may hold any byte
  if (error.line > 0) text += (text.empty() ? "line " : ":") + std::to_string(error.line);
  if (!text.empty()) text += ": ";
  text += "expected " + error.expected;
  if (!error.found.empty()) text += ", found " + error.found;
  return text;
}

std::string shown(std::string_view text) {
  constexpr std::size_t most = 40;
  if (text.size() <= most) return without_controls(text);
  std::size_t cut = most;  // never within a letter of UTF-8, which has four bytes at most
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
