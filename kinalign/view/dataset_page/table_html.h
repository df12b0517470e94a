// SPDX-License-Identifier: Apache-2.0
// A table on a page.
#pragma once

#include "kinalign/view/table.h"

#include <string>

namespace kinalign {

/// A <figure> with the table, which scrolls sideways where it is too wide, and its caption.
std::string table_html(const Table& table);

}  // namespace kinalign
