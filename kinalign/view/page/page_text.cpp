// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/page/page_text.h"

#include "kinalign/core/find_named.h"
#include "kinalign/view/page/page_html.h"
#include "kinalign/view/page/page_json.h"
#include "kinalign/view/report_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

constexpr double degrees = 180.0 / std::numbers::pi;

/// Returns the style sheet class that gives a stream's verdict its colour.
std::string_view colour_of_stream(const TakePage& page, const std::string& stream) {
  for (const PageLane& lane : page.lanes) {
    if (lane.stream == stream) return to_string(lane.colour);
  }
  return to_string(PageColour::imu);
}

/// Returns a table row. A cell that begins with '=' contains words and is left-aligned. Other cells
/// are numbers and are right-aligned.
std::string row(std::string_view cell, const std::vector<std::string>& cells) {
  std::string out = "<tr>";
  for (const std::string& text : cells) {
    const bool words = text.starts_with('=');
    out += fmt::format("<{}{}>{}</{}>", cell, words ? " class=\"text\"" : "",
                       escaped(words ? text.substr(1) : text), cell);
  }
  return out + "</tr>\n";
}

std::string table(const std::vector<std::string>& heads, const std::string& rows,
                  std::string_view caption) {
  return fmt::format(
      "<figure><div class=\"scroll\"><table><thead>{}</thead><tbody>{}</tbody></table></div>"
      "<figcaption>{}</figcaption></figure>",
      row("th", heads), rows, caption);
}

/// Returns the name of a stream, with the names of its nodes.
std::string stream_name(const StreamReport& s) {
  return s.nodes.empty() ? s.stream : fmt::format("{} {}", s.stream, fmt::join(s.nodes, ", "));
}

/// Returns the mean rate over the whole stream, which may differ from the nominal rate.
std::string real_rate(const StampSurvey& survey) {
  const double length = seconds(survey.last - survey.first);
  if (survey.kept() < 2 || !(length > 0.0)) return "";
  return fmt::format("{:.4g} Hz", static_cast<double>(survey.kept() - 1) / length);
}

/// Returns the number of missing samples: those that would fit into the steps that are longer than
/// usual.
std::string lost(const StampSurvey& survey) {
  if (survey.median_step_ns <= 0) return "";
  const double room =
      static_cast<double>(survey.long_time_ns) / static_cast<double>(survey.median_step_ns);
  const auto count = static_cast<std::uint64_t>(
      std::max(0.0, std::round(room - static_cast<double>(survey.long_steps))));
  const std::uint64_t all = survey.kept() + count;
  const std::string share = share_text(count, all);
  return share.empty() ? "0" : fmt::format("{} ({})", grouped(count), share);
}

/// Returns the number of samples that arrived but were not used, for any reason.
std::string left_out(const StreamReport& s) {
  return grouped(s.survey.duplicates + s.survey.backward + s.survey.ahead + s.held_back);
}

/// Returns the number of gaps within the take and their total time.
std::string gaps(const StreamReport& s) {
  if (s.gaps == 0) return "0";
  return fmt::format("{} ({:.2f} s)", s.gaps, 1e-9 * static_cast<double>(s.gap_time_ns));
}

/// Positions are stated in centimetres.
std::string cm(double m) { return fmt::format("{:.1f}", 100.0 * m); }

/// Returns a share for a table cell; "0" instead of an empty text.
std::string share_or_zero(std::uint64_t part, std::uint64_t whole) {
  const std::string text = share_text(part, whole);
  return text.empty() ? "0" : text;
}

/// Returns the method of docs/align_space.md in words.
std::string how_moved(const PageSpace& space) {
  if (space.report.method == "fit") return "by one rotation and translation, fitted to the take";
  if (space.report.method == "given") return "by one rotation and translation, as given";
  return "by the paper's equations: turned by one angle, and its root put onto the other root in "
         "every frame, so that the root has no residual";
}

/// Returns the names of bodies with measured bones: "kinect and kinect_2".
std::string bodies_with_bones(const TakePage& page) {
  std::vector<std::string> names;
  for (const BoneLength& bone : page.bones) {
    const std::string name = escaped(page.bodies[bone.body].name);
    if (names.empty() || names.back() != name) names.push_back(name);
  }
  return fmt::format("{}", fmt::join(names, " and "));
}

}  // namespace

