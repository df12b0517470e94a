// SPDX-License-Identifier: Apache-2.0
// What is in an XDF file, and what is wrong with it.
#pragma once

#include "apps/kinalign/text/describe_file.h"

#include "kinalign/formats/xdf/xdf.h"

namespace kinalign {

/// With `names` every channel's label and unit stands there.
Description describe_xdf(const std::string& path, const XdfSurvey& survey, Names names);

/// Damage, stamps that are none or step back, clocks that began anew, what is absent.
Findings judge_xdf(const std::string& path, const XdfSurvey& survey);

}  // namespace kinalign
