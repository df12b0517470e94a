// SPDX-License-Identifier: Apache-2.0
// A table as HTML.
#pragma once

#include "kinalign/view/table.h"

#include <string>

namespace kinalign {

/// Returns a <figure> with the table and its caption. A wide table scrolls sideways. The page of a
/// benchmark uses this function too.
std::string table_html(const Table& table);

}  // namespace kinalign
