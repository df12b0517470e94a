// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/page/page_template.h"

#include "kinalign/core/hash.h"
#include "kinalign/view/page/packed_series.h"

#include <fmt/format.h>

namespace kinalign {

namespace {

std::string_view part_called(const PageParts& parts, std::string_view name) {
  const auto found = parts.find(name);
  return found == parts.end() ? std::string_view() : std::string_view(found->second);
}

/// Returns a hash as a Content-Security-Policy needs it: the bytes of a SHA-256 in Base64 (W3C,
/// Content Security Policy Level 3).
std::string policy_hash(std::string_view text) {
  Sha256 hash;
  hash.update(text);
  const std::string hex = hash.hex();
  std::string bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  }
  return "'sha256-" + base64(bytes) + "'";
}

}  // namespace

std::string filled(std::string_view frame, const PageParts& parts) {
  std::string out;
  while (!frame.empty()) {
    const std::size_t open = frame.find("{{");
    out += frame.substr(0, open);
    if (open == std::string_view::npos) break;
    frame.remove_prefix(open + 2);
    const std::size_t close = frame.find("}}");
    const std::string_view name = frame.substr(0, close);
    frame.remove_prefix(close + 2);
    if (!name.starts_with('#')) {
      out += part_called(parts, name);
      continue;
    }
    // The end is found by its name, so a block may contain blocks with other names.
    const std::string end = fmt::format("{{{{/{}}}}}", name.substr(1));
    const std::size_t behind = frame.find(end);
    if (!part_called(parts, name.substr(1)).empty()) {
      out += filled(frame.substr(0, behind), parts);
    }
    frame.remove_prefix(behind + end.size());
  }
  return out;
}

std::string page_policy(std::string_view script, std::string_view style) {
  return "default-src 'none'; base-uri 'none'; form-action 'none'; script-src " +
         policy_hash(script) + "; style-src " + policy_hash(style);
}

}  // namespace kinalign
