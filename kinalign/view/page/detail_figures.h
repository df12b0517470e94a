// SPDX-License-Identifier: Apache-2.0
// The paper's figure 7: raw samples and the resampled curve, over a part of a take.
#pragma once

#include "kinalign/take/take.h"
#include "kinalign/view/page/body_figures.h"
#include "kinalign/view/page/take_page.h"

#include <optional>
#include <utility>
#include <vector>

namespace kinalign {

/// Raw samples of a stream of points, with stamps on the take's axis and places in the stream's own
/// space.
/// The verb reads them from the take's inputs, if these are still there.
struct RawPoints {
  std::string stream;
  PointFrames frames;
};

/// Raw samples of a node, with stamps on the take's axis and vectors in the sensor's space. The
/// array of a quantity that the node does not measure is empty.
struct RawNode {
  std::string stream, node;
  std::vector<Time> stamps;                            // [R]
  std::vector<double> angular_velocity, acceleration;  // [R,3] rad/s; m/s2
};

/// Collects one body's rows within a part of the take.
/// A page that stores every row already needs no second copy of them; then only the rows nearest to
/// raw samples are collected.
class DetailFigures {
 public:
  /// `onto_joints`: the counterparts, joints of the body that this one was moved onto. `all_rows`:
  /// the detail stores every row, since the page does not. `row_step_s`: of the take.
  DetailFigures(PageDetail detail, std::vector<std::size_t> onto_joints, double row_step_s,
                bool all_rows);

  /// `onto`: the rows of the other body; absent if there is none.
  void add(double seconds, std::int64_t nearest_raw_ns, const JointRows& points,
           const std::optional<JointRows>& onto, std::size_t row);
  PageDetail finish() { return std::move(detail_); }

 private:
  PageDetail detail_;
  std::vector<std::size_t> onto_joints_;  // [P]
  double half_step_s_;
  bool all_rows_;
};

/// The transform that alignment applied to a stream of points.
/// Raw samples must be moved as the resampled ones were, else both could not be compared.
struct RawMove {
  const SpaceReport* space = nullptr;  // nullptr: not moved
  /// For the paper's transform: the stream's root joint, and the places of the other body's root.
  std::size_t root = 0;
  const std::vector<float>* onto_seconds = nullptr;  // [K]
  std::vector<Vec3> onto_root;                       // [K] m
};

/// Adds the raw samples of the part to `detail`. `first`: the stamp of the take's first row.
void add_raw(const RawPoints& raw, const RawMove& move, Time first, PageDetail& detail);

/// A part of the take, s from its first row.
struct DetailStretch {
  double begin_s = 0.0, end_s = 0.0;
};

/// The part around the middle of `stretch` in which all nodes together have at most `most` raw
/// samples, if they come evenly.
/// A limit keeps the page small: nodes at 100 Hz and more have many samples.
DetailStretch raw_node_stretch(const std::vector<RawNode>& raw, const DetailStretch& stretch,
                               std::size_t most);

/// Adds a node's raw samples of the part to its figures. They are turned back by
/// `sensor_from_bone`, to the axes of the node as it is worn.
void add_raw(const RawNode& raw, const Quat& sensor_from_bone, Time first,
             const DetailStretch& stretch, NodeFigures& figures);

}  // namespace kinalign
