// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/summary.h"

#include "apps/cli/console.h"
#include "apps/kinalign/text/counts_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <numbers>
#include <vector>

namespace kinalign {

namespace {

/// The streams of the report with one name. A device of nodes has many streams in the report, which
/// the summary shows as one.
struct Group {
  StreamReport sum;                 // the sums over `parts`
  std::vector<StreamReport> parts;  // one stream, or one for each node
  std::size_t nodes = 0;
};

/// Adds the counts of one stream to a group. The group's interval is the widest of its streams. It
/// is unknown if the interval of any stream is unknown.
void add(Group& group, const StreamReport& s) {
  StreamReport& sum = group.sum;
  sum.gaps += s.gaps;
  sum.gap_time_ns += s.gap_time_ns;
  sum.samples += s.samples;
  sum.invalid += s.invalid;
  sum.inferred += s.inferred;
  sum.bridged += s.bridged;
  sum.unsure += s.unsure;
  // An unknown interval makes the group's interval unknown, so that the summary never looks better
  // than the worst node.
  if (!s.worst_interval_ns) {
    sum.worst_interval_ns.reset();
  } else if (sum.worst_interval_ns) {
    sum.worst_interval_ns = std::max(*sum.worst_interval_ns, *s.worst_interval_ns);
  }
  sum.counted = sum.counted || s.counted;
  group.nodes += s.nodes.size();
  group.parts.push_back(s);
}

/// Groups the streams of the report by name. Streams of one name follow each other in the report.
std::vector<Group> groups_of(const AlignmentReport& report) {
  std::vector<Group> groups;
  for (const StreamReport& s : report.streams) {
    // A new name begins a new group. Its interval begins with 0, because add() takes the maximum.
    if (groups.empty() || groups.back().sum.stream != s.stream) {
      Group group;
      group.sum.stream = s.stream;
      group.sum.worst_interval_ns = 0;
      groups.push_back(group);
    }
    add(groups.back(), s);
  }
  return groups;
}

std::string name_of(const Group& group) {
  if (group.nodes == 0) return group.sum.stream;
  return fmt::format("{} ({})", group.sum.stream, counted(group.nodes, "node"));
}

/// The half-width of a stream's interval in time, for sorting. An unknown interval counts as the
/// widest.
std::int64_t doubt(const StreamReport& s) { return s.worst_interval_ns.value_or(INT64_MAX); }

/// The number of samples that a user should not trust: invalid ones, and those interpolated across
/// lost data.
std::uint64_t harm(const StreamReport& s) { return s.invalid + s.bridged; }

/// The text ", worst node: wrist_left". Empty if `measure` is the same for all nodes.
template <class Measure>
std::string worst_node(const Group& group, Measure measure) {
  // If all nodes are equal, there is no worst node.
  const auto less = [measure](const auto& a, const auto& b) { return measure(a) < measure(b); };
  const auto [least, most] = std::minmax_element(group.parts.begin(), group.parts.end(), less);
  if (measure(*least) == measure(*most)) return "";
  return fmt::format(", worst node: {}", fmt::join(most->nodes, ", "));
}

std::string time_text(const Group& group, const Console& console) {
  const auto& known = group.sum.worst_interval_ns;
  std::string sure = clock_text(known, group.sum.counted);
  if (group.sum.unsure > 0) {
    sure += ", " + share_text(group.sum.unsure, group.sum.samples) + " unknown";
  }
  // The text has the colour of a warning, because the error of some or all times is not known.
  if (!known || group.sum.unsure > 0) sure = console.paint(Colour::warning, sure);
  return harmless(name_of(group)) + " " + sure + worst_node(group, doubt);
}

/// The line about time. The least certain stream comes first. The reference stream is left out.
std::string time_line(std::vector<Group> groups, const std::string& reference,
                      const Console& console) {
  std::stable_sort(groups.begin(), groups.end(),
                   [](const Group& a, const Group& b) { return doubt(a.sum) > doubt(b.sum); });
  std::vector<std::string> texts;
  for (const Group& group : groups) {
    // The reference stream gives the times of the take's frames, so it has no error in time.
    if (group.sum.stream != reference) texts.push_back(time_text(group, console));
  }
  return texts.empty() ? "" : fmt::format("  time   {}\n", fmt::join(texts, "   "));
}

/// The line about a stream that was moved into the coordinates of another stream. It names the
/// joint with the largest remaining distance.
std::string space_line(const SpaceReport& s) {
  const Eigen::AngleAxisd turn(s.transform.rotation);
  std::string how = "root onto root in every frame";
  // A stream is moved in one of three ways: frame by frame (root onto root), by one fitted
  // transform, or by a transform that the user gave.
  if (s.method == "fit") how = "fitted once per take";
  if (s.method == "given") how = "as given";
  std::string text =
      fmt::format("  space  {} on {} {:.1f} cm rms (before: {:.1f}), rotation {:.1f}°, {}",
                  harmless(s.stream), harmless(s.onto), 100.0 * s.after_m, 100.0 * s.before_m,
                  turn.angle() * 180.0 / std::numbers::pi, how);
  if (!s.joints.empty()) {
    // The report lists the joints by their remaining distance, the largest first.
    const JointResidual& worst = s.joints.front();
    text +=
        fmt::format("; worst joint: {} {:.1f} cm", harmless(worst.joint), 100.0 * worst.after_m);
  }
  return text + "\n";
}

/// The line about a stream's gaps and doubtful samples. Empty if there are none.
std::string gap_line(const Group& group) {
  const StreamReport& s = group.sum;
  // A stream without such samples has no line, which keeps the summary short.
  if (s.gaps == 0 && harm(s) == 0 && s.inferred == 0) return "";
  std::vector<std::string> parts;
  if (s.gaps > 0) {
    parts.push_back(fmt::format("{} ({:.2f} s, marked)", counted(s.gaps, "gap"),
                                1e-9 * static_cast<double>(s.gap_time_ns)));
  }
  const auto share = [&](std::uint64_t part, const char* what) {
    if (part > 0) parts.push_back(share_text(part, s.samples) + " " + what);
  };
  share(s.invalid, "invalid");
  share(s.inferred, "inferred");
  share(s.bridged, "interpolated over loss");
  return fmt::format("  gaps   {} {}{}\n", harmless(s.stream), fmt::join(parts, ", "),
                     worst_node(group, harm));
}

/// The lines about gaps. The stream with the largest share of doubtful samples comes first.
std::string gap_lines(std::vector<Group> groups) {
  const auto part = [](const Group& g) {
    // Streams have different rates, so the share of doubtful samples decides and not their number.
    // The maximum avoids a division by zero.
    return static_cast<double>(harm(g.sum)) / std::max(1.0, static_cast<double>(g.sum.samples));
  };
  std::stable_sort(groups.begin(), groups.end(),
                   [part](const Group& a, const Group& b) { return part(a) > part(b); });
  std::string text;
  for (const Group& group : groups) text += gap_line(group);
  return text;
}

/// The lines about the most severe findings. `kinalign info` lists all findings.
std::string note_lines(const Findings& findings, const Console& console) {
  // The caller has sorted the findings by severity.
  constexpr std::size_t most = 5;
  std::string text;
  for (std::size_t k = 0; k < std::min(most, findings.size()); ++k) {
    const Finding& finding = findings[k];
    const Colour colour = colour_of(finding.severity);
    const std::string repair = finding.repair.empty() ? "" : "; " + finding.repair;
    text += fmt::format("  {}  {}: {}{}\n", console.paint(colour, to_string(finding.severity)),
                        harmless(to_string(finding.what)), finding.meaning, repair);
  }
  if (findings.size() > most) text += fmt::format("  and {} more\n", findings.size() - most);
  return text;
}

}  // namespace

std::string summary(const AlignmentReport& report, const std::string& out, const Console& console) {
  const double length = take_seconds(to_ns(report.begin), to_ns(report.end), report.rate_hz);
  const std::vector<Group> groups = groups_of(report);
  std::vector<std::string> names;
  for (const Group& group : groups) names.push_back(harmless(name_of(group)));
  std::string text = fmt::format(
      "{}: {}, {} frames at {:.4g} Hz, {}\n", out.empty() ? "nothing written" : harmless(out),
      duration_text(length), grouped(report.frames), report.rate_hz, fmt::join(names, " + "));
  text += time_line(groups, report.reference, console);
  for (const SpaceReport& s : report.spaces) text += space_line(s);
  text += gap_lines(groups);
  text += note_lines(report.findings, console);
  // The take contains the full report.
  if (!out.empty()) text += fmt::format("  see    kinalign info {}\n", harmless(out));
  return text;
}

}  // namespace kinalign
