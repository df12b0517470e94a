// SPDX-License-Identifier: Apache-2.0
// Surveys a recording without its devices.
#pragma once

#include "kinalign/recording/survey.h"

namespace kinalign {

/// Surveys all parts of the recording to which the file belongs.
inline Result<RecordingSurvey> survey_recording(FileSystem& files, const std::string& path,
                                                const Progress& progress = {}) {
  const RecordingParts parts = KA_TRY(find_parts(files, {path}));
  RecordStream stream = KA_TRY(RecordStream::open(files, parts, progress));
  RecordingSurveyor surveyor;
  while (const McapRecord* record = KA_TRY(stream.next())) surveyor.take(*record);
  return surveyor.finish(path, stream);
}

}  // namespace kinalign