/// States subject, action, length, frames and date. Stamps that count from a start have no date.
std::string facts_text(const TakePage& page) {
  const AlignmentReport& report = page.report;
  std::vector<std::string> facts;
  if (!page.subject.empty()) facts.push_back("subject " + page.subject);
  if (!page.action.empty()) facts.push_back(page.action);
  facts.push_back(
      duration_text(take_seconds(to_ns(report.begin), to_ns(report.end), report.rate_hz)));
  facts.push_back(fmt::format("{} frames at {:.4g} Hz", grouped(report.frames), report.rate_hz));
  if (is_date(to_ns(report.begin))) facts.push_back(date_text(to_ns(report.begin)) + " UTC");
  return escaped(fmt::format("{}", fmt::join(facts, " · ")));
}

Quality quality_of(const TakePage& page) {
  Quality worst = Quality::good;
  for (const Verdict& verdict : page.verdicts) worst = std::max(worst, verdict.quality);
  return worst;
}

/// States the verdicts in one line, bad streams first.
std::string headline(const TakePage& page) {
  std::vector<std::string> good, usable, bad;
  for (const Verdict& verdict : page.verdicts) {
    auto& list =
        verdict.quality == Quality::good ? good : (verdict.quality == Quality::bad ? bad : usable);
    list.push_back(verdict.stream);
  }
  // If all streams are good, the line begins with "Good".
  if (usable.empty() && bad.empty()) {
    return good.size() == 1 ? "Good" : fmt::format("Good: all {} streams", good.size());
  }
  // The worst streams come first, because they decide whether the take is usable.
  std::vector<std::string> parts;
  if (!bad.empty()) parts.push_back(fmt::format("{} bad", fmt::join(bad, ", ")));
  if (!usable.empty()) parts.push_back(fmt::format("{} usable", fmt::join(usable, ", ")));
  if (!good.empty()) parts.push_back(fmt::format("{} good", fmt::join(good, ", ")));
  return escaped(fmt::format("{}", fmt::join(parts, "; ")));
}

/// Returns a list item for each stream's verdict.
std::string verdict_items(const TakePage& page) {
  std::string out;
  for (const Verdict& verdict : page.verdicts) {
    out += fmt::format(
        "<li class=\"{}\"><span class=\"stream\">{}</span><span class=\"mark {}\">{}</span><span "
        "class=\"reason\">{}</span></li>",
        colour_of_stream(page, verdict.stream), escaped(verdict.stream), to_string(verdict.quality),
        to_string(verdict.quality), escaped(verdict.reason));
  }
  return out;
}

std::string worst_title(const TakePage& page) {
  if (page.worst.empty()) return "Nothing to note";
  if (page.worst.size() == 1) return "The worst thing";
  return page.worst.size() == 2 ? "The two worst things" : "The three worst things";
}

std::string worst_items(const TakePage& page) {
  std::string out;
  for (const Concern& concern : page.worst) {
    // Even a good take has a worst value. The addition shows that it is not a fault.
    const std::string small = concern.quality == Quality::good ? " (within the limits)" : "";
    out += fmt::format("<li>{}: {}{}</li>", escaped(concern.stream), escaped(words_of(concern)),
                       small);
  }
  return out;
}

/// Lists the numbers of the first screen: residuals, widest time interval, shares of joints, worst
/// node. Only numbers that exist are listed, so the list differs between takes.
std::string numbers_list(const TakePage& page) {
  std::string out;
  const auto add = [&out](const std::string& number, const std::string& what) {
    out += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", escaped(number), escaped(what));
  };
  for (const PageSpace& space : page.spaces) {
    add(cm(space.report.after_m) + " cm",
        space.report.stream + " from " + space.report.onto + ", rms");
  }
  // The widest interval of all streams shows whether times are reliable.
  std::optional<std::int64_t> widest;
  for (const StreamReport& s : page.report.streams) {
    if (s.worst_interval_ns) widest = std::max(widest.value_or(0), *s.worst_interval_ns);
  }
  if (widest && *widest > 0) {
    add(fmt::format("± {:.1f} ms", 1e-6 * static_cast<double>(*widest)), "certain time, at worst");
  }
  for (const StreamReport& s : page.report.streams) {
    const PageBody* body = find_named(page.bodies, s.stream);
    // Shares of joints are stated only for points that are not the reference. They show how well a
    // Kinect saw the person.
    if (body == nullptr || body->kind != PageKind::points || s.stream == page.report.reference) {
      continue;
    }
    add(share_or_zero(s.samples - s.invalid, s.samples), s.stream + " joints valid");
    add(share_or_zero(s.inferred, s.samples), s.stream + " joints inferred");
  }
  const auto worst = std::max_element(
      page.nodes.begin(), page.nodes.end(),
      [](const NodeFigures& a, const NodeFigures& b) { return a.rate_rms < b.rate_rms; });
  if (worst != page.nodes.end() && worst->has_rate) {
    add(fmt::format("{:.1f}°/s", worst->rate_rms * degrees),
        "worst node (" + worst->node + ") from its bone, rms");
  }
  return out;
}

