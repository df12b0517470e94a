// SPDX-License-Identifier: Apache-2.0
// The paper's figure 7: raw samples against the resampled curve, over a stretch of a take.
#pragma once

#include "kinalign/take/take.h"
#include "kinalign/view/page/body_figures.h"
#include "kinalign/view/page/take_page.h"

#include <optional>
#include <utility>
#include <vector>

namespace kinalign {

/// Raw samples of a stream of points, stamps on the take's axis, places in the stream's own space.
struct RawPoints {
  std::string stream;
  PointFrames frames;
};

/// Raw samples of a node, stamps on the take's axis, vectors in the sensor's space; an array of a
/// quantity that the node does not measure is empty.
struct RawNode {
  std::string stream, node;
  std::vector<Time> stamps;                            // [R]
  std::vector<double> angular_velocity, acceleration;  // [R,3] rad/s; m/s2
};

/// Collects one body's rows within a stretch.
class DetailFigures {
 public:
  /// `onto_joints`: counterparts, joints of the body that this one was moved onto. `all_rows`: the
  /// page does not keep every row, so that the detail has to. `row_step_s`: of the take.
  DetailFigures(PageDetail detail, std::vector<std::size_t> onto_joints, double row_step_s,
                bool all_rows);

  /// `onto`: rows of the other body; absent where there is none.
  void add(double seconds, std::int64_t nearest_raw_ns, const JointRows& points,
           const std::optional<JointRows>& onto, std::size_t row);
  PageDetail finish() { return std::move(detail_); }

 private:
  PageDetail detail_;
  std::vector<std::size_t> onto_joints_;  // [P]
  double half_step_s_;
  bool all_rows_;
};

/// How alignment moved a stream of points.
struct RawMove {
  const SpaceReport* space = nullptr;  // nullptr: not at all
  /// For the paper's transform: the stream's root joint, and the places of the other body's root.
  std::size_t root = 0;
  const std::vector<float>* onto_seconds = nullptr;  // [K]
  std::vector<Vec3> onto_root;                       // [K] m
};

/// Puts the raw samples of the stretch into `detail`. `first`: stamp of the take's first row.
void add_raw(const RawPoints& raw, const RawMove& move, Time first, PageDetail& detail);

/// A stretch of the take, s from its first row.
struct DetailStretch {
  double begin_s = 0.0, end_s = 0.0;
};

/// The part of a stretch, around its middle, in which all nodes together have at most `most` raw
/// samples, if they come evenly.
DetailStretch raw_node_stretch(const std::vector<RawNode>& raw, const DetailStretch& stretch,
                               std::size_t most);

/// Puts a node's raw samples of a stretch into its figures, as the node is worn: turned back by
/// `sensor_from_bone`.
void add_raw(const RawNode& raw, const Quat& sensor_from_bone, Time first,
             const DetailStretch& stretch, NodeFigures& figures);

}  // namespace kinalign
