// SPDX-License-Identifier: Apache-2.0
// What is in a file, as lines for people and as JSON.
#pragma once

#include "apps/kinalign/verb.h"

#include "kinalign/take/recording.h"

#include <string>

namespace kinalign {

struct Description {
  std::string text;  // lines
  std::string json;  // an object
};

Description describe_recording(const std::string& path, const Recording& recording);

/// "points, 25 joints"
std::string contents_line(const RecordedStream& stream);

/// Opens the take in a child process.
Result<Description> describe_take(FileSystem& files, const std::string& path);

/// "warning walk.bvh:12: expected ...": lines of what was found, worst first.
std::string finding_lines(Findings findings);

}  // namespace kinalign
