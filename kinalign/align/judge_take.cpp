// SPDX-License-Identifier: Apache-2.0
#include "kinalign/align/judge.h"

#include <fmt/format.h>

#include <algorithm>

namespace kinalign {

namespace {

/// Makes a note for each stream of points or skeletons that keeps its own space, with the reason.
/// It is only a note, since the user may want this.
Findings judge_spaces(const TakeHeader& header) {
  Findings out;
  for (const TakeGroup& group : header.groups) {
    if (std::holds_alternative<ImuGroup>(group.kind) || group.space == "take" ||
        header.parameters.spaces.contains(group.name)) {
      continue;
    }
    if (std::holds_alternative<ClipGroup>(group.kind)) {
      out.push_back({Severity::note,
                     Error{"", 0, "'" + group.name + "' in the take's space",
                           "a skeleton, but only points can be moved"},
                     "its positions stay in its own space", ""});
      continue;
    }
    out.push_back(
        {Severity::note,
         Error{"", 0, "a space for '" + group.name + "'", "no [space." + group.name + "]"},
         "its positions stay in its own space",
         "[space." + group.name + "] method = \"fit\" (or \"none\", if this is intended)"});
  }
  return out;
}

/// Warns about each file of nodes that has the same bytes as another file, because the user
/// probably named it twice. Hashes are compared instead of paths, so a copy is found too.
Findings judge_nodes_alike(const TakeHeader& header) {
  Findings out;
  for (const TakeGroup& group : header.groups) {
    if (!std::holds_alternative<ImuGroup>(group.kind)) continue;
    const auto& files = group.files;
    for (std::size_t i = 0; i < files.size(); ++i) {
      const auto same = [&](const InputFacts& other) { return other.sha256 == files[i].sha256; };
      const auto before = files.begin() + static_cast<std::ptrdiff_t>(i);
      if (std::none_of(files.begin(), before, same)) continue;
      out.push_back(
          {Severity::warning,
           Error{files[i].name, 0, "different files for the nodes of '" + group.name + "'",
                 "the same bytes as another file"},
           "two of its nodes have the same data", "name the other node's own file"});
    }
  }
  return out;
}

/// Warns if two streams read the same samples. One table may contain several bodies, so the same
/// file with different selections is no fault.
Findings judge_streams_alike(const TakeHeader& header) {
  Findings out;
  const auto bytes_of = [](const TakeGroup& group) {
    std::vector<std::string_view> hashes;
    for (const InputFacts& file : group.files) hashes.emplace_back(file.sha256);
    return hashes;
  };
  for (auto later = header.groups.begin(); later != header.groups.end(); ++later) {
    const auto same = [&](const TakeGroup& other) {
      const Manifest& parameters = header.parameters;
      return other.kind.index() == later->kind.index() && bytes_of(other) == bytes_of(*later) &&
             options_of(parameters, other.name).select ==
                 options_of(parameters, later->name).select;
    };
    const auto first = std::find_if(header.groups.begin(), later, same);
    // Streams from memory have no files to compare.
    if (first == later || later->files.empty()) continue;
    out.push_back(
        {Severity::warning,
         Error{later->files.front().name, 0,
               fmt::format("different samples in '{}' and '{}'", later->name, first->name),
               "the same file and the same selection"},
         "both streams have the same data",
         "name the file of the second stream, or select its rows"});
  }
  return out;
}

/// Warns if the streams have little time in common. The usual cause is a wrong start time, or a
/// device that stopped sending. If the body is at rest, residuals don't show this fault.
Findings judge_span(const Recording& recording, const AlignPlan& plan) {
  const auto span = [](const RecordedStream& s) { return seconds(last_of(s) - first_of(s)); };
  const auto& streams = recording.streams;
  const auto by = [](auto value) {
    return [value](const auto& a, const auto& b) { return value(a) < value(b); };
  };
  // The message names the two streams that limit the common time, since one of them may have a
  // wrong start.
  const RecordedStream& late = *std::max_element(streams.begin(), streams.end(), by(first_of));
  const RecordedStream& early = *std::min_element(streams.begin(), streams.end(), by(last_of));
  const RecordedStream& brief = *std::min_element(streams.begin(), streams.end(), by(span));
  const std::string bounds =
      fmt::format("'{}' begins last, '{}' ends first", stream_label(late), stream_label(early));
  const double common = seconds(plan.end - plan.begin);
  if (2.0 * common < span(brief)) {
    return {{Severity::warning,
             Error{"", 0,
                   fmt::format("a common time of most of '{}', {:.2f} s", stream_label(brief),
                               span(brief)),
                   fmt::format("{:.2f} s in common: {}", common, bounds)},
             "the rest is cut off; a fit over so little time looks good at any offset",
             "check start_ns and offset_ms"}};
  }
  const RecordedStream& reference = streams[plan.reference];
  const std::uint64_t cut = reference.survey.kept() - plan.header.frames;
  if (10 * cut <= reference.survey.kept()) return {};
  return {{Severity::note,
           Error{"", 0,
                 fmt::format("all frames of '{}' within the common time of all streams",
                             reference.name),
                 fmt::format("{} of {} outside: {}", cut, reference.survey.kept(), bounds)},
           "the frames outside are cut off", ""}};
}

}  // namespace

/// These findings are known before the first row. They are reported with all others after the last
/// row.
Findings judge_plan(const Recording& recording, const AlignPlan& plan) {
  Findings out = judge_span(recording, plan);
  append(out, judge_spaces(plan.header));
  append(out, judge_nodes_alike(plan.header));
  append(out, judge_streams_alike(plan.header));
  return out;
}

Findings judge_rows(const StreamReport& stream, std::uint64_t rows) {
  // The limit is half of the rows. Shorter absences are reported as gaps.
  if (2 * stream.empty_rows <= rows) return {};
  std::string name = stream.stream;
  if (stream.nodes.size() == 1) name += " " + shown(stream.nodes.front());
  const double share = static_cast<double>(stream.empty_rows) / static_cast<double>(rows);
  return {{Severity::warning,
           Error{"", 0, fmt::format("samples of '{}' in most rows", name),
                 fmt::format("no sample in {:.1f} % of the rows", 100.0 * share)},
           "the take contains little of this stream",
           "check rate_hz and gap_ms of this device, and whether it sent during the whole take"}};
}

Findings judge_residual(const SpaceReport& space) {
  // Chosen limit. After a correct fit, Kinect v2 joints are 6 to 9 cm from optical ones (Keraal:
  // 7.5; Xu and McGorry, Applied Ergonomics 2015). The worst value of another device is 21 cm.
  constexpr double too_far_m = 0.3;
  if (!(space.after_m > too_far_m)) return {};
  return {
      {Severity::warning,
       Error{"", 0, fmt::format("'{}' on '{}' to less than 30 cm rms", space.stream, space.onto),
             fmt::format("{:.1f} cm", 100.0 * space.after_m)},
       "the positions can't be trusted",
       "check that both streams have the same motion, time, units and joints"}};
}

Findings judge_fit(const SpacePlan& plan, const SpaceReport& space) {
  // Chosen limit. The joints of a trunk are 3 to 6 cm from a line through them, those of a whole
  // body at least 20 cm.
  constexpr double near_m = 0.1;
  if (plan.options.method != "fit" || plan.off_line_m >= near_m) return {};
  std::string names;
  for (const JointResidual& joint : space.joints)
    names += (names.empty() ? "" : ", ") + joint.joint;
  return {{Severity::warning,
           Error{"", 0,
                 fmt::format("joints that are at least 10 cm away from a line, to fit '{}'",
                             space.stream),
                 fmt::format("{:.1f} cm: {}", 100.0 * plan.off_line_m, names)},
           "the rotation about this line is a guess, even if the residuals are small",
           "also name joints of arms or legs: joints = { ... }"}};
}

}  // namespace kinalign
