// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/page/page_html.h"

#include "kinalign/core/utf8.h"
#include "kinalign/view/page/assets.h"
#include "kinalign/view/page/page_json.h"
#include "kinalign/view/page/page_template.h"
#include "kinalign/view/page/page_text.h"

#include <algorithm>

namespace kinalign {

namespace {

/// The template keeps a block if its part is not empty, whatever it contains.
std::string flag(bool on) { return on ? "yes" : ""; }

template <class Has>
std::string any_node(const TakePage& page, Has has) {
  return flag(std::any_of(page.nodes.begin(), page.nodes.end(), has));
}

/// All texts of the page, by the names of their places in the template.
/// Functions of page_text.h give HTML; plain texts are escaped here.
PageParts parts_of(const TakePage& page) {
  PageParts parts;
  // The policy has the hashes of exactly these two texts, so the page loads and runs nothing else.
  parts["policy"] = page_policy(page_script(), page_style());
  parts["software"] = escaped(page.software);
  parts["title"] = escaped(page.file) + ": " + std::string(to_string(quality_of(page)));
  parts["licences"] = page_licences();
  parts["style"] = page_style();
  parts["script"] = page_script();
  parts["data"] = page_json(page);
  parts["file"] = escaped(page.file);
  parts["facts"] = facts_text(page);
  parts["quality"] = to_string(quality_of(page));
  parts["headline"] = headline(page);
  parts["verdicts"] = verdict_items(page);
  parts["worst_title"] = worst_title(page);
  parts["worst"] = worst_items(page);
  parts["numbers"] = numbers_list(page);
  parts["legend"] = legend(page);
  parts["player_caption"] = player_caption(page);
  parts["time_table"] = time_table(page);
  parts["detail_caption"] = detail_caption(page);
  parts["space_text"] = space_text(page);
  parts["table5_caption"] = table5_caption(page);
  parts["residual_caption"] = residual_caption(page);
  parts["floor_caption"] = floor_caption(page);
  parts["zone_table"] = zone_table(page);
  parts["bones_caption"] = bones_caption(page);
  parts["node_text"] = node_text(page);
  parts["node_table"] = node_table(page);
  parts["findings"] = findings_list(page);
  parts["inputs"] = inputs_table(page);
  parts["thinning"] = thinning_text(page);
  return parts;
}

/// Sets which blocks of the template the page has.
/// A figure without data would be an empty frame, so its block is left out.
void put_flags(const TakePage& page, PageParts& parts) {
  const auto lane = [&](auto has) {
    return flag(std::any_of(page.lanes.begin(), page.lanes.end(), has));
  };
  parts["resampled"] = lane([](const PageLane& l) { return l.resampled; });
  parts["interval"] = lane([](const PageLane& l) { return l.interval_known; });
  // The caption of figure 3 says how many bins there are.
  parts["bins"] = page.lanes.empty() ? "0" : std::to_string(page.lanes.front().tracked.size());
  parts["points"] = flag(std::any_of(page.bodies.begin(), page.bodies.end(),
                                     [](const PageBody& b) { return b.kind == PageKind::points; }));
  parts["pairs"] = flag(std::any_of(page.spaces.begin(), page.spaces.end(),
                                    [](const PageSpace& s) { return !s.pairs.empty(); }));
  parts["zones"] = flag(!page.floors.empty());
  parts["bones"] = flag(!page.bones.empty());
  parts["detail"] = flag(!page.details.empty());
  parts["nodes"] = flag(!page.nodes.empty());
  parts["rate"] = any_node(page, [](const NodeFigures& n) { return n.has_rate; });
  parts["acceleration"] = any_node(page, [](const NodeFigures& n) { return n.has_acceleration; });
  parts["orientation"] = any_node(page, [](const NodeFigures& n) { return n.has_orientation; });
  parts["raw_nodes"] = raw_nodes_text(page);
  parts["axes"] = flag(has_axes(page));
  // One caption for all nodes: they are of one stream, which has gravity or not.
  const std::string gravity = any_node(page, [](const NodeFigures& n) { return n.has_gravity; });
  parts["gravity"] = gravity.empty() ? ", gravity removed" : ", gravity included";
  parts["rest"] = gravity.empty() ? "0" : "9.8 m/s²";
}

}  // namespace

// Apostrophes too, because attributes may be quoted by them.
std::string escaped(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const Character c = first_character(text);
    const std::string_view bytes = text.substr(0, c.bytes);
    text.remove_prefix(c.bytes);
    if (!c.code) {
      out += "\xEF\xBF\xBD";
    } else if (bytes == "&") {
      out += "&amp;";
    } else if (bytes == "<") {
      out += "&lt;";
    } else if (bytes == ">") {
      out += "&gt;";
    } else if (bytes == "\"") {
      out += "&quot;";
    } else if (bytes == "'") {
      out += "&#39;";
    } else {
      out += bytes;
    }
  }
  return out;
}

Result<std::string> page_html(const TakePage& page) {
  // The libraries of the script are embedded at build time; without them the page could not draw.
  if (!page_parts_missing().empty()) {
    return Failure(Error{"", 0, "a kinalign that was built with esbuild, libjs-three and node-d3",
                         "a kinalign without " + std::string(page_parts_missing())});
  }
  PageParts parts = parts_of(page);
  put_flags(page, parts);
  return filled(page_template(), parts);
}

}  // namespace kinalign
