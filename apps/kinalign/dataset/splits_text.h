// SPDX-License-Identifier: Apache-2.0
// Reports splits that name takes which do not exist any more, as text and as JSON.
#pragma once

#include "kinalign/dataset/changes/split_files.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace kinalign {

/// The lines; empty without such splits.
/// A verb that changes names prints them, since it never edits a split: it may be part of published
/// results.
std::string splits_text(const std::vector<SplitFile>& splits);
nlohmann::ordered_json splits_json(const std::vector<SplitFile>& splits);

}  // namespace kinalign
