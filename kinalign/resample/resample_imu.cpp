// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/interpolation/spline.h"
#include "kinalign/resample/resample.h"
#include "kinalign/resample/rotation_rows.h"
#include "kinalign/resample/segments.h"

#include <algorithm>

namespace kinalign {

namespace {

/// The valid samples of one node.
struct NodeSamples {
  std::vector<std::int64_t> stamps;
  std::vector<double> orientation;  // [T',4]
  std::vector<double> vectors;      // [T',C] acceleration and angular velocity, if present
  std::size_t channels = 0;
};

NodeSamples samples_of(const Window<ImuSamples>& window, std::size_t node,
                       const ImuContent& content, bool to_world) {
  const ImuSamples& rows = window.rows;
  const std::size_t nodes = rows.valid.size() / rows.size();
  // Acceleration and angular velocity are adjacent channels, so one spline interpolates both.
  NodeSamples out;
  const auto add = [&out](const Vec3& v) {
    out.vectors.insert(out.vectors.end(), v.begin(), v.end());
  };
  out.channels = (content.acceleration ? 3U : 0U) + (content.angular_velocity ? 3U : 0U);
  for (std::size_t t = 0; t < rows.size(); ++t) {
    const std::size_t i = t * nodes + node;
    // Nodes lose samples independently, so each node has its own stamps.
    if (rows.valid[i] == 0) continue;
    out.stamps.push_back(window.time_ns[t]);
    Quat turn = Quat::Identity();
    if (content.orientation) {
      const Quat q = quat(rows.orientation, i);
      if (to_world) turn = q;
      for (const double part : {q.w(), q.x(), q.y(), q.z()}) out.orientation.push_back(part);
    }
    if (content.acceleration) add(turn * vec3(rows.acceleration, i));
    if (content.angular_velocity) add(turn * vec3(rows.angular_velocity, i));
  }
  return out;
}

/// The column of one node in the rows, and the sums for its lost motion.
struct NodeColumn {
  std::size_t node, nodes;
  const ImuContent& content;
  ResampleCount* count;
};

void put_vectors(const std::vector<double>& values, const Segment& s, const NodeColumn& column,
                 ImuRows& out) {
  // `values` [rows, channels]: the acceleration comes first, if the node has it.
  const std::size_t rows = s.row_end - s.row, channels = values.size() / rows;
  for (std::size_t r = 0; r < rows; ++r) {
    const std::size_t cell = (s.row + r) * column.nodes + column.node;
    const double* from = &values[r * channels];
    if (column.content.acceleration) std::copy_n(from, 3, &out.acceleration[3 * cell]);
    if (column.content.angular_velocity) {
      std::copy_n(from + (column.content.acceleration ? 3 : 0), 3, &out.angular_velocity[3 * cell]);
    }
  }
}

/// Measures the motion of a node's vectors that is lost in the rows of one segment.
void measure(const Knots& raw, const Knots& rows, const NodeColumn& column) {
  ResampleCount& count = *column.count;
  count.acceleration.resize(column.nodes);
  count.angular_velocity.resize(column.nodes);
  if (column.content.acceleration) add_content(raw, rows, 0, count.acceleration[column.node]);
  if (column.content.angular_velocity) {
    const std::size_t first = column.content.acceleration ? 3 : 0;
    add_content(raw, rows, first, count.angular_velocity[column.node]);
  }
}

/// Computes the rows of one node, segment by segment.
void interpolate(const NodeSamples& samples, std::span<const std::int64_t> grid,
                 const ResampleRule& rule, const NodeColumn& column, ImuRows& out) {
  // A node's gaps are determined by its own valid samples, not by the stream's rows.
  for (const Segment& s : find_segments(samples.stamps, grid, rule.gap_ns)) {
    const std::size_t knots = s.last - s.first, rows = s.row_end - s.row;
    const auto stamps = std::span(samples.stamps).subspan(s.first, knots);
    // Times are counted from the segment's first knot, so a double holds them precisely.
    const auto x = seconds_from(stamps.front(), stamps);
    const auto at = seconds_from(stamps.front(), grid.subspan(s.row, rows));
    if (samples.channels > 0) {
      const std::size_t channels = samples.channels;
      const Knots spline{
          x, std::span(samples.vectors).subspan(s.first * channels, knots * channels), channels};
      std::vector<double> bends(knots * channels), values(rows * channels);
      natural_spline(spline, bends);
      spline_at(spline, bends, at, values);
      put_vectors(values, s, column, out);
      if (rule.finer) measure(spline, {at, values, channels}, column);
    }
    if (column.content.orientation) {
      const auto turned = rotations_at(
          rule.curve, x, std::span(samples.orientation).subspan(4 * s.first, 4 * knots), at);
      for (std::size_t r = 0; r < rows; ++r) {
        std::copy_n(&turned[4 * r], 4,
                    &out.orientation[4 * ((s.row + r) * column.nodes + column.node)]);
      }
    }
    // A row within a segment is valid for this node, even if other nodes are not valid.
    for (std::size_t r = s.row; r < s.row_end; ++r) out.valid[r * column.nodes + column.node] = 1;
  }
}

/// Computes the time from each row to the node's nearest sample, and marks the rows that were
/// interpolated over lost samples.
void put_distances(const NodeSamples& samples, std::span<const std::int64_t> grid,
                   const ResampleRule& rule, const NodeColumn& column, ImuRows& out) {
  const Neighbours near = find_neighbours(samples.stamps, grid);
  for (std::size_t r = 0; r < grid.size(); ++r) {
    const std::size_t cell = r * column.nodes + column.node, left = near.left[r];
    out.distance.nearest_raw_ns[cell] = near.nearest_raw_ns[r];
    if (out.valid[cell] == 0) continue;
    // A row at the stamp of a sample has the value of that sample.
    const bool between = samples.stamps[left] != grid[r];
    // If a step is longer than 1.5 usual steps, at least one sample is missing.
    const bool lost =
        between && samples.stamps[left + 1] - samples.stamps[left] > rule.step_ns * 3 / 2;
    out.distance.over_loss[cell] = lost ? 1 : 0;
  }
}

/// Returns arrays for n samples, all invalid.
ImuRows no_samples(std::size_t n, const ImuContent& content) {
  ImuRows out;
  out.valid.assign(n, 0);
  if (content.orientation) out.orientation.assign(4 * n, 0.0);
  if (content.acceleration) out.acceleration.assign(3 * n, 0.0);
  if (content.angular_velocity) out.angular_velocity.assign(3 * n, 0.0);
  return out;
}

}  // namespace

Result<void> ImuResampler::rows(std::span<const std::int64_t> grid, bool to_world, ImuRows& out) {
  out = {};
  if (grid.empty()) return {};
  KA_TRY(window_.move(grid.front(), grid.back(), rule_.reach()));
  const auto& stamps = window_.time_ns;
  if (stamps.empty()) return Failure(Error{"", 0, "samples in a stream of nodes", "none"});
  const std::size_t nodes = window_.rows.valid.size() / stamps.size(), n = grid.size() * nodes;
  out = no_samples(n, content_);
  out.distance.nearest_raw_ns.resize(n);
  out.distance.over_loss.assign(n, 0);
  for (std::size_t node = 0; node < nodes; ++node) {
    const NodeSamples samples = samples_of(window_, node, content_, to_world);
    const NodeColumn column{node, nodes, content_, &count_};
    interpolate(samples, grid, rule_, column, out);
    put_distances(samples, grid, rule_, column, out);
  }
  // All nodes of a stream have the same clock, so the stamps of all samples are used here.
  auto& intervals = out.distance.time_interval_ns;
  for (const std::int64_t interval :
       intervals_at(*clock_, window_.rows.stamps, find_neighbours(stamps, grid))) {
    intervals.insert(intervals.end(), nodes, interval);
  }
  return {};
}

}  // namespace kinalign
