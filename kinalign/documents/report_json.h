// SPDX-License-Identifier: Apache-2.0
// The report as JSON, schema kinalign.report/1: units stand in the names.
#pragma once

#include "kinalign/take/report.h"

#include <string>

namespace kinalign {

std::string report_json(const AlignmentReport& report);

/// An array of findings as it stands in reports and in `kinalign check --json`.
std::string findings_json(const Findings& findings);

}  // namespace kinalign
