// SPDX-License-Identifier: Apache-2.0
// Judges files by their surveys. These functions do not read the files again.
#pragma once

#include "kinalign/formats/clip_survey.h"
#include "kinalign/formats/xdf/xdf.h"
#include "kinalign/recording/survey.h"
#include "kinalign/take/manifest.h"

#include <string>

namespace kinalign {

/// Findings about a recording: damage, a missing end, gaps in the message numbers, devices that
/// sent nothing, and data that was not recorded or can't be aligned.
Findings judge_survey(const std::string& path, const RecordingSurvey& survey);

/// Findings about an XDF file: damage, stamps that are not numbers or go back, clocks that were
/// reset, and missing streams, samples or clock offsets.
Findings judge_survey(const std::string& path, const XdfSurvey& survey);

/// Warns if the length of a skeleton stream differs from the time between the clicks on record and
/// stop (start_ns and end_ns) by more than two steps.
Findings judge_survey(const ClipSurvey& survey, const StreamOptions& options);

}  // namespace kinalign
