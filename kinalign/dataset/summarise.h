// SPDX-License-Identifier: Apache-2.0
// Makes summaries from the takes themselves, and checks their rows.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/dataset/take_summary.h"

#include <functional>
#include <string>
#include <vector>

namespace kinalign {

/// Declared in formats/take, whose header only the source file includes.
class TakeReader;

/// Calls `ask` with each take of a data set, in the order of `names`, and returns its texts. HDF5
/// can crash on a hostile file, so takes are opened in a child process (formats/take/guarded.h),
/// and no other thread may run. If the child process crashes on a take, that take is a failure and
/// the others are still asked. The texts must not be trusted.
std::vector<Result<std::string>> ask_takes(
    FileSystem& files, const std::string& folder, const std::vector<TakeName>& names,
    const std::function<Result<std::string>(TakeReader&)>& ask);

/// The summary of an open take, without the hash and the size of its file.
Result<TakeSummary> summary_of(TakeReader& reader);

/// Adds the hash and the size of the take's file to its summary, and writes the summary's file.
Result<TakeSummary> keep_summary(FileSystem& files, const std::string& folder, const TakeName& name,
                                 TakeSummary summary);

/// The summary of each take, found by ask_takes(), without the hash and the size of its file.
std::vector<Result<TakeSummary>> summarise_takes(FileSystem& files, const std::string& folder,
                                                 const std::vector<TakeName>& names);

/// The findings of ContentCheck (contents.h) about all rows of a take with that rate. Also runs in
/// a child process.
Result<Findings> check_rows(FileSystem& files, const std::string& folder, const TakeName& name,
                            double rate_hz);

}  // namespace kinalign
