// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/models_page/models_html.h"

#include "kinalign/view/dataset_page/table_html.h"
#include "kinalign/view/models_page/assets.h"
#include "kinalign/view/models_page/error_plot.h"
#include "kinalign/view/models_page/pose_pictures.h"
#include "kinalign/view/models_page/side_by_side.h"
#include "kinalign/view/page/assets.h"
#include "kinalign/view/page/page_html.h"
#include "kinalign/view/page/page_template.h"

#include <fmt/format.h>

namespace kinalign {

namespace {

/// Returns the facts in one line.
std::string facts_html(const ModelsPage& page) {
  return escaped(fmt::format("{}", fmt::join(page.facts, " · ")));
}

/// Returns the numbers of the first screen.
std::string numbers_html(const ModelsPage& page) {
  std::string out;
  for (const auto& [number, what] : page.numbers) {
    out += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", escaped(number), escaped(what));
  }
  return out;
}

/// Returns a section with its pictures and tables. If a part is missing, a note at the beginning
/// states this.
std::string section_html(const PosePictures& pictures) {
  std::string out = fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n", escaped(pictures.id),
                                escaped(pictures.title));
  if (!pictures.absent.empty()) {
    out += fmt::format("<p class=\"note absent\">{}</p>\n", escaped(pictures.absent));
  }
  const std::string drawn = pictures_html(pictures);
  if (!drawn.empty()) {
    out += fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", drawn,
                       escaped(pictures.caption));
  }
  for (const Table& table : pictures.tables) out += table_html(table);
  return out + "</section>\n";
}

/// Returns links to the sections. The link's text is the part of a title before the colon.
std::string links_html(const ModelsPage& page) {
  std::string out;
  for (const PosePictures& figure : page.figures) {
    out += fmt::format(" <a href=\"#{}\">{}</a>", escaped(figure.id),
                       escaped(figure.title.substr(0, figure.title.find(':'))));
  }
  return out;
}

}  // namespace

/// Fills the template of the page. Without moving bodies the page has no script.
std::string models_html(const ModelsPage& page) {
  const std::string style = std::string(page_style()) + std::string(models_style());
  PageParts parts;
  // A page without a script does not need its data.
  if (!models_script().empty() && !page.motion.bodies.empty()) {
    parts["motion"] = side_by_side_json(page.motion);
    parts["script"] = models_script();
    parts["motion_caption"] = escaped(page.motion.caption);
  }
  // The policy contains the hash of the script, so it is made after the script.
  parts["policy"] = page_policy(parts["script"], style);
  parts["software"] = escaped(page.software);
  parts["mark"] = models_page_mark;
  parts["style"] = style;
  parts["name"] = escaped(page.name);
  parts["headline"] = escaped(page.headline);
  parts["facts"] = facts_html(page);
  parts["links"] = links_html(page);
  parts["numbers"] = numbers_html(page);
  parts["marks"] = table_html(page.marks);
  parts["marks_note"] = escaped(page.marks_note);
  parts["poses"] = section_html(page.poses);
  parts["errors"] = error_plot_html(page.errors);
  for (const PosePictures& figure : page.figures) parts["figures"] += section_html(figure);
  parts["command"] = escaped(page.command);
  return filled(models_template(), parts);
}

}  // namespace kinalign
