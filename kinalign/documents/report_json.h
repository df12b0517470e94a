// SPDX-License-Identifier: Apache-2.0
// The report as JSON, schema kinalign.report/1. The names of members state the units.
#pragma once

#include "kinalign/take/report.h"

#include <string>
#include <string_view>

namespace kinalign {

std::string report_json(const AlignmentReport& report);

/// Parses a report. A member that is missing or of another type keeps its default. Fails if the
/// text is no JSON. `path`: the take's.
/// Strict reading would refuse takes of other versions and programs, whose samples are good.
Result<AlignmentReport> parse_report_json(std::string_view text, const std::string& path);

/// An array of findings, the same in reports and in `kinalign check --json`.
std::string findings_json(const Findings& findings);
/// Reads the text of findings_json(). Anything that is wrong in it is left out.
Findings parse_findings_json(std::string_view text);

}  // namespace kinalign
