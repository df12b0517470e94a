// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/page/page_html.h"

#include "kinalign/core/hash.h"
#include "kinalign/core/utf8.h"
#include "kinalign/view/page/assets.h"
#include "kinalign/view/page/packed_series.h"
#include "kinalign/view/page/page_json.h"
#include "kinalign/view/page/page_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace kinalign {

namespace {

using Parts = std::map<std::string, std::string, std::less<>>;

/// Puts parts into a template: {{name}} becomes the part; {{#name}}...{{/name}} stays only where
/// the part is there and not empty.
class Template {
 public:
  explicit Template(const Parts& parts) : parts_(parts) {}

  std::string filled(std::string_view text) const {
    std::string out;
    while (!text.empty()) {
      const std::size_t open = text.find("{{");
      out += text.substr(0, open);
      if (open == std::string_view::npos) break;
      text.remove_prefix(open + 2);
      const std::size_t close = text.find("}}");
      const std::string_view name = text.substr(0, close);
      text.remove_prefix(close + 2);
      if (!name.starts_with('#')) {
        out += part(name);
        continue;
      }
      const std::string end = fmt::format("{{{{/{}}}}}", name.substr(1));
      const std::size_t behind = text.find(end);
      if (!part(name.substr(1)).empty()) out += filled(text.substr(0, behind));
      text.remove_prefix(behind + end.size());
    }
    return out;
  }

 private:
  std::string_view part(std::string_view name) const {
    const auto found = parts_.find(name);
    return found == parts_.end() ? std::string_view() : std::string_view(found->second);
  }
  const Parts& parts_;
};

/// A hash as a Content-Security-Policy names it.
std::string policy_hash(std::string_view text) {
  Sha256 hash;
  hash.update(text);
  const std::string hex = hash.hex();
  std::string bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  }
  return "'sha256-" + base64(bytes) + "'";
}

std::string flag(bool on) { return on ? "yes" : ""; }

template <class Has>
std::string any_node(const TakePage& page, Has has) {
  return flag(std::any_of(page.nodes.begin(), page.nodes.end(), has));
}

Parts parts_of(const TakePage& page) {
  Parts parts;
  parts["policy"] = "default-src 'none'; base-uri 'none'; form-action 'none'; script-src " +
                    policy_hash(page_script()) + "; style-src " + policy_hash(page_style());
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

/// Which blocks of the template a take has.
void put_flags(const TakePage& page, Parts& parts) {
  const auto lane = [&](auto has) {
    return flag(std::any_of(page.lanes.begin(), page.lanes.end(), has));
  };
  parts["resampled"] = lane([](const PageLane& l) { return l.resampled; });
  parts["interval"] = lane([](const PageLane& l) { return l.interval_known; });
  parts["bins"] = page.lanes.empty() ? "0" : std::to_string(page.lanes.front().tracked.size());
  parts["points"] = flag(std::any_of(page.bodies.begin(), page.bodies.end(),
                                     [](const PageBody& b) { return b.kind == PageKind::points; }));
  parts["pairs"] = flag(!page.spaces.empty() && !page.spaces.front().pairs.empty());
  parts["zones"] = flag(!page.floors.empty());
  parts["bones"] = flag(!page.bones.empty());
  parts["detail"] = flag(!page.details.empty());
  parts["nodes"] = flag(!page.nodes.empty());
  parts["rate"] = any_node(page, [](const NodeFigures& n) { return n.has_rate; });
  parts["acceleration"] = any_node(page, [](const NodeFigures& n) { return n.has_acceleration; });
  parts["orientation"] = any_node(page, [](const NodeFigures& n) { return n.has_orientation; });
  parts["axes"] = flag(has_axes(page));
  const std::string gravity = any_node(page, [](const NodeFigures& n) { return n.has_gravity; });
  parts["gravity"] = gravity.empty() ? ", gravity removed" : ", gravity included";
  parts["rest"] = gravity.empty() ? "0" : "9.8 m/s²";
}

}  // namespace

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
  if (!page_parts_missing().empty()) {
    return Failure(Error{"", 0, "a kinalign that was built with esbuild, libjs-three and node-d3",
                         "one without " + std::string(page_parts_missing())});
  }
  Parts parts = parts_of(page);
  put_flags(page, parts);
  return Template(parts).filled(page_template());
}

}  // namespace kinalign
