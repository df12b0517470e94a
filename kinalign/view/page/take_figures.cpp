// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/page/take_figures.h"

#include "kinalign/core/find_named.h"
#include "kinalign/motion/index_of.h"
#include "kinalign/view/page/body_figures.h"
#include "kinalign/view/page/floor_figures.h"
#include "kinalign/view/page/lane_figures.h"
#include "kinalign/view/page/node_figures.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

/// Returns the number of values that the page stores for one row of a group. A node has 18: a rate
/// and an acceleration, the same for its bone, an error, axes and a flag.
std::uint64_t numbers_of(const TakeGroup& group) {
  if (const auto* clip = std::get_if<ClipGroup>(&group.kind)) return 3 * clip->skeleton.joints();
  if (const auto* points = std::get_if<PointGroup>(&group.kind)) {
    return 4 * points->joint_names.size();
  }
  return 18 * std::get<ImuGroup>(group.kind).node_names.size();
}

/// Returns the number of bins, at least one. A bin has at least two rows, so that no bin is empty
/// if stamps vary by less than half a step.
std::size_t bins_of(const TakeHeader& header, std::size_t most) {
  const auto pairs = static_cast<std::size_t>(header.frames / 2);
  return std::max<std::size_t>(1, std::min(most, pairs));
}

/// Returns the seconds from the first row's stamp to a stamp.
double seconds_since(Time first, Time now) { return seconds(now - first); }

}  // namespace

std::uint64_t page_stride(const TakeHeader& header, std::uint64_t most_numbers) {
  std::uint64_t numbers = 1;
  for (const TakeGroup& group : header.groups) numbers += numbers_of(group);
  // The number is rounded up, so that the limit is kept.
  const std::uint64_t rows = std::max<std::uint64_t>(1, most_numbers / numbers);
  return std::max<std::uint64_t>(1, (header.frames + rows - 1) / rows);
}

/// A skeleton or points of the take, with all figures that are collected. `floor`, `space` and
/// `detail` are absent if they do not apply.
struct GroupFigures {
  std::size_t group = 0;
  BodyFigures figures;
  std::optional<PageFloor> floor;
  std::optional<std::size_t> space;  // index in TakePage::spaces
  std::optional<DetailFigures> detail;
};

// `page` grows while rows are added. `row` counts all rows; `first` is the stamp of row 0.
struct TakeFigures::State {
  TakeHeader header;
  TakeFigureOptions options;
  TakePage page;
  std::vector<GroupFigures> bodies;
  std::vector<LaneFigures> lanes;  // [groups]
  std::size_t clip_group = 0, node_group = 0;
  std::optional<NodeCompare> compare;
  std::optional<Time> first;
  double length_s = 0.0;
  std::uint64_t row = 0;

  const PageSpace* space_of(const GroupFigures& body) const {
    return body.space ? &page.spaces[*body.space] : nullptr;
  }
  std::optional<std::size_t> body_called(const std::string& name) const;
  void plan_bodies();
  void plan_spaces();
  void plan_details();
  void plan_nodes();
  void judge();
  void judge_nodes();
  void add_detail(const TakeSlab& slab, std::size_t row, double at, GroupFigures& body);
  void add_raw_samples(PageDetail& detail) const;
  void add_raw_node_samples();
  void add_row(const TakeSlab& slab, std::size_t row);
  std::size_t bin_of(double seconds) const;
  double kept_step_s() const;
  void colour();
};

std::optional<std::size_t> TakeFigures::State::body_called(const std::string& name) const {
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (bodies[b].figures.body().name == name) return b;
  }
  return std::nullopt;
}

/// Every group has lanes; only skeletons and points are bodies. A body has the same index in
/// `bodies` and on the page.
void TakeFigures::State::plan_bodies() {
  for (std::size_t g = 0; g < header.groups.size(); ++g) {
    lanes.emplace_back(header.groups[g], options.bins);
    if (std::holds_alternative<ImuGroup>(header.groups[g].kind)) continue;
    bodies.push_back({g, BodyFigures(header.groups[g], bodies.size()), {}, {}, {}});
  }
}