bool has_axes(const TakePage& page) {
  return !page.bodies.empty() && page.bodies[page.node_body].in_take_space &&
         std::any_of(page.nodes.begin(), page.nodes.end(),
                     [](const NodeFigures& n) { return n.has_orientation; });
}

/// Returns the legend of the player for this take.
std::string legend(const TakePage& page) {
  std::string out;
  // Rings and lines are in the legend only if they can occur.
  bool points = false;
  for (const PageBody& body : page.bodies) {
    if (!body.in_take_space) continue;
    points = points || body.kind == PageKind::points;
    out += fmt::format("<span><i class=\"{}\"></i>{}</span>", to_string(body.colour),
                       escaped(body.name));
  }
  if (points) out += "<span><i class=\"ring\"></i>inferred, or last seen there</span>";
  if (!page.spaces.empty()) out += "<span><i class=\"residual\"></i>residual</span>";
  if (has_axes(page)) out += "<span><i class=\"imu\"></i>nodes' axes</span>";
  return out;
}

/// Returns the caption of the player for the parts that this take has.
std::string player_caption(const TakePage& page) {
  std::string text = "The take in its space; floor in squares of 1 m.";
  if (!page.spaces.empty()) text += " Lines join each Kinect joint to its counterpart.";
  if (!page.floors.empty()) {
    text += " On the floor: the Kinect's best zone (filled) and its largest.";
  }
  if (has_axes(page)) {
    text += " Each node's x, y and z axes are dark to light, thin where it is invalid.";
  }
  return text;
}

/// Returns the table of streams: what each device sent, and how much of it alignment used.
std::string time_table(const TakePage& page) {
  std::string rows;
  for (const StreamReport& s : page.report.streams) {
    // The rows have the reference's stamps, so the reference has no interval and no nearest sample.
    const bool reference = s.stream == page.report.reference;
    rows +=
        row("td",
            {stream_name(s),
             "=" + (reference ? std::string("the reference")
                              : clock_text(s.worst_interval_ns, s.counted)),
             real_rate(s.survey), grouped(s.survey.samples), lost(s.survey), left_out(s), gaps(s),
             share_or_zero(s.invalid, s.samples), share_or_zero(s.bridged, s.samples),
             reference ? ""
                       : fmt::format("{:.1f} ms", 1e-6 * static_cast<double>(s.worst_nearest_ns))});
  }
  return table(
      {"stream", "=clock", "real rate", "samples", "lost", "left out", "gaps", "invalid",
       "interpolated over loss", "nearest sample within"},
      rows,
      "What each device sent, and how it was used. Real rate: the mean over the whole stream. "
      "Lost: the samples missing in steps longer than 1.5 usual steps. Left out: "
      "samples with stamps that repeat, step back or jump ahead, and delayed samples. Gaps, "
      "invalid: within the take.");
}

/// Returns the caption of figure 7 of the HFUT-MMD paper. Without raw samples, the nearest rows are
/// shown instead.
std::string detail_caption(const TakePage& page) {
  if (page.details.empty()) return "";
  const PageDetail& detail = page.details.front();
  std::string text = fmt::format(
      "The paper's figure 7: raw samples of {} against the resampled curve, in the space of the "
      "take. ",
      page.details.size() > 1 ? "the chosen stream" : escaped(page.bodies[detail.body].name));
  text +=
      detail.has_raw
          ? "Dots: the raw samples, read from the take's inputs; hollow: inferred by the device."
          : fmt::format(
                "Dots: rows of the curve that lie within {:.1f} ms of a raw sample, "
                "since the inputs were not read (<code>--inputs FOLDER</code>); hollow: "
                "inferred by the device.",
                1e3 * static_cast<double>(detail.near_s));
  text += " Grey: no value; no value is made up.";
  if (!page.spaces.empty()) text += " Thin: the joint's counterpart in the reference.";
  // If a take is long, the page has raw samples only for a part, which the caption names.
  const double length = seconds(page.report.end - page.report.begin);
  if (detail.end_s < length || detail.begin_s > 0.0) {
    text += fmt::format(" Raw samples of {:.0f} to {:.0f} s only.", detail.begin_s,
                        std::min(detail.end_s, length));
  }
  return text;
}

