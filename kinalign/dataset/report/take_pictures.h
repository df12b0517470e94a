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

/// The bodies of each take, in the order of `names`, all from one row (K = 1): among seven rows,
/// from the middle outwards, the first with the most tracked joints. A take that can't be read has
/// no bodies. Uses ask_takes(), so no other thread may run.
std::vector<std::vector<PageBody>> typical_rows(FileSystem& files, const std::string& folder,
                                                const std::vector<TakeName>& names);

/// The text of one row's bodies, which a child process sends, and its parser. The parser trusts
/// nothing: bodies whose arrays do not fit are left out.
std::string bodies_json(const std::vector<PageBody>& bodies);
std::vector<PageBody> parse_bodies_json(std::string_view json);

}  // namespace kinalign
