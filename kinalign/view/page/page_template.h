// SPDX-License-Identifier: Apache-2.0
// Fills the constant template of a page with texts. Also makes the policy that prevents a browser
// from loading anything else.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace kinalign {

/// HTML by its name in the template.
using PageParts = std::map<std::string, std::string, std::less<>>;

/// Returns the template with its parts: {{name}} becomes the part; {{#name}}...{{/name}} stays only
/// if the part exists and is not empty. The template is a constant, so its braces are not checked.
/// Parts are inserted unchanged, so they must be escaped before.
std::string filled(std::string_view frame, const PageParts& parts);

/// Returns a Content-Security-Policy that allows this script and this style and nothing else. It
/// also forbids base addresses and forms, so that HTML in a name could not send data.
std::string page_policy(std::string_view script, std::string_view style);

}  // namespace kinalign
