// SPDX-License-Identifier: Apache-2.0
// A take's facts and its report as lines for people. Another program may have written the report,
// so no member is trusted: members of a wrong type are left out.
#pragma once

#include "apps/kinalign/text/describe_file.h"

#include "kinalign/core/error.h"

#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The text about a take. `json`: the output of `kinalign info take.h5 --json`.
std::string take_text(const std::string& json, Names names);

/// Reads the findings from a report of schema kinalign.report/1. `path`: the take's file.
Result<Findings> report_findings(const std::string& report, const std::string& path);

/// A mark in words: "start dance at 1.234 s, by call".
std::string mark_words(std::string_view kind, std::string_view text, double at_s,
                       std::string_view source);

/// The names as indented lines below a stream, wrapped at 80 columns.
std::string name_lines(const std::vector<std::string>& names);

}  // namespace kinalign
