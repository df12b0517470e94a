// SPDX-License-Identifier: Apache-2.0
// Describes an alignment in the few lines that people read first. The worst facts come first.
#pragma once

#include "kinalign/take/report.h"
#include "kinalign/view/report_words.h"

#include <string>

namespace kinalign {

class Console;

/// The summary of an alignment. `out`: the take's file; empty if no file was written. The console
/// decides about colours.
std::string summary(const AlignmentReport& report, const std::string& out, const Console& console);

}  // namespace kinalign
