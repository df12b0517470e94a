// SPDX-License-Identifier: Apache-2.0
// The formats that store one take, or one of its streams, in a file.
#pragma once

#include "kinalign/dataset/export/exported_take.h"

#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The outcome of writing one take. Streams that were left out or failed are reported; they do not
/// fail the export.
struct FilesMade {
  std::vector<std::string> paths;
  std::vector<std::string> left_out;  // "imu: the format holds points"
  std::vector<Error> failed;          // streams that could not be written
};

/// Writes files whose paths begin with `stem`: "out/sub-03/sub-03_task-S2A03_run-01". `take_path`:
/// the take's own file, for writers that read it themselves.
using WriteTake = Result<FilesMade> (*)(ExportedTake& take, FileSystem& files,
                                        const std::string& take_path, const std::string& stem);

/// A row of the table of formats: its texts for users, and its writer.
struct TakeFormat {
  std::string_view name;   // "trc"
  std::string_view title;  // for people
  std::string_view lost;   // content that no file of this format can store; empty: none
  std::string_view needs;  // required content of a take: "a skeleton"
  WriteTake write;
};

const std::vector<TakeFormat>& take_formats();
/// The row of that format; nullptr if no format of single takes has the name.
const TakeFormat* find_take_format(std::string_view name);

}  // namespace kinalign
