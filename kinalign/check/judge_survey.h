// SPDX-License-Identifier: Apache-2.0
// Judges files by their surveys. Pure functions: no file is read again.
#pragma once

#include "kinalign/formats/clip_survey.h"
#include "kinalign/formats/xdf/xdf.h"
#include "kinalign/recording/survey.h"
#include "kinalign/take/manifest.h"

#include <string>

namespace kinalign {

/// The problems of a recording: damage, a missing end, messages missing in its own numbering,
/// devices that sent nothing, data that was not recorded or can't be aligned.
Findings judge_survey(const std::string& path, const RecordingSurvey& survey);

/// The problems of an XDF file: damage, stamps that are no numbers or step back, clocks that were
/// reset, missing streams, samples or clock offsets.
Findings judge_survey(const std::string& path, const XdfSurvey& survey);

/// A warning if a skeleton's length differs from the time between the clicks on record and stop
/// (start_ns and end_ns) by more than two steps.
Findings judge_survey(const ClipSurvey& survey, const StreamOptions& options);

}  // namespace kinalign
