// SPDX-License-Identifier: Apache-2.0
#include "kinalign/align/slabs.h"

#include "kinalign/align/nodes.h"
#include "kinalign/align/own_rows.h"
#include "kinalign/align/rotation_signs.h"
#include "kinalign/core/parallel.h"

#include <algorithm>

namespace kinalign {

namespace {

/// Returns the number of values in a row of a group. A joint of a skeleton has 3 + 3 + 4 values, a
/// point 3 and a state. A node has 4 + 3 + 3 values and some about its quality.
std::size_t width(const TakeGroup& group) {
  if (const auto* clip = std::get_if<ClipGroup>(&group.kind)) return 10 * clip->skeleton.joints();
  if (const auto* points = std::get_if<PointGroup>(&group.kind)) {
    return 4 * points->joint_names.size();
  }
  return 12 * std::get<ImuGroup>(group.kind).node_names.size();
}

/// Returns the number of rotations in a row of a group.
std::size_t rotations_of(const TakeGroup& group) {
  if (const auto* clip = std::get_if<ClipGroup>(&group.kind)) return clip->skeleton.joints();
  if (const auto* nodes = std::get_if<ImuGroup>(&group.kind)) return nodes->node_names.size();
  return 0;
}

/// Returns the number of rows of a slab. If the rows of a take are wide, it is reduced so that a
/// slab has about slab_bytes, but never below 16.
std::size_t rows_at_once(const TakeHeader& header) {
  std::size_t numbers = 1;
  for (const TakeGroup& group : header.groups) numbers += width(group);
  return std::clamp<std::size_t>(slab_bytes / (sizeof(double) * numbers), 16, slab_rows);
}

/// Takes the reference's rows within the common time span from a window.
template <class Frames>
class ReferenceRows {
 public:
  ReferenceRows(Pass<Frames> pass, const RecordedStream& stream, const AlignPlan& plan)
      : window_(std::move(pass), stream.clock, plan.streams[plan.reference].rule.gap_count(),
                plan.streams[plan.reference].rule.taken),
        most_rows_(rows_at_once(plan.header)),
        begin_(to_ns(plan.begin)),
        end_(to_ns(plan.end)) {}

  /// Moves the frames of the next slab to `out` and writes their stamps to `grid`.
  Result<void> next(Frames& out, std::vector<std::int64_t>& grid) {
    out = {};
    grid.clear();
    KA_TRY(window_.fill(begin_, most_rows_));
    const auto& stamps = window_.time_ns;
    const auto first = std::lower_bound(stamps.begin(), stamps.end(), begin_);
    // If the reference is slow, the limit prevents a slab from needing hours of the other streams.
    const std::int64_t until = first == stamps.end() ? end_ : *first + longest_slab_ns;
    const auto last = std::upper_bound(first, stamps.end(), std::min(end_, until));
    const std::size_t rows = std::min(static_cast<std::size_t>(last - first), most_rows_);
    if (rows == 0) return {};
    grid.assign(first, first + static_cast<std::ptrdiff_t>(rows));
    append_rows(out, window_.rows, static_cast<std::size_t>(first - stamps.begin()), rows);
    // The next slab begins after the last row. Stamps always rise, so no row is skipped or
    // repeated.
    begin_ = grid.back() + 1;
    return {};
  }
  StreamCounts counts() const { return window_.counts(); }

 private:
  Window<Frames> window_;
  std::size_t most_rows_;
  std::int64_t begin_, end_;
};

/// The rows of the reference in one slab.
struct ReferenceSlab {
  // Stamps of the rows, ns on the take's time axis. Empty after the last slab.
  std::vector<std::int64_t> grid;
  std::variant<ClipFrames, PointFrames> rows;
};

/// The state of a stream in this pass. std::monostate: its group is not included.
using StreamRows =
    std::variant<std::monostate, ReferenceRows<ClipFrames>, ReferenceRows<PointFrames>,
                 PointResampler, ImuResampler, ClipResampler>;

}  // namespace

/// The streams of a pass, in the order of the recording. The caller of start() owns `recording` and
/// `plan`.
struct SlabMaker::State {
  const Recording* recording = nullptr;
  const AlignPlan* plan = nullptr;
  std::vector<StreamRows> streams;
  ImuRows nodes;                     // rows of one stream, before they are copied into the group
  std::vector<RotationSigns> signs;  // one for each group
  std::vector<ReadNext> rests;       // streams that must be read to their ends
  std::uint64_t rest_rows = 0;
  std::uint64_t done = 0;

