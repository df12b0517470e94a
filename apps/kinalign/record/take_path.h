// SPDX-License-Identifier: Apache-2.0
// Chooses a file name for a new take that no other recording uses.
#pragma once

#include <string>

namespace kinalign {

/// Returns FOLDER/SUBJECT_ACTION_01.mcap, with the first number that no file or part of a recording
/// uses. If subject and action are empty, the name is FOLDER/take_01.mcap.
std::string free_take_path(const std::string& folder, const std::string& subject,
                           const std::string& action);

}  // namespace kinalign
