// SPDX-License-Identifier: Apache-2.0
// Describes the content of a file: as lines for people and as JSON.
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

/// Text and JSON describe the same content. Control characters are removed from the text when it is
/// printed.
struct Description {
  std::string text;  // lines
  std::string json;  // a JSON object
};

/// Names::yes lists the name of every joint and node, for --verbose.
enum class Names { no, yes };

Description describe_recording(const std::string& path, const Recording& recording, Names names);

Description describe_survey(const std::string& path, const RecordingSurvey& survey,
                            const RecordingParts& parts);
/// With Names::yes the text lists every channel's label and unit.
Description describe_survey(const std::string& path, const XdfSurvey& survey, Names names);

/// One line of a description: "  format      MCAP".
std::string fact_line(std::string_view name, const std::string& value);
/// The line about a file's size: "  size        1.2 MB".
std::string size_line(std::uint64_t bytes);
/// The line "  2 findings: see kinalign check PATH"; the verb `check` explains the findings and
/// their repair. Empty without findings.
std::string findings_line(std::size_t count, const std::string& path);

/// The contents of a stream: "points, 25 joints".
std::string contents_line(const RecordedStream& stream);

/// The contents of a stream with its file: "kinect.csv: read as points, 25 joints, 1785 samples".
std::string read_as(const RecordedStream& stream);

/// Describes a take. A child process opens it, since HDF5 may crash at a damaged file.
Result<Description> describe_take(FileSystem& files, const std::string& path, Names names);

/// The error for a take that HDF5 can't read, for callers that add what was found. Every verb uses
/// the same words.
Error blame(const std::string& path);

/// The findings as lines, the most severe first: "warning walk.bvh:12: expected ...". Control
/// characters are removed. The console decides about colours.
std::string finding_lines(Findings findings, const Console& console);

}  // namespace kinalign