  Result<void> open(std::size_t i);
  /// Uses only the reference stream. The functions below use only the other streams, so both may
  /// run in parallel.
  Result<void> pull(ReferenceSlab& next);
  Result<void> make(ReferenceSlab& reference, TakeSlab& slab);
  void put_reference(ReferenceSlab& reference, TakeSlab& slab) const;
  Result<void> other_rows(std::size_t i, std::span<const std::int64_t> grid, TakeSlab& slab);
  void finish_nodes(TakeSlab& slab) const;
  void align_signs(TakeSlab& slab);
};

/// Opens a stream as reference rows or as a resampler. Copies of a pass share the position in the
/// file, so the copy in `rests` continues where the rows stopped.
Result<void> SlabMaker::State::open(std::size_t i) {
  const RecordedStream& s = recording->streams[i];
  const ResampleRule& rule = plan->streams[i].rule;
  const bool reference = i == plan->reference;
  if (const auto* clip = std::get_if<ClipInput>(&s.data)) {
    auto pass = KA_TRY(clip->passes());
    if (s.late_findings) rests.push_back(read_on(pass, s.clock, rest_rows));
    if (reference) {
      streams[i].emplace<ReferenceRows<ClipFrames>>(std::move(pass), s, *plan);
    } else {
      streams[i].emplace<ClipResampler>(std::move(pass), s.clock, rule);
    }
  } else if (const auto* points = std::get_if<PointInput>(&s.data)) {
    auto pass = KA_TRY(points->passes());
    if (s.late_findings) rests.push_back(read_on(pass, s.clock, rest_rows));
    if (reference) {
      streams[i].emplace<ReferenceRows<PointFrames>>(std::move(pass), s, *plan);
    } else {
      streams[i].emplace<PointResampler>(std::move(pass), s.clock, rule);
    }
  } else {
    const auto& imu = std::get<ImuInput>(s.data);
    auto pass = KA_TRY(imu.passes());
    if (s.late_findings) rests.push_back(read_on(pass, s.clock, rest_rows));
    streams[i].emplace<ImuResampler>(std::move(pass), s.clock, rule, imu.content);
  }
  return {};
}

/// Takes the reference's rows for the next slab. An empty grid means that the take has ended.
Result<void> SlabMaker::State::pull(ReferenceSlab& next) {
  StreamRows& stream = streams[plan->reference];
  if (auto* clip = std::get_if<ReferenceRows<ClipFrames>>(&stream)) {
    return clip->next(next.rows.emplace<ClipFrames>(), next.grid);
  }
  auto& points = std::get<ReferenceRows<PointFrames>>(stream);
  return points.next(next.rows.emplace<PointFrames>(), next.grid);
}

/// The reference is not resampled. Its frames are moved into the slab, and its stamps are the grid.
void SlabMaker::State::put_reference(ReferenceSlab& reference, TakeSlab& slab) const {
  const std::size_t group = plan->streams[plan->reference].group;
  for (const std::int64_t t : reference.grid) slab.stamps.push_back(utc_time(t));
  if (auto* clip = std::get_if<ClipFrames>(&reference.rows)) {
    const auto& clip_group = std::get<ClipGroup>(plan->header.groups[group].kind);
    slab.rows[group] = own_rows(clip_group.skeleton, std::move(*clip));
  } else {
    slab.rows[group] = own_rows(std::move(std::get<PointFrames>(reference.rows)));
  }
}

// Resamples one stream to the stamps of the slab and stores the rows in its group.
Result<void> SlabMaker::State::other_rows(std::size_t i, std::span<const std::int64_t> grid,
                                          TakeSlab& slab) {
  const std::size_t group = plan->streams[i].group;
  StreamRows& stream = streams[i];
  if (auto* points = std::get_if<PointResampler>(&stream)) {
    PointRows rows;
    KA_TRY(points->rows(grid, rows));
    slab.rows[group] = std::move(rows);
  } else if (auto* clip = std::get_if<ClipResampler>(&stream)) {
    ClipRows rows;
    KA_TRY(clip->rows(grid, rows));
    fill_positions(std::get<ClipGroup>(plan->header.groups[group].kind).skeleton, rows,
                   grid.size());
    slab.rows[group] = std::move(rows);
  } else if (auto* imu = std::get_if<ImuResampler>(&stream)) {
    const auto& nodes_group = std::get<ImuGroup>(plan->header.groups[group].kind);
    KA_TRY(imu->rows(grid, !nodes_group.root_node.empty(), nodes));
    // The first stream of the group replaces the empty rows; the other streams add their columns.
    if (!std::holds_alternative<ImuRows>(slab.rows[group])) slab.rows[group] = ImuRows{};
    put_nodes(nodes, grid.size(), {plan->streams[i].first_node, nodes_group.node_names.size()},
              std::get<ImuRows>(slab.rows[group]));
  }
  return {};
}

/// Mountings are applied before the conversion to the root's space, because that space is the space
/// of the root's bone. Both steps need all nodes of a row, so they follow after every stream.
void SlabMaker::State::finish_nodes(TakeSlab& slab) const {
  for (std::size_t g = 0; g < slab.rows.size(); ++g) {
    const TakeGroup& group = plan->header.groups[g];
    const auto* nodes_group = std::get_if<ImuGroup>(&group.kind);
    auto* rows = std::get_if<ImuRows>(&slab.rows[g]);
    if (nodes_group == nullptr || rows == nullptr) continue;
    apply_mounting(*nodes_group, options_of(plan->header.parameters, group.name).mounting, *rows);
    if (!nodes_group->root_node.empty()) bring_to_root(*nodes_group, *rows);
  }
}

/// Signs are chosen last, because all earlier rotations may change them.
void SlabMaker::State::align_signs(TakeSlab& slab) {
  for (std::size_t g = 0; g < slab.rows.size(); ++g) {
    if (auto* clip = std::get_if<ClipRows>(&slab.rows[g])) {
      signs[g].align(clip->local_rotations, clip->valid);
    } else if (auto* imu = std::get_if<ImuRows>(&slab.rows[g])) {
      signs[g].align(imu->orientation, imu->valid);
    }
  }
}

/// Makes the rows of one slab: the reference, then all other streams at its stamps, then the steps
/// that need whole groups.
Result<void> SlabMaker::State::make(ReferenceSlab& reference, TakeSlab& slab) {
  slab.first = done;
  slab.stamps.clear();
  // The rows of groups that are not included stay empty.
  slab.rows.assign(plan->header.groups.size(), ClipRows{});
  put_reference(reference, slab);
  for (std::size_t i = 0; i < streams.size(); ++i) {
    if (i != plan->reference) KA_TRY(other_rows(i, reference.grid, slab));
  }
  finish_nodes(slab);
  align_signs(slab);
  done += slab.stamps.size();
  return {};
}

SlabMaker::SlabMaker(std::unique_ptr<State> state) : state_(std::move(state)) {}
SlabMaker::SlabMaker(SlabMaker&&) noexcept = default;
SlabMaker& SlabMaker::operator=(SlabMaker&&) noexcept = default;
SlabMaker::~SlabMaker() = default;

Result<SlabMaker> SlabMaker::start(const Recording& recording, const AlignPlan& plan,
                                   const std::vector<bool>& groups) {
  auto state = std::make_unique<State>();
  state->recording = &recording;
  state->plan = &plan;
  state->streams.resize(recording.streams.size());
  for (const TakeGroup& group : plan.header.groups) state->signs.emplace_back(rotations_of(group));
  for (std::size_t i = 0; i < recording.streams.size(); ++i) {
    if (i == plan.reference || groups[plan.streams[i].group]) KA_TRY(state->open(i));
  }
  return SlabMaker(std::move(state));
}

/// With two jobs, another thread reads the reference's next slab while a slab is made and used.
/// pull() and make() use different members, so the result does not depend on `jobs`.
Result<void> SlabMaker::for_each(std::size_t jobs,
                                 const std::function<Result<void>(TakeSlab&)>& use) {
  State& s = *state_;
  ReferenceSlab now, next;
  TakeSlab slab;
  KA_TRY(s.pull(now));
  while (!now.grid.empty()) {
    Result<void> pulled, used;
    parallel_for(2, jobs, [&](std::size_t which) {
      if (which == 0) {
        pulled = s.pull(next);
      } else if (used = s.make(now, slab); used) {
        used = use(slab);
      }
    });
    KA_TRY(std::move(used));  // errors of earlier rows are returned first
    KA_TRY(std::move(pulled));
    std::swap(now, next);
  }
  return {};
}

/// The windows are read first, because their counts must include all samples up to the take's end.
/// Then streams with late findings are read to the end of their files.
Result<void> SlabMaker::read_rest(const std::function<Result<void>()>& go) {
  for (StreamRows& stream : state_->streams) {
    KA_TRY(std::visit(
        [](auto& rows) -> Result<void> {
          if constexpr (requires { rows.read_to_end(); }) return rows.read_to_end();
          return {};
        },
        stream));
  }
  return read_side_by_side(state_->rests, go);
}

/// Reference rows and unused streams have no content(), so their counts are empty.
ResampleCount SlabMaker::content(std::size_t stream) const {
  return std::visit(
      [](const auto& rows) -> ResampleCount {
        if constexpr (requires { rows.content(); }) return rows.content();
        return {};
      },
      state_->streams[stream]);
}

StreamCounts SlabMaker::counts(std::size_t stream) const {
  return std::visit(
      [](const auto& rows) -> StreamCounts {
        if constexpr (requires { rows.counts(); }) return rows.counts();
        return {};
      },
      state_->streams[stream]);
}

}  // namespace kinalign
