// SPDX-License-Identifier: Apache-2.0
#include "kinalign/align/slabs.h"

#include "kinalign/align/nodes.h"
#include "kinalign/motion/kinematics.h"

#include <algorithm>

namespace kinalign {

namespace {

/// The rows of the reference within the common span, pulled from a window.
template <class Frames>
class ReferenceRows {
 public:
  ReferenceRows(Pass<Frames> pass, const RecordedStream& stream, const AlignPlan& plan)
      : window_(std::move(pass), stream.clock, plan.streams[plan.reference].rule.gap_count()),
        begin_(to_ns(plan.begin)),
        end_(to_ns(plan.end)) {}

  /// Moves up to slab_rows further frames into `out`, and their stamps into `grid`.
  Result<void> next(Frames& out, std::vector<std::int64_t>& grid) {
    out = {};
    grid.clear();
    KA_TRY(window_.fill(begin_, slab_rows));
    const auto& stamps = window_.time_ns;
    const auto first = std::lower_bound(stamps.begin(), stamps.end(), begin_);
    const std::int64_t until = first == stamps.end() ? end_ : *first + longest_slab_ns;
    const auto last = std::upper_bound(first, stamps.end(), std::min(end_, until));
    const std::size_t rows =
        std::min<std::size_t>(static_cast<std::size_t>(last - first), slab_rows);
    if (rows == 0) return {};
    grid.assign(first, first + static_cast<std::ptrdiff_t>(rows));
    append_rows(out, window_.rows, static_cast<std::size_t>(first - stamps.begin()), rows);
    begin_ = grid.back() + 1;
    return {};
  }
  const GapCount& gaps() const { return window_.gaps; }

 private:
  Window<Frames> window_;
  std::int64_t begin_, end_;
};

using AnyRows = std::variant<std::monostate, ReferenceRows<ClipFrames>, ReferenceRows<PointFrames>,
                             PointResampler, ImuResampler, ClipResampler>;

void fill_positions(const Skeleton& skeleton, ClipRows& rows, std::size_t count) {
  ClipFrames frames;
  frames.stamps.resize(count);
  frames.local_positions.swap(rows.local_positions);
  frames.local_rotations.swap(rows.local_rotations);
  rows.positions.resize(count * skeleton.joints() * 3);
  forward_kinematics(skeleton, frames, rows.positions);
  rows.local_positions.swap(frames.local_positions);
  rows.local_rotations.swap(frames.local_rotations);
  if (rows.valid.empty()) return;
  const std::size_t width = skeleton.joints() * 3;
  for (std::size_t r = 0; r < count; ++r) {
    if (rows.valid[r] == 0) std::fill_n(&rows.positions[r * width], width, 0.0);
  }
}

}  // namespace

struct SlabMaker::State {
  const Recording* recording = nullptr;
  const AlignPlan* plan = nullptr;
  std::vector<AnyRows> streams;
  std::vector<std::int64_t> grid;
  ImuRows nodes;  // of one stream, on the way into its group
  std::uint64_t done = 0;

