// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace kinalign {

/// JSON (nlohmann's) of text that may come from files: bytes that are not UTF-8 become U+FFFD.
/// One line, as --json promises. The JSON library would throw at such bytes otherwise.
template <class Json>
std::string json_text(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace kinalign
