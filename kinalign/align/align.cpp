// SPDX-License-Identifier: Apache-2.0
#include "kinalign/align/align.h"

#include "kinalign/align/judge.h"
#include "kinalign/align/marks.h"
#include "kinalign/align/nodes.h"
#include "kinalign/align/plan.h"
#include "kinalign/align/slabs.h"
#include "kinalign/align/space.h"
#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace kinalign {

namespace {

/// Returns for each group whether a fit needs it: groups that are fitted, and groups onto which
/// others are fitted. The pass for fits reads only these groups and the reference.
std::vector<bool> groups_of_fits(const std::vector<SpacePlan>& spaces, std::size_t groups) {
  std::vector<bool> out(groups, false);
  for (const SpacePlan& space : spaces) {
    if (space.options.method == "fit") out[space.group] = out[space.onto] = true;
  }
  return out;
}

/// Fits the rigid transform of a space to the pairs of joints summed in `moments`. The sums suffice
/// for the fit, so no row is stored.
Result<void> fit_space(const PairMoments& moments, const std::string& name, SpacePlan& space) {
  if (moments.count == 0) {
    return Failure(Error{name, 0, "rows for a fit, with tracked joints of both streams",
                         "no such row (check rate_hz and gap_ms)"});
  }
  auto fitted = fit_rigid(moments);
  if (!fitted) {
    fitted.error().file = name;
    return Failure(std::move(fitted).error());
  }
  space.transform = *fitted;
  // Joints close to one line are not an error here; judge_fit() warns about them.
  space.off_line_m = spread_off_line(moments);
  return {};
}

/// Computes the fitted transforms in one pass over the streams that need one. The pass makes the
/// same rows as the take itself, so the fit uses the same resampled points that are moved later.
Result<void> fit_spaces(const Recording& recording, const AlignPlan& plan,
                        std::vector<SpacePlan>& spaces, const Progress& progress,
                        std::size_t jobs) {
  const auto groups = groups_of_fits(spaces, plan.header.groups.size());
  if (std::find(groups.begin(), groups.end(), true) == groups.end()) return {};
  SlabMaker slabs = KA_TRY(SlabMaker::start(recording, plan, groups));
  std::vector<PairMoments> moments(spaces.size());
  KA_TRY(slabs.for_each(jobs, [&](TakeSlab& slab) -> Result<void> {
    for (std::size_t k = 0; k < spaces.size(); ++k) {
      if (spaces[k].options.method == "fit") add_pairs(spaces[k], slab, moments[k]);
    }
    if (go_on(progress, "fitting", slab.first, plan.header.frames)) return {};
    return Failure(interruption());
  }));
  for (std::size_t k = 0; k < spaces.size(); ++k) {
    if (spaces[k].options.method != "fit") continue;
    KA_TRY(fit_space(moments[k], plan.header.groups[spaces[k].group].name, spaces[k]));
  }
  return {};
}

/// Adds the counts of one stream's rows in a slab.
void add_marks(const TakeSlab& slab, const TakeHeader& header, const RecordedStream& s,
               const StreamPlan& stream, Marks& marks) {
  const auto& rows = slab.rows[stream.group];
  if (const auto* clip = std::get_if<ClipRows>(&rows)) {
    add_marks(*clip, marks);
  } else if (const auto* points = std::get_if<PointRows>(&rows)) {
    add_marks(*points, std::get<PointInput>(s.data).joint_names.size(), marks);
  } else {
    // A stream of nodes counts only its own columns of the group.
    const auto& group = std::get<ImuGroup>(header.groups[stream.group].kind);
    add_marks(std::get<ImuRows>(rows), {stream.first_node, group.node_names.size()},
              std::get<ImuInput>(s.data).node_names.size(), marks);
  }
}

/// Removes folders from file names, because a take must not depend on the location of its inputs.
Findings without_folders(Findings findings) {
  for (Finding& finding : findings) finding.what.file = file_name(finding.what.file);
  return findings;
}

/// Begins the report with all facts that are known before the first row: the findings about files,
/// stamps and the plan.
AlignmentReport begin_report(const Recording& recording, const AlignPlan& plan) {
  AlignmentReport report;
  report.frames = plan.header.frames;
  report.reference = recording.streams[plan.reference].name;
  report.rate_hz = plan.streams[plan.reference].rule.rate_hz();
  for (std::size_t i = 0; i < recording.streams.size(); ++i) {
    const RecordedStream& s = recording.streams[i];
    if (const SharedFile* file = newly_read_file(recording, i)) {
      append(report.findings, without_folders(file->findings));
      report.marks.insert(report.marks.end(), file->marks.begin(), file->marks.end());
    }
    Findings found = without_folders(all_findings(s));
    append(found, judge_stamps(s, options_of(plan.header.parameters, s.name)));
    append(report.findings, with_stream_name(s, recording, std::move(found)));
  }
  append(report.findings, judge_plan(recording, plan));
  return report;
}

/// Counts over all slabs. Each slab is passed on and not kept, so all facts about rows in the
/// report are counted here.
struct Counts {
  std::uint64_t rows = 0;
  Time begin{}, end{};                  // times of the first and the last row
  std::vector<ResidualSums> residuals;  // one for each space
  std::vector<Marks> marks;             // one for each stream
};

Counts no_counts(const Recording& recording, const std::vector<SpacePlan>& spaces) {
  Counts out;
  out.residuals.reserve(spaces.size());
  for (const SpacePlan& space : spaces) out.residuals.emplace_back(space.pairs.size());
  out.marks.resize(recording.streams.size());
  return out;
}

/// The plan and the spaces of one call of align(). The members are valid during that call.
struct Job {
  const Recording& recording;
  const AlignPlan& plan;
  const std::vector<SpacePlan>& spaces;
};

/// The error if the reference now has another number of frames than in the first pass. The header
/// already states that number, and a file with another number of rows would be inconsistent.
Error other_length(const Job& job, std::uint64_t rows) {
  return {job.recording.streams[job.plan.reference].name, 0,
          fmt::format("{} frames, as in the first reading", job.plan.header.frames),
          fmt::format("{}", rows)};
}

/// Moves the points of a slab into their spaces, counts its rows, and passes the slab to the sink.
/// Rows without their root joint become invalid when they are moved, so they are counted after
/// that.
Result<void> pass_slab(const Job& job, TakeSlab& slab, const TakeSink& sink,
                       const Progress& progress, Counts& counts) {
  if (counts.rows == 0) counts.begin = slab.stamps.front();
  counts.end = slab.stamps.back();
  counts.rows += slab.stamps.size();
  if (counts.rows > job.plan.header.frames) return Failure(other_length(job, counts.rows));
  for (std::size_t k = 0; k < job.spaces.size(); ++k) {
    counts.residuals[k].transform(job.spaces[k], slab);
  }
  for (std::size_t i = 0; i < counts.marks.size(); ++i) {
    add_marks(slab, job.plan.header, job.recording.streams[i], job.plan.streams[i],
              counts.marks[i]);
  }
  KA_TRY(sink.rows(slab));
  if (go_on(progress, "aligning", counts.rows, job.plan.header.frames)) return {};
  return Failure(interruption());
}

/// Returns the report of one stream: the counts of its samples, the counts of its rows, and the
/// widest time interval of its clock.
StreamReport report_stream(const Job& job, const SlabMaker& slabs, const Counts& counts,
                           std::size_t i) {
  const StreamCounts seen = slabs.counts(i);
  const RecordedStream& s = job.recording.streams[i];
  StreamReport out;
  out.stream = s.name;
  if (const auto* imu = std::get_if<ImuInput>(&s.data)) out.nodes = imu->node_names;
  out.survey = s.survey;
  out.counted = s.counted;
  const ResampleRule& rule = job.plan.streams[i].rule;
  out.rate_hz = rule.rate_hz();
  out.gap_ns = rule.gap_ns;
  out.held_back = seen.held_back;
  out.arrivals = seen.arrivals;
  out.gaps = seen.gaps.gaps;
  out.gap_time_ns = seen.gaps.time_ns;
  const Marks& marks = counts.marks[i];
  out.samples = marks.samples;
  out.invalid = marks.invalid;
  out.empty_rows = marks.empty_rows;
  out.inferred = marks.inferred;
  out.bridged = marks.bridged;
  out.unsure = marks.unsure;
  out.worst_nearest_ns = marks.worst_nearest_ns;
  // If the clock has several pieces, the widest interval counts. Pieces without an interval are
  // ignored.
  for (const TimeModelPiece& piece : s.clock.pieces) {
    if (!piece.half_width) continue;
    out.worst_interval_ns = std::max(out.worst_interval_ns.value_or(0), piece.half_width->count());
  }
  return out;
}

/// Completes the report after the last row and sorts the findings by severity. Findings of equal
/// severity stay in the order of the streams.
void finish_report(const Job& job, const SlabMaker& slabs, const Counts& counts,
                   AlignmentReport& report) {
  report.begin = counts.begin;
  report.end = counts.end;
  for (std::size_t i = 0; i < job.recording.streams.size(); ++i) {
    const RecordedStream& stream = job.recording.streams[i];
    report.streams.push_back(report_stream(job, slabs, counts, i));
    const Role role = i == job.plan.reference ? Role::reference : Role::resampled;
    const Arrivals& arrivals = report.streams.back().arrivals;
    Findings found = judge_arrivals(stream, arrivals, role);
    append(found,
           judge_start(stream, options_of(job.plan.header.parameters, stream.name), arrivals));
    append(report.findings, with_stream_name(stream, job.recording, std::move(found)));
    append(report.findings, judge_rows(report.streams.back(), counts.rows));
    append(report.findings, judge_content(stream, slabs.content(i), report.rate_hz));
  }
  for (std::size_t k = 0; k < job.spaces.size(); ++k) {
    report.spaces.push_back(counts.residuals[k].report(job.spaces[k], job.plan.header));
    append(report.findings, judge_residual(report.spaces.back()));
    append(report.findings, judge_fit(job.spaces[k], report.spaces.back()));
  }
  std::stable_sort(report.findings.begin(), report.findings.end(),
                   [](const Finding& a, const Finding& b) { return a.severity > b.severity; });
}

}  // namespace

