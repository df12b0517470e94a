// SPDX-License-Identifier: Apache-2.0
// Edits TOML texts that a user wrote. Everything except the edited words is kept, also comments.
// Each edit is checked by parsing the result.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/dataset/take_name.h"

#include <string>
#include <string_view>

namespace kinalign {

/// The text of dataset.toml with another id of one table: "subject" or "action", as in [subject.03]
/// and [subject.03.segments_m]. If the id is written in another form, this fails with the advice to
/// change it by hand. `file` is for messages. The order of the tables and all comments are kept.
Result<std::string> with_id_renamed(const std::string& toml, const std::string& table,
                                    const std::string& from, const std::string& to,
                                    const std::string& file);

/// A take's manifest under another name: subject, action and paths of raw files below sourcedata/
/// are changed. A text that can't be edited is replaced by a new one without comments.
Result<std::string> manifest_of_renamed(const std::string& toml, const TakeName& from,
                                        const TakeName& to, const std::string& file);

}  // namespace kinalign