/// Returns a paragraph for each stream that was moved, and for each that keeps its own space. A
/// stream in its own space can't be shown together with the others.
std::string space_text(const TakePage& page) {
  std::string out;
  for (const PageSpace& space : page.spaces) {
    // One angle states how far the two devices were rotated relative to each other.
    const Eigen::AngleAxisd turn(space.report.transform.rotation);
    out += fmt::format(
        "<p>{} was moved onto {} {}: distance {} cm rms, before {}; rotated by {:.1f}°.</p>",
        escaped(space.report.stream), escaped(space.report.onto), how_moved(space),
        cm(space.report.after_m), cm(space.report.before_m), turn.angle() * degrees);
  }
  for (const PageBody& body : page.bodies) {
    if (body.in_take_space) continue;
    out += fmt::format("<p>{} stays in its own space and is not drawn with the others.</p>",
                       escaped(body.name));
  }
  return out;
}

/// Returns the caption of table 5. If each row has its own transform, the original positions are
/// not known.
std::string table5_caption(const TakePage& page) {
  if (page.spaces.empty()) return "";
  const PageSpace& space = page.spaces.front();
  const bool several = page.spaces.size() > 1;
  std::string text = several
                         ? "The paper's table 5: the chosen stream (green) and the stream that it "
                           "was moved onto (red) "
                         : fmt::format("The paper's table 5: {} (green) and {} (red) ",
                                       escaped(space.report.stream), escaped(space.report.onto));
  text += space.once_per_take || several
              ? "before and after the first was moved."
              : "after the first was moved. The state before is not shown: the transform differs "
                "from frame to frame, and the take contains only the result.";
  return text + " Each panel has its own scale. Dashed bones and hollow joints: inferred.";
}

/// Returns the caption of the residuals of each joint.
std::string residual_caption(const TakePage& page) {
  if (page.spaces.empty()) return "";
  const SpaceReport& report = page.spaces.front().report;
  const bool several = page.spaces.size() > 1;
  return fmt::format(
      "Distance of each joint of {} from its counterpart{}, rms over the rows in which it is "
      "tracked. Joints of the same name are not at exactly the same place in both skeletons, so a "
      "part of this distance is not noise.",
      several ? "the stream chosen in figure 5" : escaped(report.stream),
      several ? "" : " in " + escaped(report.onto));
}

/// Returns the caption of the floor, with the zones if the Kinect's position is known.
std::string floor_caption(const TakePage& page) {
  std::string text =
      "The floor from above: the paths of the root joints, and their present positions.";
  if (page.floors.empty()) {
    return text + " The position of the Kinect is unknown: the take has no single transform.";
  }
  return text + fmt::format(
                    " The Kinect's zones are those of the paper: {} to {} m best (filled), "
                    "{} to {} m largest (dashed), {:.0f}° across.",
                    best_near_m, best_far_m, largest_near_m, largest_far_m, field_deg);
}

/// Returns the table of joints by zone.
std::string zone_table(const TakePage& page) {
  if (page.floors.empty()) return "";
  const PageFloor& floor = page.floors.front();
  constexpr std::array<const char*, zone_count> names{"best", "largest", "outside both"};
  // Shares refer to all joints, including missing ones.
  std::uint64_t all = floor.missing;
  for (const auto& zone : floor.zones) all += zone.tracked + zone.inferred;
  std::string rows;
  for (std::size_t z = 0; z < zone_count; ++z) {
    const auto& zone = floor.zones[z];
    const std::uint64_t here = zone.tracked + zone.inferred;
    rows += row("td", {names[z], share_or_zero(here, all), share_or_zero(zone.inferred, here)});
  }
  rows += row("td", {"place unknown", share_or_zero(floor.missing, all), ""});
  return table({"zone", "of all joints", "inferred there"}, rows,
               "Joints by the floor zone they were in, over all rows.");
}

/// Returns the caption about bone lengths; empty without bones.
std::string bones_caption(const TakePage& page) {
  if (page.bones.empty()) return "";
  return fmt::format(
      "Lengths of the bones of {}, which should be constant: one deviation to each side (bar), "
      "shortest and longest (line, cut at three deviations of the worst bone). Each bone has the "
      "name of the joint at its end. Only rows in which both ends are tracked count. A mocap "
      "skeleton's "
      "bones "
      "are constant by construction.",
      bodies_with_bones(page));
}

