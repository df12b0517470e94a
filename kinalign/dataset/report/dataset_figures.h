// SPDX-License-Identifier: Apache-2.0
// From a data set's index to what its page shows.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/dataset/index.h"
#include "kinalign/view/dataset_page/dataset_page.h"

#include <string>
#include <vector>

namespace kinalign {

/// The page's table has at most so many takes: 2,000 rows with their pictures are 3 MB.
inline constexpr std::size_t most_shown_takes = 2000;

/// All of the page but pictures and links. The worst takes come first: bad, usable, good; then by
/// errors, warnings, distance from the reference, valid samples and name.
Result<DatasetPage> dataset_figures(const DatasetIndex& index, const std::string& folder,
                                    std::size_t most = most_shown_takes);

/// Adds the takes' pictures. No other thread may run.
void add_pictures(FileSystem& files, const std::string& folder, DatasetPage& page);

}  // namespace kinalign
