// SPDX-License-Identifier: Apache-2.0
// A take's page: one HTML text that needs nothing beside it. The same TakePage gives the same text.
#pragma once

#include "kinalign/view/page/take_page.h"

#include <string>
#include <string_view>

namespace kinalign {

/// Text as HTML shows it, in elements and in quoted attributes; bytes that are no UTF-8 become
/// U+FFFD.
std::string escaped(std::string_view text);

/// Fails where the libraries of the script were missing when kinalign was built.
Result<std::string> page_html(const TakePage& page);

}  // namespace kinalign