/// Adds the report's transforms between bodies of the page, with their pairs of joints. Pairs with
/// a joint that one body lacks are omitted.
void TakeFigures::State::plan_spaces() {
  for (const SpaceReport& report : page.report.spaces) {
    const auto from = body_called(report.stream), onto = body_called(report.onto);
    if (!from || !onto) continue;
    // The report is copied, because the page outlives the take's header.
    PageSpace space;
    space.report = report;
    space.body = *from;
    space.onto = *onto;
    space.once_per_take = report.method == "fit" || report.method == "given";
    const auto& ours = bodies[*from].figures.body().joint_names;
    const auto& theirs = bodies[*onto].figures.body().joint_names;
    for (const JointResidual& joint : report.joints) {
      const auto a = index_of(ours, joint.joint), b = index_of(theirs, joint.onto);
      if (a && b) space.pairs.emplace_back(*a, *b);
    }
    // The moved body is a Kinect. The transform gives its position and direction.
    bodies[*from].floor = floor_of(report, *from);
    bodies[*from].space = page.spaces.size();
    page.spaces.push_back(std::move(space));
  }
}

/// Adds a detail for each resampled stream of points. Other streams have no raw samples between
/// rows.
void TakeFigures::State::plan_details() {
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const TakeGroup& group = header.groups[bodies[b].group];
    if (!group.resampled || !std::holds_alternative<PointGroup>(group.kind)) continue;
    PageDetail detail;
    detail.body = b;
    detail.begin_s = options.detail_begin_s;
    detail.end_s = options.detail_begin_s + options.detail_length_s;
    std::vector<std::size_t> onto_joints;
    if (const PageSpace* space = space_of(bodies[b])) {
      for (const auto& [from, onto] : space->pairs) onto_joints.push_back(onto);
    }
    const double step = page.report.rate_hz > 0.0 ? 1.0 / page.report.rate_hz : 0.0;
    bodies[b].detail.emplace(std::move(detail), std::move(onto_joints), step, page.stride > 1);
  }
}

/// Nodes are compared with a skeleton, preferably the first one in the take's space.
void TakeFigures::State::plan_nodes() {
  std::optional<std::size_t> clip, nodes;
  // The loop runs backwards, so that the first group of each kind is used.
  for (std::size_t g = header.groups.size(); g-- > 0;) {
    const TakeGroup& group = header.groups[g];
    // A skeleton outside the take's space can be compared too, because its bones rotate like its
    // nodes.
    const bool better = !clip || group.space == "take";
    if (std::holds_alternative<ClipGroup>(group.kind) && better) clip = g;
    if (std::holds_alternative<ImuGroup>(group.kind)) nodes = g;
  }
  if (!clip || !nodes) return;
  clip_group = *clip;
  node_group = *nodes;
  page.node_body = body_called(header.groups[*clip].name).value_or(0);
  compare.emplace(std::get<ImuGroup>(header.groups[*nodes].kind),
                  std::get<ClipGroup>(header.groups[*clip].kind).skeleton, page.report.rate_hz);
}

/// Adds a verdict for each group, and lists each input file once.
void TakeFigures::State::judge() {
  for (const TakeGroup& group : header.groups) {
    page.verdicts.push_back(verdict_of(page.report, group.name, group.files));
    for (const InputFacts& file : group.files) {
      const auto known = std::find(page.inputs.begin(), page.inputs.end(), file);
      // Several groups may have the same input file.
      if (known == page.inputs.end()) page.inputs.push_back(file);
    }
  }
}

/// Adds a concern for each node that rotates like the bone of another node. Called last, because
/// the comparison of nodes needs all rows.
void TakeFigures::State::judge_nodes() {
  const std::string& stream = header.groups[node_group].name;
  const auto verdict = std::find_if(page.verdicts.begin(), page.verdicts.end(),
                                    [&](const Verdict& v) { return v.stream == stream; });
  for (const NodeFigures& node : page.nodes) {
    if (node.more_like.empty()) continue;
    add_concern(
        {stream, node.node, "turns more like " + node.more_like + " than like " + node.joint, 2.0,
         Quality::usable},
        *verdict);
  }
}

/// Returns the bin of a time. Times outside the take belong to the first or the last bin.
std::size_t TakeFigures::State::bin_of(double s) const {
  // A take of one row has no length, so its row is in the first bin.
  if (!(length_s > 0.0)) return 0;
  const double bin = std::floor(s / length_s * static_cast<double>(options.bins));
  return static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(options.bins - 1)));
}

