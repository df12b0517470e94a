// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace kinalign {

/// Writes JSON as text. The JSON (of the library nlohmann) may contain text from files, and the
/// library throws at bytes that are not UTF-8. Such bytes become U+FFFD here. The default is one
/// line; with an indent of 0 or more each member has its own line.
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace kinalign
