// SPDX-License-Identifier: Apache-2.0
// Where a take's recording goes: a name that is free, and free of what another recording left.
#pragma once

#include <string>

namespace kinalign {

/// FOLDER/SUBJECT_ACTION_01.mcap, with the next number that neither a file nor the parts of one
/// have; "take" where neither is said.
std::string free_take_path(const std::string& folder, const std::string& subject,
                           const std::string& action);

}  // namespace kinalign
