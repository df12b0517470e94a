// SPDX-License-Identifier: Apache-2.0
// The texts and tables of a take's page. Each function gives HTML.
#pragma once

#include "kinalign/view/page/take_page.h"

#include <string>
#include <string_view>

namespace kinalign {

/// One line: subject, action, length, frames, and the date if stamps have one.
std::string facts_text(const TakePage& page);
/// "Good: all 3 streams", or the names of bad and usable streams.
std::string headline(const TakePage& page);
Quality quality_of(const TakePage& page);  // the worst stream's
/// A list item for each stream, with its reason, in the stream's colour.
std::string verdict_items(const TakePage& page);
/// At most three list items; worst_title() is the heading above them.
std::string worst_items(const TakePage& page);
std::string worst_title(const TakePage& page);
std::string numbers_list(const TakePage& page);  // the few numbers of the first screen
bool has_axes(const TakePage& page);             // the player shows axes of nodes
/// Only colours and marks that the player of this take can show.
std::string legend(const TakePage& page);
/// The caption of figure 1.
std::string player_caption(const TakePage& page);
/// One row for each stream of the report.
std::string time_table(const TakePage& page);
/// The caption of figure 4, the paper's figure 7. Empty without a detail.
std::string detail_caption(const TakePage& page);
/// How each stream was moved, and which streams stay in their own space.
std::string space_text(const TakePage& page);
/// The captions of figures 5 and 6. Empty if no stream was moved.
std::string table5_caption(const TakePage& page);
std::string residual_caption(const TakePage& page);
/// Figure 8, and the table below it, which is empty if the Kinect's place is unknown.
std::string floor_caption(const TakePage& page);
std::string zone_table(const TakePage& page);
/// The caption of figure 10. Empty without a Kinect's bones.
std::string bones_caption(const TakePage& page);
/// The method of the comparison, and the nodes whose bone was not found by name.
std::string node_text(const TakePage& page);
std::string node_table(const TakePage& page);
/// The text of figures 11 and 12; empty without raw samples.
std::string raw_nodes_text(const TakePage& page);
/// The findings of alignment, with advice where there is some.
std::string findings_list(const TakePage& page);
/// Empty if the take does not name its inputs.
std::string inputs_table(const TakePage& page);
/// How many of the take's rows the page stores, and which figures count all of them.
std::string thinning_text(const TakePage& page);

}  // namespace kinalign
