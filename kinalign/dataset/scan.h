// SPDX-License-Identifier: Apache-2.0
// Which files of which takes lie in a data set's folder.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/dataset/take_name.h"
#include "kinalign/dataset/take_summary.h"

#include <map>
#include <string>

namespace kinalign {

/// Longer files of these kinds are refused.
inline constexpr std::size_t longest_summary = std::size_t{1} << 20;
inline constexpr std::size_t longest_manifest = std::size_t{4} << 20;

struct TakeFiles {
  bool manifest = false, take = false, summary = false;
};

/// Fails where the folder, or one in it, can't be read.
Result<std::map<TakeName, TakeFiles>> scan_takes(const std::string& folder);
/// The same of one person alone, whose folder is there.
Result<std::map<TakeName, TakeFiles>> scan_takes(const std::string& folder,
                                                 const std::string& subject);

Result<TakeSummary> read_summary(FileSystem& files, const std::string& folder,
                                 const TakeName& name);

}  // namespace kinalign
