// SPDX-License-Identifier: Apache-2.0
#include "kinalign/align/plan.h"

#include "kinalign/align/unused_options.h"
#include "kinalign/core/nearest_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace kinalign {

namespace {

Result<std::size_t> find_reference(const Recording& recording, const Manifest& manifest) {
  const std::string wanted = reference_name(recording, manifest);
  std::vector<std::string> known;
  for (std::size_t i = 0; i < recording.streams.size(); ++i) {
    if (recording.streams[i].name == wanted) return i;
    known.push_back(recording.streams[i].name);
  }
  return Failure(unknown_name(wanted, "a stream as the reference", known));
}

/// Returns the time spans of all streams as text, for the error that they do not overlap.
std::string spans(const Recording& recording) {
  std::string text;
  for (const RecordedStream& s : recording.streams) {
    if (!text.empty()) text += ", ";
    text += fmt::format("{} {:.3f} to {:.3f} s", stream_label(s),
                        1e-9 * static_cast<double>(to_ns(first_of(s))),
                        1e-9 * static_cast<double>(to_ns(last_of(s))));
  }
  return text;
}

/// Returns the error for a stream without samples: the error of its reader, or else a general
/// error.
Error no_samples(const RecordedStream& s, const Recording& recording) {
  Findings all = all_findings(s);
  if (s.shared_file) append(all, recording.shared_files[*s.shared_file].findings);
  const auto worst = std::max_element(
      all.begin(), all.end(), [](const auto& a, const auto& b) { return a.severity < b.severity; });
  // The reader's own error tells why nothing could be read, so it is more helpful.
  if (worst != all.end() && worst->severity == Severity::error) return worst->what;
  return {s.files.empty() ? "" : s.files.front().name, 0,
          "at least one sample for stream '" + s.name + "'", "none"};
}

/// Sets the plan's begin and end to the time span that all streams share.
Result<void> find_span(const Recording& recording, AlignPlan& plan) {
  plan.begin = Time::min();
  plan.end = Time::max();
  for (const RecordedStream& s : recording.streams) {
    // A stream without samples has no time span. Its error names the cause instead.
    if (s.survey.kept() == 0) return Failure(no_samples(s, recording));
    plan.begin = std::max(plan.begin, first_of(s));
    plan.end = std::min(plan.end, last_of(s));
  }
  if (plan.begin > plan.end) {
    return Failure(Error{"", 0, "streams that overlap in time (see start_ns and offset_ms)",
                         spans(recording), ErrorKind::no_common_span});
  }
  return {};
}

/// For a stream with a fixed step: returns the first frame whose time in the take is at or after
/// `bound` (if `behind`: after `bound`). The times rise with the frame number, so bisection finds
/// the frame.
std::uint64_t first_frame(const RecordedStream& s, double step_ns, Time bound, bool behind) {
  std::uint64_t low = 0, high = s.survey.samples;
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    const Time t = take_time(s.clock, frame_stamp(s.survey.first, step_ns, middle));
    if (t < bound || (behind && t == bound)) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

/// Counts the rows of the reference that are accepted and within the common time span. SlabMaker
/// uses the same Window class, so both accept the same rows.
template <class Frames>
Result<std::uint64_t> count_in_span(Pass<Frames> pass, const RecordedStream& reference,
                                    const AlignPlan& plan) {
  Window window(std::move(pass), reference.clock);
  std::uint64_t rows = 0;
  constexpr std::size_t at_once = 4096;
  for (std::int64_t from = to_ns(plan.begin);; from = window.time_ns.back() + 1) {
    KA_TRY(window.fill(from, at_once));
    const auto& stamps = window.time_ns;
    const auto end = std::upper_bound(stamps.begin(), stamps.end(), to_ns(plan.end));
    rows += static_cast<std::uint64_t>(end - stamps.begin());
    if (end != stamps.end() || stamps.empty()) return rows;
  }
}

/// Returns a pass over rows that have stamps but no values. With this pass a window can count rows
/// without reading the file again.
Pass<PointFrames> stamps_alone(std::shared_ptr<const std::vector<Time>> stamps) {
  return [stamps = std::move(stamps), is_done = false](PointFrames& block) mutable -> Result<bool> {
    block = {};
    if (is_done || stamps->empty()) return false;
    block.stamps = *stamps;
    is_done = true;
    return true;
  };
}

/// Returns the number of rows of the grid. With a fixed step it is computed. If the whole reference
/// is used, it is the number of accepted samples. Otherwise the reference's stamps are counted; if
/// they are not in memory, they are read again. The survey can't be used then, because it judged
/// the device's stamps. After conversion to the take's time axis, other rows may be accepted.
Result<std::uint64_t> count_rows(const RecordedStream& reference, const AlignPlan& plan) {
  if (reference.step_ns) {
    return first_frame(reference, *reference.step_ns, plan.end, true) -
           first_frame(reference, *reference.step_ns, plan.begin, false);
  }
  const bool is_uncut = first_of(reference) >= plan.begin && last_of(reference) <= plan.end;
  const bool is_shifted_only =
      reference.clock.pieces.size() == 1 && reference.clock.pieces.front().drift_ppm == 0.0;
  if (is_uncut && is_shifted_only) {
    return reference.survey.kept();
  }
  if (reference.stamps) return count_in_span(stamps_alone(reference.stamps), reference, plan);
  return std::visit(
      [&](const auto& input) -> Result<std::uint64_t> {
        return count_in_span(KA_TRY(input.passes()), reference, plan);
      },
      reference.data);
}

/// Returns the parameters for resampling a stream: its step, the longest gap to interpolate, and
/// the curve for rotations.
ResampleRule rule_of(const RecordedStream& s, const StreamOptions& stream,
                     const AlignOptions& options) {
  ResampleRule rule;
  rule.step_ns = usual_step_ns(s, stream);
  rule.gap_ns = options.gap_ms > 0.0 ? std::llround(options.gap_ms * 1e6) : 3 * rule.step_ns;
  // If stamps are rounded to milli- or microseconds, three steps may be slightly longer than three
  // median steps.
  if (options.gap_ms == 0.0) rule.gap_ns += rule.step_ns / 10;
  rule.curve = options.rotations == "slerp" ? RotationCurve::slerp : RotationCurve::spline;
  return rule;
}

/// The kind of a group is given by the stream's data.
std::variant<ClipGroup, PointGroup, ImuGroup> kind_of(const RecordedStream& s,
                                                      const StreamOptions& options) {
  if (const auto* clip = std::get_if<ClipInput>(&s.data)) return ClipGroup{clip->skeleton};
  if (const auto* points = std::get_if<PointInput>(&s.data)) return PointGroup{points->joint_names};
  const auto& imu = std::get<ImuInput>(s.data);
  return ImuGroup{imu.node_names, imu.content, options.root_node};
}

/// Returns the space of a stream's positions: "take" for the reference's space, or the name of the
/// stream that gives the space and is not moved.
std::string space_of(const std::string& stream, const std::string& reference,
                     const Manifest& manifest) {
  const auto found = manifest.spaces.find(stream);
  const bool moved = found != manifest.spaces.end() && found->second.method != "none";
  const std::string& in = moved ? found->second.onto : stream;
  return in.empty() || in == reference ? "take" : in;
}

/// Returns a stream's file and kind as text, for example "kinect.csv (points)".
std::string file_and_kind(const std::vector<InputFacts>& files, std::size_t kind) {
  constexpr std::array<std::string_view, 3> kinds{"a skeleton", "points", "nodes"};
  return fmt::format("{} ({})", files.empty() ? "memory" : files.front().name, kinds[kind]);
}

/// Adds another stream of nodes to the group with the same name.
Result<void> join(TakeGroup& group, const RecordedStream& s) {
  auto* nodes = std::get_if<ImuGroup>(&group.kind);
  const auto* imu = std::get_if<ImuInput>(&s.data);
  if (nodes == nullptr || imu == nullptr) {
    return Failure(Error{
        "", 0, "streams with different names",
        fmt::format("'{}' twice: {} and {}", s.name, file_and_kind(group.files, group.kind.index()),
                    file_and_kind(s.files, s.data.index()))});
  }
  if (!(nodes->content == imu->content)) {
    return Failure(Error{"", 0, "nodes of '" + s.name + "' that measure the same quantities",
                         "'" + imu->node_names.front() + "', which measures other quantities"});
  }
  // Node names are unique in a group, because they name its columns.
  for (const std::string& node : imu->node_names) {
    if (std::find(nodes->node_names.begin(), nodes->node_names.end(), node) !=
        nodes->node_names.end()) {
      return Failure(Error{"", 0, "nodes with different names", "'" + node + "' twice"});
    }
    nodes->node_names.push_back(node);
  }
  group.interval_known = group.interval_known || any_known(s.clock);
  const auto is_known = [&group](const InputFacts& facts) {
    return std::find(group.files.begin(), group.files.end(), facts) != group.files.end();
  };
  // All nodes of one recording have the same files, so each file is listed once in the group.
  const bool one_recording =
      s.format == "recording" && std::all_of(s.files.begin(), s.files.end(), is_known);
  if (!one_recording) group.files.insert(group.files.end(), s.files.begin(), s.files.end());
  return {};
}

/// Plans each stream and assigns it to a group. Streams of nodes with the same name share a group.
Result<void> make_groups(const Recording& recording, const Manifest& manifest, AlignPlan& plan) {
  auto& groups = plan.header.groups;
  const RecordedStream& reference = recording.streams[plan.reference];
  const ResampleRule grid =
      rule_of(reference, options_of(manifest, reference.name), manifest.align);
  for (std::size_t i = 0; i < recording.streams.size(); ++i) {
    const RecordedStream& s = recording.streams[i];
    StreamPlan stream;
    stream.rule = rule_of(s, options_of(manifest, s.name), manifest.align);
    stream.rule.taken = taken_step(s, options_of(manifest, s.name),
                                   i == plan.reference ? Role::reference : Role::resampled);
    stream.rule.begin_ns = to_ns(plan.begin);
    stream.rule.end_ns = to_ns(plan.end);
    // The grid is coarser than the stream if its step is clearly longer. Only a coarser grid can
    // lose fast motion.
    stream.rule.finer =
        static_cast<double>(stream.rule.step_ns) < 0.9 * static_cast<double>(grid.step_ns);
    const auto same = std::find_if(groups.begin(), groups.end(),
                                   [&s](const TakeGroup& g) { return g.name == s.name; });
    stream.group = static_cast<std::size_t>(same - groups.begin());
    if (same == groups.end()) {
      const bool resampled = i != plan.reference;
      groups.push_back({s.name, kind_of(s, options_of(manifest, s.name)), resampled,
                        resampled && any_known(s.clock), s.files,
                        space_of(s.name, reference.name, manifest)});
    } else {
      // The columns of a further stream of nodes follow the columns that the group already has.
      if (const auto* nodes = std::get_if<ImuGroup>(&same->kind)) {
        stream.first_node = nodes->node_names.size();
      }
      KA_TRY(join(*same, s));
    }
    plan.streams.push_back(stream);
  }
  return {};
}

/// Returns the error for a name under `key` that is no node of the group.
Error unknown_node(const TakeGroup& group, const std::vector<std::string>& nodes,
                   const StreamOptions& options, const std::string& name, const std::string& key) {
  Error error = unknown_name(name, "a node of '" + group.name + "' for " + key, nodes);
  error.kind = ErrorKind::no_such_node;
  error.line = line_of(options.lines, key);
  return error;
}

/// Fails if a root_node is not a node of its stream or if the nodes have no orientations.
Result<void> check_roots(const TakeHeader& header, const Manifest& manifest) {
  for (const TakeGroup& group : header.groups) {
    const auto* nodes = std::get_if<ImuGroup>(&group.kind);
    if (nodes == nullptr || nodes->root_node.empty()) continue;
    const auto& names = nodes->node_names;
    const StreamOptions& options = options_of(manifest, group.name);
    if (std::find(names.begin(), names.end(), nodes->root_node) == names.end()) {
      return Failure(unknown_node(group, names, options, nodes->root_node, "root_node"));
    }
    if (!nodes->content.orientation) {
      return Failure(Error{"", line_of(options.lines, "root_node"),
                           "orientations in '" + group.name + "', for root_node", "none"});
    }
  }
  return {};
}

/// Fails if a mounting is given for a node that its stream does not have. Otherwise a misspelt name
/// would be ignored.
Result<void> check_mountings(const TakeHeader& header, const Manifest& manifest) {
  for (const TakeGroup& group : header.groups) {
    const auto* nodes = std::get_if<ImuGroup>(&group.kind);
    const auto names = nodes == nullptr ? std::vector<std::string>{} : nodes->node_names;
    const StreamOptions& options = options_of(manifest, group.name);
    for (const auto& [worn, rotation] : options.mounting) {
      if (std::find(names.begin(), names.end(), worn) != names.end()) continue;
      return Failure(unknown_node(group, names, options, worn, "mounting"));
    }
  }
  return {};
}

Result<void> check_nodes(const TakeHeader& header, const Manifest& manifest) {
  KA_TRY(check_roots(header, manifest));
  return check_mountings(header, manifest);
}

/// The names become groups of the take, so they are checked first.
Result<void> check_streams(const Recording& recording) {
  if (recording.streams.empty()) return Failure(Error{"", 0, "at least one stream", "none"});
  for (const RecordedStream& stream : recording.streams) KA_TRY(check_stream_name(stream.name));
  return {};
}

}  // namespace

std::string reference_name(const Recording& recording, const Manifest& manifest) {
  const bool is_stated = !manifest.align.reference.empty() || recording.streams.empty();
  return is_stated ? manifest.align.reference : recording.streams.front().name;
}

Result<AlignPlan> plan_alignment(const Recording& recording, const Manifest& manifest) {
  KA_TRY(check_streams(recording));
  AlignPlan plan;
  plan.reference = KA_TRY(find_reference(recording, manifest));
  const RecordedStream& reference = recording.streams[plan.reference];
  // Streams of nodes share a group although their stamps may differ, so none of them can be the
  // grid.
  if (std::holds_alternative<ImuInput>(reference.data)) {
    return Failure(
        Error{"", 0, "a skeleton or points as the reference (reference = in [align])", "nodes"});
  }
  // If there are several faults, the first check that fails decides which one is reported.
  KA_TRY(check_options_used(recording, manifest));
  KA_TRY(find_span(recording, plan));
  KA_TRY(make_groups(recording, manifest, plan));
  KA_TRY(check_nodes(plan.header, manifest));
  plan.header.subject = recording.subject;
  plan.header.action = recording.action;
  plan.header.parameters = manifest;
  // The header must be complete before the first row. The rows are counted last, because the count
  // needs the time span.
  plan.header.frames = KA_TRY(count_rows(reference, plan));
  if (plan.header.frames == 0) {
    return Failure(Error{"", 0, "frames of '" + reference.name + "' in the common span",
                         "no frame; " + spans(recording), ErrorKind::no_common_span});
  }
  return plan;
}

}  // namespace kinalign