Result<AlignmentReport> align(const Recording& recording, const Manifest& manifest,
                              const TakeSink& sink, const Progress& progress, std::size_t jobs) {
  // The plan and the spaces are made before any value is read, so an error in the manifest is
  // reported at once.
  const AlignPlan plan = KA_TRY(plan_alignment(recording, manifest));
  const std::size_t reference_group = plan.streams[plan.reference].group;
  auto spaces = KA_TRY(plan_spaces(plan.header, manifest, reference_group));
  KA_TRY(fit_spaces(recording, plan, spaces, progress, jobs));

  // The sink needs the number of rows before it creates its file.
  KA_TRY(sink.begin(plan.header));
  SlabMaker slabs =
      KA_TRY(SlabMaker::start(recording, plan, std::vector<bool>(plan.header.groups.size(), true)));
  const Job job{recording, plan, spaces};
  Counts counts = no_counts(recording, spaces);
  KA_TRY(slabs.for_each(
      jobs, [&](TakeSlab& slab) { return pass_slab(job, slab, sink, progress, counts); }));
  if (counts.rows != plan.header.frames) return Failure(other_length(job, counts.rows));
  // The rest of each stream is read, so that findings do not depend on the time span of the take.
  KA_TRY(slabs.read_rest([&]() -> Result<void> {
    if (go_on(progress, "aligning", counts.rows, plan.header.frames)) return {};
    return Failure(interruption());
  }));
  AlignmentReport report = begin_report(recording, plan);
  finish_report(job, slabs, counts, report);
  return report;
}

}  // namespace kinalign
