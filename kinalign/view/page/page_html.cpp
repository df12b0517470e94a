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

/// Returns a text that is empty if `on` is false. The template keeps a block if its part is not
/// empty.
std::string flag(bool on) { return on ? "yes" : ""; }

template <class Has>
std::string any_node(const TakePage& page, Has has) {
  return flag(std::any_of(page.nodes.begin(), page.nodes.end(), has));
}

/// Returns all texts of the page, by their names in the template. Functions of page_text.h return
/// HTML; plain texts are escaped here.
PageParts parts_of(const TakePage& page) {
  PageParts parts;
  // The policy contains the hashes of these two texts, so the browser runs no other script and
  // style.
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

/// Sets which blocks of the template are on the page. The block of a figure without data is
/// omitted.
void put_flags(const TakePage& page, PageParts& parts) {
  const auto lane = [&](auto has) {
    return flag(std::any_of(page.lanes.begin(), page.lanes.end(), has));
  };
  parts["resampled"] = lane([](const PageLane& l) { return l.resampled; });
  parts["interval"] = lane([](const PageLane& l) { return l.interval_known; });
  // The caption of figure 3 states the number of bins.
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
  // The caption applies to all nodes, because all nodes of a stream either measure gravity or do
  // not.
  const std::string gravity = any_node(page, [](const NodeFigures& n) { return n.has_gravity; });
  parts["gravity"] = gravity.empty() ? ", gravity removed" : ", gravity included";
  parts["rest"] = gravity.empty() ? "0" : "9.8 m/s²";
}

}  // namespace

// Apostrophes are escaped too, because they may quote attributes.
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
  // The build embeds the libraries of the script. Without them the page could not draw.
  if (!page_parts_missing().empty()) {
    return Failure(Error{"", 0, "a kinalign that was built with esbuild, libjs-three and node-d3",
                         "a kinalign without " + std::string(page_parts_missing())});
  }
  PageParts parts = parts_of(page);
  put_flags(page, parts);
  return filled(page_template(), parts);
}

}  // namespace kinalign
