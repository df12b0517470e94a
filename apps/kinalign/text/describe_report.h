// SPDX-License-Identifier: Apache-2.0
// A take's facts and its report as lines for people. The report may come from another program:
// nothing in it is trusted, and members of a wrong type are left out.
// it is trusted, what is not of its type is left out.
#pragma once

#include "apps/kinalign/text/describe_file.h"

#include "kinalign/core/error.h"

#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// `json`: the output of `kinalign info take.h5 --json`.
std::string take_text(const std::string& json, Names names);

/// The findings in a report of schema kinalign.report/1. `path`: the take's file.
Result<Findings> report_findings(const std::string& report, const std::string& path);

/// "start dance at 1.234 s, by call"
std::string mark_words(std::string_view kind, std::string_view text, double at_s,
                       std::string_view source);

/// The names as lines below a stream, wrapped at 80 columns.
std::string name_lines(const std::vector<std::string>& names);

}  // namespace kinalign
