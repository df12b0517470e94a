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

/// The streams of the report with one name: a device, or all nodes.
/// Nodes of one device are many streams in the report. The summary shows them as one.
struct Group {
  StreamReport sum;                 // the sums over all parts
  std::vector<StreamReport> parts;  // one, or one for each node's file
  std::size_t nodes = 0;
};

/// Adds a part's counts. The group's interval is the worst of its parts, and unknown if one is
/// unknown.
void add(Group& group, const StreamReport& s) {
  StreamReport& sum = group.sum;
  sum.gaps += s.gaps;
  sum.gap_time_ns += s.gap_time_ns;
  sum.samples += s.samples;
  sum.invalid += s.invalid;
  sum.inferred += s.inferred;
  sum.bridged += s.bridged;
  sum.unsure += s.unsure;
  // One unknown part makes the whole unknown: the summary must not look better than the worst node.
  if (!s.worst_interval_ns) {
    sum.worst_interval_ns.reset();
  } else if (sum.worst_interval_ns) {
    sum.worst_interval_ns = std::max(*sum.worst_interval_ns, *s.worst_interval_ns);
  }
  sum.counted = sum.counted || s.counted;
  group.nodes += s.nodes.size();
  group.parts.push_back(s);
}

/// Groups the streams of the report by name; nodes of one stream are neighbours in it.
std::vector<Group> groups_of(const AlignmentReport& report) {
  std::vector<Group> groups;
  for (const StreamReport& s : report.streams) {
    // A new name begins a new group. 0 is the neutral value for the maximum.
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

/// Orders streams by the half-width of their interval in time: an unknown one is the largest.
std::int64_t doubt(const StreamReport& s) { return s.worst_interval_ns.value_or(INT64_MAX); }

/// The samples that a user should not trust: invalid or interpolated over loss.
std::uint64_t harm(const StreamReport& s) { return s.invalid + s.bridged; }

/// ", worst node: wrist_left" if the nodes differ in `measure`.
template <class Measure>
std::string worst_node(const Group& group, Measure measure) {
  // Equal nodes have no worst one.
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
  // The colour is that of a warning: without an interval the error of the times is not known.
  if (!known || group.sum.unsure > 0) sure = console.paint(Colour::warning, sure);
  return harmless(name_of(group)) + " " + sure + worst_node(group, doubt);
}

/// The line about time: the least certain stream first. The reference is left out.
std::string time_line(std::vector<Group> groups, const std::string& reference,
                      const Console& console) {
  std::stable_sort(groups.begin(), groups.end(),
                   [](const Group& a, const Group& b) { return doubt(a.sum) > doubt(b.sum); });
  std::vector<std::string> texts;
  for (const Group& group : groups) {
    // The reference defines the grid, so its time has no error against it.
    if (group.sum.stream != reference) texts.push_back(time_text(group, console));
  }
  return texts.empty() ? "" : fmt::format("  time   {}\n", fmt::join(texts, "   "));
}

/// The line about a stream that was moved into another's space, with the joint of the largest
/// residual.
std::string space_line(const SpaceReport& s) {
  const Eigen::AngleAxisd turn(s.transform.rotation);
  std::string how = "root onto root in every frame";
  // The three methods of moving a stream: per frame (paper), fitted, or given.
  if (s.method == "fit") how = "fitted once per take";
  if (s.method == "given") how = "as given";
  std::string text =
      fmt::format("  space  {} on {} {:.1f} cm rms (before: {:.1f}), rotation {:.1f}°, {}",
                  harmless(s.stream), harmless(s.onto), 100.0 * s.after_m, 100.0 * s.before_m,
                  turn.angle() * 180.0 / std::numbers::pi, how);
  if (!s.joints.empty()) {
    // The report lists the joints with the largest residual first.
    const JointResidual& worst = s.joints.front();
    text +=
        fmt::format("; worst joint: {} {:.1f} cm", harmless(worst.joint), 100.0 * worst.after_m);
  }
  return text + "\n";
}

/// The line about a stream's gaps and doubtful samples. Empty if there are none.
std::string gap_line(const Group& group) {
  const StreamReport& s = group.sum;
  // A stream without a fault has no line, which keeps the summary short.
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

/// The lines about gaps, the stream with the largest share of doubtful samples first.
std::string gap_lines(std::vector<Group> groups) {
  const auto part = [](const Group& g) {
    // The share decides and not the count, since streams have different rates. The maximum avoids a
    // division by zero.
    return static_cast<double>(harm(g.sum)) / std::max(1.0, static_cast<double>(g.sum.samples));
  };
  std::stable_sort(groups.begin(), groups.end(),
                   [part](const Group& a, const Group& b) { return part(a) > part(b); });
  std::string text;
  for (const Group& group : groups) text += gap_line(group);
  return text;
}

/// The most severe findings, a line each. Longer lists are left to `kinalign info`.
std::string note_lines(const Findings& findings, const Console& console) {
  // The list is expected to be sorted by severity.
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
  // The full report is in the take.
  if (!out.empty()) text += fmt::format("  see    kinalign info {}\n", harmless(out));
  return text;
}

}  // namespace kinalign
