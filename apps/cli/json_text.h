// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace kinalign {

/// JSON (nlohmann's) of text that may come from files: bytes that are not UTF-8 become U+FFFD.
/// The JSON library would throw at such bytes otherwise. The default is one line; an indent of 0 or
/// more gives a line for each member.
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace kinalign
