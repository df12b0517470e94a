// SPDX-License-Identifier: Apache-2.0
// Chooses a free file name for a take, which no file or part of another recording has.
#pragma once

#include <string>

namespace kinalign {

/// FOLDER/SUBJECT_ACTION_01.mcap, with the next number that neither a file nor the parts of a
/// recording have. "take" replaces the words if both are empty.
std::string free_take_path(const std::string& folder, const std::string& subject,
                           const std::string& action);

}  // namespace kinalign
