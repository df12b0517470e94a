// SPDX-License-Identifier: Apache-2.0
// Two texts in one input, divided by a line "%%".
#pragma once

#include <string_view>

namespace kinalign {

struct TwoParts {
  std::string_view first, second;
  bool divided = false;
};

inline TwoParts two_parts(std::string_view text) {
  constexpr std::string_view line = "\n%%\n";
  const auto at = text.find(line);
  if (at == std::string_view::npos) return {text, {}, false};
  return {text.substr(0, at + 1), text.substr(at + line.size()), true};
}

}  // namespace kinalign
