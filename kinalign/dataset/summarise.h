// SPDX-License-Identifier: Apache-2.0
// Summaries out of the takes themselves, and what is wrong with their rows.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/dataset/take_summary.h"

#include <functional>
#include <string>
#include <vector>

namespace kinalign {

class TakeReader;

/// Calls `ask` with each take of a data set, in the order of `names`, and hands on its texts. HDF5
/// can crash on a hostile file: takes are opened in a child process (formats/take/guarded.h), so no
/// other thread may run. A take on which the child ends is a failure, the others are asked all the
/// same. The texts are not to be trusted.
std::vector<Result<std::string>> ask_takes(
    FileSystem& files, const std::string& folder, const std::vector<TakeName>& names,
    const std::function<Result<std::string>(TakeReader&)>& ask);

/// The summary of a take that is open, without hash and length.
Result<TakeSummary> summary_of(TakeReader& reader);

/// Puts hash and length of the take's file into its summary and writes it beside the take.
Result<TakeSummary> keep_summary(FileSystem& files, const std::string& folder, const TakeName& name,
                                 TakeSummary summary);

/// The summary of each take, by ask_takes(), without hash and length.
std::vector<Result<TakeSummary>> summarise_takes(FileSystem& files, const std::string& folder,
                                                 const std::vector<TakeName>& names);

/// Findings of ContentCheck in all rows of a take at that rate; in a child process, too.
Result<Findings> check_rows(FileSystem& files, const std::string& folder, const TakeName& name,
                            double rate_hz);

}  // namespace kinalign
