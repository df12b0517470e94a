// SPDX-License-Identifier: Apache-2.0
// A take's facts and its report as lines for people. The report may come from outside: nothing in
// it is trusted, what is not of its type is left out.
#pragma once

#include "apps/kinalign/text/describe_file.h"

#include "kinalign/core/error.h"

#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// `json`: what `kinalign info take.h5 --json` prints.
std::string take_text(const std::string& json, Names names);

/// What a report of schema kinalign.report/1 says was found; `path` is its take's.
Result<Findings> report_findings(const std::string& report, const std::string& path);

/// "start dance at 1.234 s, by call"
std::string mark_words(std::string_view kind, std::string_view text, double at_s,
                       std::string_view source);

/// Lines of names below a stream's.
std::string name_lines(const std::vector<std::string>& names);

}  // namespace kinalign
