// SPDX-License-Identifier: Apache-2.0
// The texts and tables of a take's page. Each function returns HTML.
#pragma once

#include "kinalign/view/page/take_page.h"

#include <string>
#include <string_view>

namespace kinalign {

/// One line: subject, action, length, frames, and the date if the stamps have a date.
std::string facts_text(const TakePage& page);
/// "Good: all 3 streams", or the names of bad and usable streams.
std::string headline(const TakePage& page);
Quality quality_of(const TakePage& page);  // the verdict of the worst stream
/// A list item with the reason for each stream, in the stream's colour.
std::string verdict_items(const TakePage& page);
/// At most three list items with the worst concerns; worst_title() returns their heading.
std::string worst_items(const TakePage& page);
std::string worst_title(const TakePage& page);
std::string numbers_list(const TakePage& page);  // numbers on the first screen
bool has_axes(const TakePage& page);             // whether the player shows axes of nodes
/// The legend of the player, with only the colours and marks that this take can have.
std::string legend(const TakePage& page);
/// The caption of figure 1.
std::string player_caption(const TakePage& page);
/// A table with one row for each stream of the report.
std::string time_table(const TakePage& page);
/// The caption of figure 4 (figure 7 of the HFUT-MMD paper). Empty without a detail.
std::string detail_caption(const TakePage& page);
/// States how each stream was moved, and which streams keep their own space.
std::string space_text(const TakePage& page);
/// The captions of figures 5 and 6. Empty if no stream was moved.
std::string table5_caption(const TakePage& page);
std::string residual_caption(const TakePage& page);
/// The caption of figure 8, and the table below it. The table is empty if the Kinect's position is
/// unknown.
std::string floor_caption(const TakePage& page);
std::string zone_table(const TakePage& page);
/// The caption of figure 10. Empty if the take has no bones of a Kinect.
std::string bones_caption(const TakePage& page);
/// Explains the comparison, and names the nodes whose bone was not found by name.
std::string node_text(const TakePage& page);
std::string node_table(const TakePage& page);
/// The text of figures 11 and 12. Empty without raw samples.
std::string raw_nodes_text(const TakePage& page);
/// The findings of alignment, with advice if there is any.
std::string findings_list(const TakePage& page);
/// The table of input files. Empty if the take does not name them.
std::string inputs_table(const TakePage& page);
/// States how many of the take's rows the page stores, and which figures use all rows.
std::string thinning_text(const TakePage& page);

}  // namespace kinalign