/// Adds one row to all figures. The page stores every stride-th row.
void TakeFigures::State::add_row(const TakeSlab& slab, std::size_t r) {
  const double at = seconds_since(*first, slab.stamps[r]);
  // The first row is always stored.
  const bool keep = row++ % page.stride == 0;
  const std::size_t bin = bin_of(at);
  if (keep) page.seconds.push_back(static_cast<float>(at));
  for (std::size_t g = 0; g < lanes.size(); ++g) lanes[g].add(slab.rows[g], r, bin);
  for (GroupFigures& body : bodies) {
    body.figures.add(slab.rows[body.group], r, keep);
    if (body.detail) add_detail(slab, r, at, body);
    if (!body.floor) continue;
    if (const auto joints = JointRows::of(slab.rows[body.group], body.figures.joints())) {
      count_zones(*joints, r, *body.floor);
    }
  }
  if (compare) {
    compare->add(at, std::get<ClipRows>(slab.rows[clip_group]),
                 std::get<ImuRows>(slab.rows[node_group]), r, keep);
  }
}

/// Adds a row to a body's detail, with the joints onto which the body was moved.
void TakeFigures::State::add_detail(const TakeSlab& slab, std::size_t r, double at,
                                    GroupFigures& body) {
  const std::variant<ClipRows, PointRows, ImuRows>& rows = slab.rows[body.group];
  std::optional<JointRows> onto;
  if (const PageSpace* space = space_of(body)) {
    const GroupFigures& other = bodies[space->onto];
    onto = JointRows::of(slab.rows[other.group], other.figures.joints());
  }
  body.detail->add(at, std::get<PointRows>(rows).distance.nearest_raw_ns[r],
                   *JointRows::of(rows, body.figures.joints()), onto, r);
}

/// Adds the raw samples of the detail's body, moved like the body. The page must already have its
/// bodies.
void TakeFigures::State::add_raw_samples(PageDetail& detail) const {
  // Raw samples are assigned to a body by the stream's name.
  const PageBody& body = page.bodies[detail.body];
  const auto raw = std::find_if(options.raw.begin(), options.raw.end(),
                                [&](const RawPoints& r) { return r.stream == body.name; });
  if (raw == options.raw.end() || !first) return;
  RawMove move;
  if (const PageSpace* space = space_of(bodies[detail.body])) {
    const auto moved = header.parameters.spaces.find(body.name);
    const SpaceOptions how =
        moved == header.parameters.spaces.end() ? SpaceOptions{} : moved->second;
    const PageBody& onto = page.bodies[space->onto];
    move.space = &space->report;
    move.root = index_of(body.joint_names, how.root).value_or(body.joint_names.size());
    // With the method "paper" the other root's path moves each sample. The page stores that path.
    move.onto_seconds = &page.seconds;
    const std::size_t joints = onto.joint_names.size();
    const auto root = index_of(onto.joint_names, how.onto_root);
    if (space->report.method == "paper" && move.root < body.joint_names.size() && root) {
      for (std::size_t k = 0; k < page.seconds.size(); ++k) {
        const float* p = &onto.positions[3 * (k * joints + *root)];
        move.onto_root.emplace_back(Eigen::Map<const Eigen::Vector3f>(p).cast<double>());
      }
    }
  }
  add_raw(*raw, move, *first, detail);
}

/// Adds the raw samples of nodes, for a part that is short enough to limit their number.
void TakeFigures::State::add_raw_node_samples() {
  if (options.raw_nodes.empty() || !first) return;
  const DetailStretch detail{options.detail_begin_s,
                             options.detail_begin_s + options.detail_length_s};
  const DetailStretch stretch =
      raw_node_stretch(options.raw_nodes, detail, options.most_raw_node_samples);
  page.raw_nodes_begin_s = std::max(0.0, stretch.begin_s);
  page.raw_nodes_end_s = std::min(length_s, stretch.end_s);
  const std::string& stream = header.groups[node_group].name;
  const StreamOptions* const how = find_named(header.parameters.streams, stream);
  for (const RawNode& raw : options.raw_nodes) {
    const auto node = std::find_if(page.nodes.begin(), page.nodes.end(),
                                   [&](const NodeFigures& n) { return n.node == raw.node; });
    if (raw.stream != stream || node == page.nodes.end()) continue;
    Quat sensor_from_bone = Quat::Identity();
    // The mounting that alignment used. Without a mounting, the values were not rotated.
    if (how != nullptr && how->mounting.contains(raw.node)) {
      sensor_from_bone = quat(how->mounting.at(raw.node), 0).normalized();
    }
    add_raw(raw, sensor_from_bone, *first, stretch, *node);
  }
}

