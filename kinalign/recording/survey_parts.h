// SPDX-License-Identifier: Apache-2.0
// What is in a recording of several files: recording_survey.h says it of one.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/recording/parts.h"
#include "kinalign/recording/survey.h"

namespace kinalign {

/// A survey of the first of these with what those behind add to it: channels, their messages, each
/// once (bytes and what is unchecked as they stand in all), numbers that are missing in all of
/// them, the last counts, the end, marks, steps of the wall clock, which are torn, and what is
/// wrong with any.
Result<RecordingSurvey> survey_parts(FileSystem& files, const RecordingParts& parts,
                                     const Progress& progress);

}  // namespace kinalign
