// SPDX-License-Identifier: Apache-2.0
// The first pass over a BVH: hashed, its frames counted without reading their numbers.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/formats/clip_survey.h"

#include <string>

namespace kinalign {

/// The numbers are read only where counting words does not give the frames that the file promises,
/// or where the file ends within the last one.
Result<ClipSurvey> survey_bvh(FileSystem& files, const std::string& path, const BvhOptions& options,
                              const Progress& progress);

}  // namespace kinalign
