// SPDX-License-Identifier: Apache-2.0
// A table on a page.
#pragma once

#include "kinalign/view/table.h"

#include <string>

namespace kinalign {

/// A <figure> with the table and its caption. A wide table scrolls sideways.
/// Pages of benchmarks use it, too.
std::string table_html(const Table& table);

}  // namespace kinalign
