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

/// The bodies of each take, in the order of `names`, with the same one row each (K = 1): among
/// seven rows, from the middle outwards, the first in which the most joints are tracked. A take
/// that can't be read has no bodies. By ask_takes(), so no other thread may run.
std::vector<std::vector<PageBody>> typical_rows(FileSystem& files, const std::string& folder,
                                                const std::vector<TakeName>& names);

/// The text of bodies of one row that a child process sends, and its reader, which trusts nothing
/// in it: bodies whose arrays do not fit are left out.
std::string bodies_json(const std::vector<PageBody>& bodies);
std::vector<PageBody> parse_bodies_json(std::string_view json);

}  // namespace kinalign