/// Returns the text about nodes, with a paragraph for each node whose bone was not found by name.
std::string node_text(const TakePage& page) {
  std::string out =
      "<p>Each node's measurements, compared with the motion of its bone in the mocap. A node is "
      "worn at an unknown angle and its world has an unknown heading: both are fitted once for the "
      "take, from the values themselves. The remaining difference is noise, drift, lag and "
      "slip.</p>";
  for (const NodeFigures& node : page.nodes) {
    if (node.joint_by_name) continue;
    out += fmt::format(
        "<p>The name {} is not the name of a bone: the node is compared with {}, whose rotation is "
        "most similar.</p>",
        escaped(node.node), escaped(node.joint));
  }
  return out;
}

/// Returns the table of differences between each node and its bone. Angles are in degrees; the
/// page's data are in radians.
std::string node_table(const TakePage& page) {
  std::string rows;
  for (const NodeFigures& node : page.nodes) {
    // An unknown number gives an empty cell, not 0.
    const auto number = [](bool known, double x, int digits) {
      return known ? fmt::format("{:.{}f}", x, digits) : std::string("");
    };
    rows +=
        row("td", {node.node, "=" + node.joint, number(node.has_rate, node.rate_rms * degrees, 1),
                   number(node.has_rate, node.rate_correlation, 3),
                   node.lag_s ? fmt::format("{:+.1f}", 1e3 * *node.lag_s) : "",
                   number(node.has_acceleration, node.acceleration_rms, 2),
                   number(node.has_acceleration, node.acceleration_correlation, 3),
                   number(node.has_orientation, node.orientation_rms * degrees, 2)});
  }
  return table({"node", "=bone", "angular velocity, rms / °/s", "its correlation", "lag / ms",
                "acceleration, rms / m/s²", "its correlation", "orientation, rms / °"},
               rows,
               "Differences between a node and its bone after the best constant rotation, over the "
               "rows kept on this page. Correlations are of the magnitudes. Lag: the delay of the "
               "node at which its rates agree best.");
}

std::string raw_nodes_text(const TakePage& page) {
  const bool any = std::any_of(page.nodes.begin(), page.nodes.end(),
                               [](const NodeFigures& node) { return !node.raw_seconds.empty(); });
  if (!any) return "";
  return fmt::format(
      " Dots: the node's raw samples, read from the take's inputs, of {:.0f} to {:.0f} s; they are "
      "drawn if there is at most one per two pixels.",
      page.raw_nodes_begin_s, page.raw_nodes_end_s);
}

/// Returns the findings as a list.
std::string findings_list(const TakePage& page) {
  if (page.report.findings.empty()) return "<p>Alignment found no problems.</p>";
  std::string out = "<ul class=\"findings\">";
  for (const Finding& finding : page.report.findings) {
    // Findings have the same colours as verdicts.
    const std::string_view mark = finding.severity == Severity::error
                                      ? "bad"
                                      : (finding.severity == Severity::note ? "note" : "usable");
    out += fmt::format("<li><span class=\"mark {}\">{}</span> {}: {}", mark,
                       to_string(finding.severity), escaped(to_string(finding.what)),
                       escaped(finding.meaning));
    if (!finding.repair.empty()) out += fmt::format("<small>{}</small>", escaped(finding.repair));
    out += "</li>";
  }
  return out + "</ul>";
}

/// Returns the table of input files. With the hashes, a reader can check that the inputs are still
/// the same files.
std::string inputs_table(const TakePage& page) {
  if (page.inputs.empty()) return "";
  std::string rows;
  for (const InputFacts& file : page.inputs) {
    rows += fmt::format(
        "<tr><td class=\"long\">{}</td><td>{}</td><td class=\"long\"><code>{}</code>"
        "</td></tr>\n",
        escaped(file.name), grouped(file.bytes), escaped(file.sha256));
  }
  return table({"input", "bytes", "=SHA-256"}, rows, "The files that the take was made from.");
}

/// Returns the note on how many rows the page stores. If the page does not store every row, its
/// figures may miss short events.
std::string thinning_text(const TakePage& page) {
  if (page.stride == 1) {
    return fmt::format("The page holds every row of the take ({}).", grouped(page.report.frames));
  }
  return fmt::format(
      "The page holds every {}th row of the take ({} of {}), so that it stays small. Tables, "
      "bones, "
      "zones and figures 2 and 3 count all rows. The player interpolates linearly between rows.",
      page.stride, grouped(page.seconds.size()), grouped(page.report.frames));
}

}  // namespace kinalign
