// SPDX-License-Identifier: Apache-2.0
// Fills the fixed template of a page with texts, and makes the policy that keeps a browser from
// loading anything else.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace kinalign {

/// HTML by the name of its place in the template.
using PageParts = std::map<std::string, std::string, std::less<>>;

/// Puts parts into a template: {{name}} becomes the part; {{#name}}...{{/name}} stays only if the
/// part exists and is not empty.
/// The frame is a fixed asset, so it is not checked for braces that do not match. Parts are put in
/// as they are, so they must be escaped before.
std::string filled(std::string_view frame, const PageParts& parts);

/// A Content-Security-Policy that allows this script and this style and nothing else.
/// Base addresses and forms are forbidden, too, so a name that slips through can't send anything.
std::string page_policy(std::string_view script, std::string_view style);

}  // namespace kinalign