  Result<void> open(std::size_t i);
  Result<void> reference_rows(TakeSlab& slab);
  Result<void> other_rows(std::size_t i, TakeSlab& slab);
};

Result<void> SlabMaker::State::open(std::size_t i) {
  const RecordedStream& s = recording->streams[i];
  const ResampleRule& rule = plan->streams[i].rule;
  const bool reference = i == plan->reference;
  if (const auto* clip = std::get_if<ClipInput>(&s.data)) {
    auto pass = KA_TRY(clip->passes());
    if (reference) {
      streams[i].emplace<ReferenceRows<ClipFrames>>(std::move(pass), s, *plan);
    } else {
      streams[i].emplace<ClipResampler>(std::move(pass), s.clock, rule);
    }
  } else if (const auto* points = std::get_if<PointInput>(&s.data)) {
    auto pass = KA_TRY(points->passes());
    if (reference) {
      streams[i].emplace<ReferenceRows<PointFrames>>(std::move(pass), s, *plan);
    } else {
      streams[i].emplace<PointResampler>(std::move(pass), s.clock, rule);
    }
  } else {
    const auto& imu = std::get<ImuInput>(s.data);
    auto pass = KA_TRY(imu.passes());
    streams[i].emplace<ImuResampler>(std::move(pass), s.clock, rule, imu.content);
  }
  return {};
}

Result<void> SlabMaker::State::reference_rows(TakeSlab& slab) {
  const std::size_t group = plan->streams[plan->reference].group;
  AnyRows& stream = streams[plan->reference];
  if (auto* clip = std::get_if<ReferenceRows<ClipFrames>>(&stream)) {
    ClipFrames frames;
    KA_TRY(clip->next(frames, grid));
    ClipRows rows;
    rows.local_positions = std::move(frames.local_positions);
    rows.local_rotations = std::move(frames.local_rotations);
    fill_positions(std::get<ClipGroup>(plan->header.groups[group].kind).skeleton, rows,
                   grid.size());
    slab.rows[group] = std::move(rows);
  } else {
    PointFrames frames;
    KA_TRY(std::get<ReferenceRows<PointFrames>>(stream).next(frames, grid));
    PointRows rows;
    rows.positions = std::move(frames.positions);
    for (const Tracking state : frames.state) rows.valid.push_back(state != Tracking::missing);
    rows.state = std::move(frames.state);
    slab.rows[group] = std::move(rows);
  }
  for (const std::int64_t t : grid) slab.stamps.push_back(utc_time(t));
  return {};
}

Result<void> SlabMaker::State::other_rows(std::size_t i, TakeSlab& slab) {
  const std::size_t group = plan->streams[i].group;
  AnyRows& stream = streams[i];
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
    if (!std::holds_alternative<ImuRows>(slab.rows[group])) slab.rows[group] = ImuRows{};
    put_nodes(nodes, grid.size(), {plan->streams[i].first_node, nodes_group.node_names.size()},
              std::get<ImuRows>(slab.rows[group]));
  }
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
  for (std::size_t i = 0; i < recording.streams.size(); ++i) {
    if (i == plan.reference || groups[plan.streams[i].group]) KA_TRY(state->open(i));
  }
  return SlabMaker(std::move(state));
}

Result<bool> SlabMaker::next(TakeSlab& slab) {
  State& s = *state_;
  slab.first = s.done;
  slab.stamps.clear();
  slab.rows.assign(s.plan->header.groups.size(), ClipRows{});
  KA_TRY(s.reference_rows(slab));
  if (s.grid.empty()) return false;
  for (std::size_t i = 0; i < s.streams.size(); ++i) {
    if (i != s.plan->reference) KA_TRY(s.other_rows(i, slab));
  }
  for (std::size_t g = 0; g < slab.rows.size(); ++g) {
    const auto* group = std::get_if<ImuGroup>(&s.plan->header.groups[g].kind);
    auto* rows = std::get_if<ImuRows>(&slab.rows[g]);
    if (group == nullptr || rows == nullptr) continue;
    apply_mounting(*group,
                   options_of(s.plan->header.parameters, s.plan->header.groups[g].name).mounting,
                   *rows);
    if (!group->root_node.empty()) bring_to_root(*group, *rows);
  }
  s.done += s.grid.size();
  return true;
}

ResampleCount SlabMaker::count(std::size_t stream) const {
  return std::visit(
      [](const auto& rows) {
        if constexpr (requires { rows.count(); }) return rows.count();
        return ResampleCount{};
      },
      state_->streams[stream]);
}

GapCount SlabMaker::gaps(std::size_t stream) const {
  return std::visit(
      [](const auto& rows) {
        if constexpr (requires { rows.gaps(); }) return rows.gaps();
        return GapCount{};
      },
      state_->streams[stream]);
}

}  // namespace kinalign
