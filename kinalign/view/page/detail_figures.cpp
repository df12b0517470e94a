// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/page/detail_figures.h"

#include <algorithm>

namespace kinalign {

namespace {

/// Returns the position of the other body's root at a time, interpolated between the stored rows.
Vec3 onto_root_at(const RawMove& move, double at) {
  const std::vector<float>& times = *move.onto_seconds;
  const auto behind = std::lower_bound(times.begin(), times.end(), static_cast<float>(at));
  // Before the first and after the last stored row, the nearest position is used.
  if (behind == times.begin()) return move.onto_root.front();
  if (behind == times.end()) return move.onto_root.back();
  const auto b = static_cast<std::size_t>(behind - times.begin());
  const double from = static_cast<double>(times[b - 1]), to = static_cast<double>(times[b]);
  const double share = to > from ? (at - from) / (to - from) : 0.0;
  return (1.0 - share) * move.onto_root[b - 1] + share * move.onto_root[b];
}

/// Returns the transform of one raw sample. With the method "paper" each sample has its own
/// transform; absent if the root was not seen. As in alignment, the translation puts the sample's
/// root onto the other body's root at that time.
std::optional<RigidTransform> transform_of(const RawPoints& raw, const RawMove& move, std::size_t t,
                                           std::size_t joints, double at) {
  if (move.space == nullptr) return RigidTransform{};
  RigidTransform out = move.space->transform;
  if (move.space->method != "paper") return out;
  const std::size_t root = t * joints + move.root;
  if (move.onto_root.empty() || raw.frames.state[root] == Tracking::missing) return std::nullopt;
  out.translation = onto_root_at(move, at) / move.space->magnification -
                    out.rotation * vec3(raw.frames.positions, root);
  return out;
}

}  // namespace

DetailFigures::DetailFigures(PageDetail detail, std::vector<std::size_t> onto_joints,
                             double row_step_s, bool all_rows)
    : detail_(std::move(detail)),
      onto_joints_(std::move(onto_joints)),
      half_step_s_(0.5 * row_step_s),
      all_rows_(all_rows) {}

// Called for every row of the take. Only rows within the detail are stored.
void DetailFigures::add(double seconds, std::int64_t nearest_raw_ns, const JointRows& points,
                        const std::optional<JointRows>& onto, std::size_t row) {
  if (seconds < detail_.begin_s || seconds > detail_.end_s) return;
  const auto at = static_cast<float>(seconds);
  const double nearest = 1e-9 * static_cast<double>(nearest_raw_ns);
  // A raw sample less than half a row away has no nearer row.
  if (nearest <= half_step_s_) {
    detail_.near_seconds.push_back(at);
    detail_.near_s = std::max(detail_.near_s, static_cast<float>(nearest));
  }
  if (!all_rows_) return;
  detail_.seconds.push_back(at);
  for (std::size_t j = 0; j < points.joints(); ++j) {
    put_vector(detail_.positions, points.at(row, j));
    detail_.state.push_back(static_cast<std::uint8_t>(points.state(row, j)));
  }
  for (const std::size_t j : onto_joints_) {
    put_vector(detail_.onto_positions, onto ? onto->at(row, j) : Vec3::Zero());
  }
}

void add_raw(const RawPoints& raw, const RawMove& move, Time first, PageDetail& detail) {
  // Set even if no sample is within the part, because the input files were read.
  detail.has_raw = true;
  const PointFrames& frames = raw.frames;
  const std::size_t joints = frames.size() == 0 ? 0 : frames.state.size() / frames.size();
  const double m =
      move.space != nullptr && move.space->method == "paper" ? move.space->magnification : 1.0;
  for (std::size_t t = 0; t < frames.size(); ++t) {
    const double at = seconds(frames.stamps[t] - first);
    if (at < detail.begin_s || at > detail.end_s) continue;
    const auto transform = transform_of(raw, move, t, joints, at);
    detail.raw_seconds.push_back(static_cast<float>(at));
    for (std::size_t cell = t * joints; cell < (t + 1) * joints; ++cell) {
      // A sample without a transform has no position in the take's space, so its joints count as
      // missing.
      const bool seen = transform && frames.state[cell] != Tracking::missing;
      const Vec3 place = vec3(frames.positions, cell);
      put_vector(detail.raw_positions, seen ? Vec3(m * (*transform * place)) : Vec3::Zero());
      detail.raw_state.push_back(seen ? static_cast<std::uint8_t>(frames.state[cell])
                                      : std::uint8_t{0});
    }
  }
}

DetailStretch raw_node_stretch(const std::vector<RawNode>& raw, const DetailStretch& stretch,
                               std::size_t most) {
  std::size_t samples = 0;
  for (const RawNode& node : raw) samples += node.stamps.size();
  if (samples <= most) return stretch;
  // The part is shortened around its middle, so that only the allowed number of samples is left.
  const double kept = static_cast<double>(most) / static_cast<double>(samples);
  const double middle = 0.5 * (stretch.begin_s + stretch.end_s);
  const double half = 0.5 * kept * (stretch.end_s - stretch.begin_s);
  return {middle - half, middle + half};
}

void add_raw(const RawNode& raw, const Quat& sensor_from_bone, Time first,
             const DetailStretch& stretch, NodeFigures& figures) {
  // The axes are then those of the node's other signals on the page.
  const Quat back = sensor_from_bone.conjugate();
  for (std::size_t t = 0; t < raw.stamps.size(); ++t) {
    const double at = seconds(raw.stamps[t] - first);
    if (at < stretch.begin_s || at > stretch.end_s) continue;
    figures.raw_seconds.push_back(static_cast<float>(at));
    const auto put = [&](const std::vector<double>& from, std::vector<float>& to) {
      if (!from.empty()) put_vector(to, back * Vec3(vec3(from, t)));
    };
    put(raw.angular_velocity, figures.raw_rate);
    put(raw.acceleration, figures.raw_acceleration);
  }
}

}  // namespace kinalign
