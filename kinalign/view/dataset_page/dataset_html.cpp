// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/dataset_page/dataset_html.h"

#include "kinalign/view/dataset_page/assets.h"
#include "kinalign/view/dataset_page/skeleton_svg.h"
#include "kinalign/view/dataset_page/table_html.h"
#include "kinalign/view/page/assets.h"
#include "kinalign/view/page/page_html.h"
#include "kinalign/view/page/page_template.h"
#include "kinalign/view/report_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace kinalign {

namespace {

/// Returns a count with its noun: "1 take", "12 takes".
std::string counted(std::uint64_t count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", grouped(count), count == 1 ? one : many);
}

/// Returns the number of takes for each verdict, the worst verdict first.
std::array<std::pair<std::string_view, std::uint64_t>, 3> verdicts_of(const DatasetPage& page) {
  return {{{"bad", page.bad}, {"usable", page.usable}, {"good", page.good}}};
}

/// Returns the line below the title: "3 bad, 12 usable, 385 good". Verdicts without takes are
/// omitted.
std::string headline(const DatasetPage& page) {
  if (page.takes == 0) return "no takes yet";
  std::string out;
  for (const auto& [word, count] : verdicts_of(page)) {
    if (count > 0) out += fmt::format("{}{} {}", out.empty() ? "" : ", ", grouped(count), word);
  }
  return out;
}

/// Returns the verdict that colours the headline. One bad take makes it red, because a user must
/// look at that take.
std::string_view quality(const DatasetPage& page) {
  if (page.takes == 0) return "";
  return page.bad > 0 ? "bad" : page.usable > 0 ? "usable" : "good";
}

/// Returns a bar whose parts are the shares of the verdicts.
std::string verdict_bar(const DatasetPage& page) {
  if (page.takes == 0) return "";
  std::string out = fmt::format(
      "<svg class=\"verdict-bar\" viewBox=\"0 0 100 1\" preserveAspectRatio=\"none\" role=\"img\" "
      "aria-label=\"{}\">",
      headline(page));
  // Each part begins at the end of the previous part.
  double at = 0.0;
  for (const auto& [word, count] : verdicts_of(page)) {
    const double share = 100.0 * static_cast<double>(count) / static_cast<double>(page.takes);
    out += fmt::format("<rect class=\"{}\" x=\"{:.3f}\" width=\"{:.3f}\" height=\"1\"/>", word, at,
                       share);
    at += share;
  }
  return out + "</svg>";
}

/// Returns the line below the headline: takes, people, length, licence.
std::string facts_of(const DatasetPage& page) {
  std::vector<std::string> facts{counted(page.takes, "take", "takes"),
                                 counted(page.people, "person", "people"),
                                 duration_text(page.seconds)};
  if (!page.licence.empty()) facts.push_back(page.licence);
  return escaped(fmt::format("{}", fmt::join(facts, " · ")));
}

/// Returns the numbers of frames, in total and for each modality.
std::string numbers_of(const DatasetPage& page) {
  std::string out;
  const auto add = [&out](const std::string& number, std::string_view what) {
    out += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", number, what);
  };
  add(grouped(page.mocap_frames + page.kinect_frames + page.imu_frames),
      "frames of all modalities");
  add(grouped(page.mocap_frames), "mocap");
  add(grouped(page.kinect_frames), "Kinect");
  add(grouped(page.imu_frames), "IMU");
  return out;
}

// Returns a number or a dash. An empty cell would look like a fault of the page.
std::string number_or_none(const std::optional<double>& value, double factor) {
  return value ? fmt::format("{:.1f}", factor * *value) : "–";
}

/// Returns the modalities of a take, in the order of the HFUT-MMD paper.
std::string streams_of(const DatasetTake& take) {
  std::vector<std::string_view> names;
  if (take.has_mocap) names.emplace_back("mocap");
  if (take.has_kinect) names.emplace_back("Kinect");
  if (take.has_imu) names.emplace_back("IMU");
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Returns a second line for a cell, or nothing if there is no text.
std::string small(std::string_view text) {
  return text.empty() ? "" : fmt::format("<small>{}</small>", escaped(text));
}

/// Returns a table row. Its cells have the order of the head in assets/dataset.html. The class is
/// an attribute, because the filter of the page needs it and no column shows it.
std::string row_of(const DatasetTake& take) {
  const std::string name = escaped(take.name);
  // If a take has no page, its name is not a link.
  const std::string link = take.page.empty()
                               ? fmt::format("<span>{}</span>", name)
                               : fmt::format("<a href=\"{}\">{}</a>", escaped(take.page), name);
  std::string out =
      fmt::format("<tr data-class=\"{}\"><td>{}</td><td class=\"text\">{}{}</td>",
                  escaped(take.class_id), skeleton_svg(take.bodies), link, small(take.reason));
  out += fmt::format("<td class=\"text\"><span class=\"mark {0}\">{0}</span></td>",
                     escaped(take.verdict));
  out += fmt::format("<td class=\"text\">{}</td><td class=\"text\">{}{}</td>",
                     escaped(take.subject), escaped(take.action), small(take.action_name));
  out += fmt::format("<td>{}</td><td>{:.1f}</td><td class=\"text\">{}</td>", grouped(take.frames),
                     take.seconds, streams_of(take));
  out +=
      fmt::format("<td>{}</td><td>{}</td><td>{}</td></tr>\n", number_or_none(take.residual_cm, 1.0),
                  number_or_none(take.kinect_valid, 100.0), number_or_none(take.imu_valid, 100.0));
  return out;
}

/// Returns licence, citation and contact of the data set. A missing licence is stated, because
/// other people need a licence to use the data.
std::string about_list(const DatasetPage& page) {
  const std::array<std::pair<std::string_view, const std::string*>, 3> texts{
      {{"Licence", &page.licence}, {"Citation", &page.citation}, {"Contact", &page.contact}}};
  std::string out;
  for (const auto& [title, text] : texts) {
    out += fmt::format("<dt>{}</dt><dd>{}</dd>", title,
                       text->empty() ? "not stated in dataset.toml" : escaped(*text));
  }
  return out;
}

/// Returns a sentence about takes that are not in the table; empty if all are. The table is
/// limited, because a page with thousands of pictures would be too large. The stated command lists
/// all takes.
std::string cut_of(const DatasetPage& page) {
  if (page.worst.size() == page.takes) return "";
  return fmt::format(
      "The table has the {} worst of {} takes; <code>kinalign dataset list {}</code> lists all. ",
      grouped(page.worst.size()), grouped(page.takes), escaped(page.folder));
}

/// Returns the command that makes missing pages; empty if no page is missing.
std::string pages_of(const DatasetPage& page) {
  if (page.takes_without_page == 0) return "";
  const std::string who =
      page.takes_without_page == page.worst.size()
          ? "The takes have no pages yet"
          : counted(page.takes_without_page, "take has", "takes have") + " no page";
  return fmt::format("{}: <code>kinalign dataset report {} --pages</code> makes them.", who,
                     escaped(page.folder));
}

/// States how many manifests were added but not built, because the table does not contain them.
std::string not_built_of(const DatasetPage& page) {
  if (page.not_built == 0) return "";
  return fmt::format("{} not built and not in the table: <code>kinalign dataset build {}</code>.",
                     counted(page.not_built, "take is", "takes are"), escaped(page.folder));
}

}  // namespace

/// Fills the template of the page.
std::string dataset_html(const DatasetPage& page) {
  // The policy allows exactly one style, so both style sheets are joined.
  const std::string style = std::string(page_style()) + std::string(dataset_style());
  PageParts parts;
  parts["policy"] = page_policy(dataset_script(), style);
  parts["software"] = escaped(page.software);
  parts["mark"] = dataset_page_mark;
  parts["style"] = style;
  parts["script"] = dataset_script();
  parts["name"] = escaped(page.name);
  parts["headline"] = headline(page);
  parts["quality"] = quality(page);
  parts["facts"] = facts_of(page);
  parts["verdict_bar"] = verdict_bar(page);
  parts["description"] = escaped(page.description);
  parts["numbers"] = numbers_of(page);
  parts["not_built"] = not_built_of(page);
  // The worst takes come first. The script can sort them differently.
  for (const DatasetTake& take : page.worst) parts["rows"] += row_of(take);
  parts["cut"] = cut_of(page);
  parts["pages"] = pages_of(page);
  for (const Table& table : page.tables) parts["tables"] += table_html(table);
  parts["about"] = about_list(page);
  return filled(dataset_template(), parts);
}

}  // namespace kinalign
