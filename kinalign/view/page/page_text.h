// SPDX-License-Identifier: Apache-2.0
// The words and tables of a page. Each function gives HTML.
#pragma once

#include "kinalign/view/page/take_page.h"

#include <string>
#include <string_view>

namespace kinalign {

std::string facts_text(const TakePage& page);
std::string headline(const TakePage& page);
Quality quality_of(const TakePage& page);  // of the worst stream
std::string verdict_items(const TakePage& page);
std::string worst_items(const TakePage& page);
std::string worst_title(const TakePage& page);
std::string numbers_list(const TakePage& page);  // the few figures of the first screen
bool has_axes(const TakePage& page);             // the player shows the nodes'
std::string legend(const TakePage& page);
std::string player_caption(const TakePage& page);
std::string time_table(const TakePage& page);
std::string detail_caption(const TakePage& page);
std::string space_text(const TakePage& page);
std::string table5_caption(const TakePage& page);
std::string residual_caption(const TakePage& page);
std::string floor_caption(const TakePage& page);
std::string zone_table(const TakePage& page);
std::string bones_caption(const TakePage& page);
std::string node_text(const TakePage& page);
std::string node_table(const TakePage& page);
std::string raw_nodes_text(const TakePage& page);  // of figures 11 and 12; empty: no raw samples
std::string findings_list(const TakePage& page);
std::string inputs_table(const TakePage& page);
std::string thinning_text(const TakePage& page);

}  // namespace kinalign
