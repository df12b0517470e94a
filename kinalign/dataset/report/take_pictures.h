// SPDX-License-Identifier: Apache-2.0
// One typical row of each take, for the small pictures of a data set's page.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/dataset/take_name.h"
#include "kinalign/view/page/take_page.h"

#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The bodies of each take, in the order of `names`. All bodies of a take are from one row (K = 1).
/// Seven rows are tried, from the middle outwards, and the first one with the most tracked joints
/// is used. A take that can't be read has no bodies. Uses ask_takes(), so no other thread may run.
std::vector<std::vector<PageBody>> typical_rows(FileSystem& files, const std::string& folder,
                                                const std::vector<TakeName>& names);

/// The bodies of one row as text, which a child process sends, and the parser of this text. The
/// parser leaves out bodies whose arrays do not fit together.
std::string bodies_json(const std::vector<PageBody>& bodies);
std::vector<PageBody> parse_bodies_json(std::string_view json);

}  // namespace kinalign