/// Returns the mean time between stored rows, which the lags of nodes need.
double TakeFigures::State::kept_step_s() const {
  if (page.seconds.size() < 2) return 1.0;
  return static_cast<double>(page.seconds.back()) / static_cast<double>(page.seconds.size() - 1);
}

/// Sets the colours. The page must already have its bodies and lanes.
void TakeFigures::State::colour() {
  for (const PageSpace& space : page.spaces) page.bodies[space.onto].colour = PageColour::mocap;
  for (PageLane& lane : page.lanes) {
    for (const PageBody& body : page.bodies) {
      if (body.name == lane.stream) lane.colour = body.colour;
    }
  }
}

TakeFigures::TakeFigures(const TakeHeader& header, const AlignmentReport& report,
                         TakeFigureOptions options)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.header = header;
  s.options = std::move(options);
  s.options.bins = bins_of(header, s.options.bins);
  s.page.report = report;
  s.page.subject = header.subject;
  s.page.action = header.action;
  s.page.stride = page_stride(header, s.options.most_numbers);
  s.length_s = seconds(report.end - report.begin);
  // The order matters: spaces need the bodies, and details need the spaces.
  s.plan_bodies();
  s.plan_spaces();
  s.plan_details();
  s.plan_nodes();
  s.judge();
}

TakeFigures::TakeFigures(TakeFigures&&) noexcept = default;
TakeFigures& TakeFigures::operator=(TakeFigures&&) noexcept = default;
TakeFigures::~TakeFigures() = default;

void TakeFigures::add(const TakeSlab& slab) {
  if (!state_->first && !slab.stamps.empty()) state_->first = slab.stamps.front();
  for (std::size_t r = 0; r < slab.stamps.size(); ++r) state_->add_row(slab, r);
}

TakePage TakeFigures::finish() {
  State& s = *state_;
  for (LaneFigures& group : s.lanes) {
    for (PageLane& lane : group.finish()) s.page.lanes.push_back(std::move(lane));
  }
  for (GroupFigures& body : s.bodies) {
    for (BoneLength& bone : body.figures.bones()) s.page.bones.push_back(bone);
    if (body.floor) s.page.floors.push_back(*body.floor);
    s.page.joint_states.push_back(body.figures.take_states());
    s.page.bodies.push_back(body.figures.take_body());
  }
  // The page now has bodies and lanes. The raw samples below need the bodies' positions.
  s.colour();
  for (GroupFigures& body : s.bodies) {
    if (!body.detail) continue;
    s.page.details.push_back(body.detail->finish());
    s.add_raw_samples(s.page.details.back());
  }
  if (s.compare) {
    s.page.nodes = s.compare->finish(s.kept_step_s());
    s.add_raw_node_samples();
    s.judge_nodes();
  }
  s.page.worst = worst_of(s.page.verdicts, 3);
  return std::move(s.page);
}

// Each group may have an open gap. The longest gap of all groups is stored.
void LongestGap::add(const TakeSlab& slab) {
  now_.resize(slab.rows.size());
  for (std::size_t r = 0; r < slab.stamps.size(); ++r) {
    const Time at = slab.stamps[r];
    if (!first_) first_ = at;
    for (std::size_t g = 0; g < now_.size(); ++g) {
      const auto* points = std::get_if<PointRows>(&slab.rows[g]);
      if (points == nullptr || points->valid.empty()) continue;
      const std::size_t joints = points->valid.size() / slab.stamps.size();
      const auto begin = points->valid.begin() + static_cast<std::ptrdiff_t>(r * joints);
      const bool seen = std::any_of(begin, begin + static_cast<std::ptrdiff_t>(joints),
                                    [](std::uint8_t valid) { return valid != 0; });
      DetailStretch& now = now_[g];
      if (seen) {
        now.open = false;
        continue;
      }
      if (!now.open) now = {at, at, true};
      now.end = at;
      // With >= a gap of a single row counts too.
      if (now.end - now.begin >= longest_.end - longest_.begin) longest_ = now;
    }
  }
}

std::optional<double> LongestGap::middle_s() const {
  if (!first_ || !longest_.open) return std::nullopt;
  return 0.5 * (seconds(longest_.begin - *first_) + seconds(longest_.end - *first_));
}

}  // namespace kinalign
