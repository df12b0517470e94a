// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/error.h"

namespace kinalign {

namespace {

std::string without_controls(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) c = '?';
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
  std::string out = without_controls(text.substr(0, most));
  if (text.size() > most) out += "...";
  return out;
}

std::string harmless(std::string_view text) {
  std::string out = without_controls(text);
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n') out[i] = '\n';
  }
  return out;
}

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
