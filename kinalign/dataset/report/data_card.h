// SPDX-License-Identifier: Apache-2.0
// The data card: README.md of a data set, made from its index for the users of the data.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/dataset/index.h"

#include <string>
#include <string_view>

namespace kinalign {

/// This text is in the first lines of every card. A file that has it may be replaced.
inline constexpr std::string_view data_card_mark = "<!-- data card of kinalign";

/// The text of the card. `old_card`: the path of an existing card. The user's text between "<!--
/// own text -->" and "<!-- end -->" in it is kept. Fails if such a text has no end, or if the old
/// card can't be read, because the user's text would be lost.
Result<std::string> data_card(FileSystem& files, const DatasetIndex& index,
                              const std::string& folder, const std::string& old_card,
                              const std::string& software);

}  // namespace kinalign
