// SPDX-License-Identifier: Apache-2.0
// Makes a take's page: one HTML text without external files. The same TakePage always gives the
// same text.
#pragma once

#include "kinalign/view/page/take_page.h"

#include <string>
#include <string_view>

namespace kinalign {

/// Escapes text for HTML elements and quoted attributes. Bytes that are not UTF-8 become U+FFFD.
/// Every text from a file or a user must be escaped, because names of takes and streams may contain
/// HTML.
std::string escaped(std::string_view text);

/// Fails if libraries of the script were missing when kinalign was built.
Result<std::string> page_html(const TakePage& page);

}  // namespace kinalign
