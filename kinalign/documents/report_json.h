// SPDX-License-Identifier: Apache-2.0
// The report of an alignment as JSON, schema kinalign.report/1. The names of members include the
// units.
#pragma once

#include "kinalign/take/report.h"

#include <string>
#include <string_view>

namespace kinalign {

std::string report_json(const AlignmentReport& report);

/// Parses a report. A member that is missing or has another type gets its default, because takes of
/// other versions and programs should still be readable. Fails if the text is not JSON. `path`:
/// path of the take.
Result<AlignmentReport> parse_report_json(std::string_view text, const std::string& path);

/// Returns findings as a JSON array, as in reports and in `kinalign check --json`.
std::string findings_json(const Findings& findings);
/// Parses the text of findings_json(). Wrong parts are ignored.
Findings parse_findings_json(std::string_view text);

}  // namespace kinalign
