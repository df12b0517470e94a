// SPDX-License-Identifier: Apache-2.0
// Splits that name takes which are not there any more, for people and as JSON.
#pragma once

#include "kinalign/dataset/changes/split_files.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace kinalign {

/// Lines; empty where there are none.
std::string splits_text(const std::vector<SplitFile>& splits);
nlohmann::ordered_json splits_json(const std::vector<SplitFile>& splits);

}  // namespace kinalign
