// SPDX-License-Identifier: Apache-2.0
// Edits of TOML texts that a user wrote: everything but the edited words stays as it is, comments
// too. Each edit is checked by reading the result.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/dataset/take_name.h"

#include <string>
#include <string_view>

namespace kinalign {

/// dataset.toml with another id of a table: "subject" or "action", as in [subject.03] and
/// [subject.03.segments_m]. Fails where the id is written in another form, and says to change it by
/// hand. `file`: for messages.
Result<std::string> with_id_renamed(const std::string& toml, const std::string& table,
                                    const std::string& from, const std::string& to,
                                    const std::string& file);

/// A take's manifest under another name: subject, action and paths to raw files below sourcedata/
/// follow. A text that can't be edited so is written anew, without its comments.
Result<std::string> manifest_of_renamed(const std::string& toml, const TakeName& from,
                                        const TakeName& to, const std::string& file);

}  // namespace kinalign
