// SPDX-License-Identifier: Apache-2.0
// The result of an alignment in the few lines that people read first, the worst first.
#pragma once

#include "kinalign/take/report.h"
#include "kinalign/view/report_words.h"

#include <string>

namespace kinalign {

class Console;

/// `out` is the take's file; empty: nothing was written. Colours are the console's.
std::string summary(const AlignmentReport& report, const std::string& out, const Console& console);

}  // namespace kinalign
