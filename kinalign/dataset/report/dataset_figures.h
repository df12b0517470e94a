// SPDX-License-Identifier: Apache-2.0
// Makes the content of a data set's page from its index.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/dataset/index.h"
#include "kinalign/view/dataset_page/dataset_page.h"

#include <string>
#include <vector>

namespace kinalign {

/// Limit of the number of takes in the page's table: 2,000 rows with pictures are 3 MB.
inline constexpr std::size_t most_shown_takes = 2000;

/// All of the page except pictures and links. The takes are sorted by verdict (bad, usable, good),
/// then by errors, warnings, distance from the reference, valid samples and name.
Result<DatasetPage> dataset_figures(const DatasetIndex& index, const std::string& folder,
                                    std::size_t most = most_shown_takes);

/// Adds the pictures of takes. No other thread may run, because a child process is forked.
void add_pictures(FileSystem& files, const std::string& folder, DatasetPage& page);

}  // namespace kinalign
