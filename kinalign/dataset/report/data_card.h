// SPDX-License-Identifier: Apache-2.0
// The data card: README.md of a data set, written from its index for those who use the data.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/dataset/index.h"

#include <string>
#include <string_view>

namespace kinalign {

/// Stands in the card's first lines: a file that has it may be replaced.
inline constexpr std::string_view data_card_mark = "<!-- data card of kinalign";

/// The card's text. `old_card`: path of the card that stands there; what its readers wrote between
/// "<!-- own text -->" and "<!-- end -->" is kept. Fails where such a text has no end.
Result<std::string> data_card(FileSystem& files, const DatasetIndex& index,
                              const std::string& folder, const std::string& old_card,
                              const std::string& software);

}  // namespace kinalign
