// SPDX-License-Identifier: Apache-2.0
// The report as JSON, schema kinalign.report/1: units stand in the names.
#pragma once

#include "kinalign/take/report.h"

#include <string>
#include <string_view>

namespace kinalign {

std::string report_json(const AlignmentReport& report);

/// The report back, as far as its JSON is one: what is missing or of another type keeps its
/// default. Fails where the text is no JSON. `path` is the take's.
Result<AlignmentReport> parse_report_json(std::string_view text, const std::string& path);

/// An array of findings as it stands in reports and in `kinalign check --json`.
std::string findings_json(const Findings& findings);

}  // namespace kinalign
