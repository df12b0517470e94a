// SPDX-License-Identifier: Apache-2.0
// Describes the content of an XDF file, and its problems.
#pragma once

#include "apps/kinalign/text/describe_file.h"

#include "kinalign/formats/xdf/xdf.h"

namespace kinalign {

/// With Names::yes the text lists every channel's label and unit.
Description describe_xdf(const std::string& path, const XdfSurvey& survey, Names names);

/// The findings: damage, stamps that are no numbers or step back, clocks that were reset, missing
/// streams, samples or clock offsets.
Findings judge_xdf(const std::string& path, const XdfSurvey& survey);

}  // namespace kinalign
