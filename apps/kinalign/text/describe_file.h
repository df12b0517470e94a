// SPDX-License-Identifier: Apache-2.0
// The content of a file, as lines for people and as JSON.
#pragma once

#include "apps/cli/verb.h"

#include "kinalign/formats/xdf/xdf.h"
#include "kinalign/recording/parts.h"
#include "kinalign/recording/survey.h"
#include "kinalign/take/recording.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace kinalign {

/// Both members describe the same content. The text is made harmless when it is printed.
struct Description {
  std::string text;  // lines
  std::string json;  // an object
};

/// Names::yes lists every joint's and node's name: --verbose.
enum class Names { no, yes };

Description describe_recording(const std::string& path, const Recording& recording, Names names);

Description describe_survey(const std::string& path, const RecordingSurvey& survey,
                            const RecordingParts& parts);
/// With Names::yes the text lists every channel's label and unit.
Description describe_survey(const std::string& path, const XdfSurvey& survey, Names names);

/// A line of a description: "  format      MCAP".
std::string fact_line(std::string_view name, const std::string& value);
/// "  size        1.2 MB"
std::string size_line(std::uint64_t bytes);
/// "  2 findings: see kinalign check PATH": `check` explains them and their repair. Empty without
/// findings.
std::string findings_line(std::size_t count, const std::string& path);

/// "points, 25 joints"
std::string contents_line(const RecordedStream& stream);

/// "kinect.csv: read as points, 25 joints, 1785 samples"
std::string read_as(const RecordedStream& stream);

/// Opens the take in a child process.
Result<Description> describe_take(FileSystem& files, const std::string& path, Names names);

/// The file and the expectation for an error about a take that HDF5 can't read.
/// The same words for every verb, so a damaged take gives the same message everywhere.
Error blame(const std::string& path);

/// The findings as lines, the most severe first: "warning walk.bvh:12: expected ...". Control
/// characters are removed; colours are the console's.
std::string finding_lines(Findings findings, const Console& console);

}  // namespace kinalign
