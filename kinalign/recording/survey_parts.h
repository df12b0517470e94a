// SPDX-License-Identifier: Apache-2.0
// What is in a recording of several files: survey.h says it of one.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/recording/parts.h"
#include "kinalign/recording/survey.h"

#include <vector>

namespace kinalign {

/// The surveys of all files of a recording as one: channels, their messages, each once (bytes and
/// unchecked messages as they stand in all), numbers that are missing in all of them, the last
/// counts, the end, marks, steps of the wall clock, which files are torn, and what is wrong with
/// any. `surveys`: one of each part.
RecordingSurvey join_surveys(const RecordingParts& parts, std::vector<RecordingSurvey> surveys);

/// The same of files that are read for it.
Result<RecordingSurvey> survey_parts(FileSystem& files, const RecordingParts& parts,
                                     const Progress& progress);

}  // namespace kinalign
