// SPDX-License-Identifier: Apache-2.0
// The texts and tables of a take's page. Each function gives HTML.
#pragma once

#include "kinalign/view/page/take_page.h"

#include <string>
#include <string_view>

namespace kinalign {

std::string facts_text(const TakePage& page);
std::string headline(const TakePage& page);
Quality quality_of(const TakePage& page);  // the worst stream's
std::string verdict_items(const TakePage& page);
std::string worst_items(const TakePage& page);
std::string worst_title(const TakePage& page);
std::string numbers_list(const TakePage& page);  // the few numbers of the first screen
bool has_axes(const TakePage& page);             // the player shows axes of nodes
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
/// The text of figures 11 and 12; empty without raw samples.
std::string raw_nodes_text(const TakePage& page);
std::string findings_list(const TakePage& page);
std::string inputs_table(const TakePage& page);
std::string thinning_text(const TakePage& page);

}  // namespace kinalign
