// SPDX-License-Identifier: Apache-2.0
// Surveys a recording of several files, see survey.h.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/recording/parts.h"
#include "kinalign/recording/survey.h"

#include <vector>

namespace kinalign {

/// Joins the surveys of all files of a recording: channels, messages (each counted once; bytes and
/// unchecked messages are summed), numbers missing in all files, the last counts, the end, marks,
/// steps of the wall clock, truncated files, and the findings of all. `surveys`: one for each part.
RecordingSurvey join_surveys(const RecordingParts& parts, std::vector<RecordingSurvey> surveys);

/// The same, but reads the files first.
Result<RecordingSurvey> survey_parts(FileSystem& files, const RecordingParts& parts,
                                     const Progress& progress);

}  // namespace kinalign
