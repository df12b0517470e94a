// SPDX-License-Identifier: Apache-2.0
// The fixed frame of a page filled with words, and the policy that keeps a browser from loading
// more.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace kinalign {

/// HTML by the name of its place in the frame.
using PageParts = std::map<std::string, std::string, std::less<>>;

/// Puts parts into a frame: {{name}} becomes the part; {{#name}}...{{/name}} stays only where the
/// part is there and not empty.
std::string filled(std::string_view frame, const PageParts& parts);

/// A Content-Security-Policy that allows this script and this style and nothing else.
std::string page_policy(std::string_view script, std::string_view style);

}  // namespace kinalign
