// SPDX-License-Identifier: Apache-2.0
// Data for figure 7 of the HFUT-MMD paper: raw samples and the resampled curve over a part of a
// take (the "detail").
#pragma once

#include "kinalign/take/take.h"
#include "kinalign/view/page/body_figures.h"
#include "kinalign/view/page/take_page.h"

#include <optional>
#include <utility>
#include <vector>

namespace kinalign {

/// Raw samples of a stream of points, with stamps on the take's time axis and positions in the
/// stream's own space. The program reads them from the take's input files, if these still exist.
struct RawPoints {
  std::string stream;
  PointFrames frames;
};

/// Raw samples of a node, with stamps on the take's time axis and vectors in the sensor's axes. If
/// the node does not measure a quantity, its array is empty.
struct RawNode {
  std::string stream, node;
  std::vector<Time> stamps;                            // [R]
  std::vector<double> angular_velocity, acceleration;  // [R,3] rad/s; m/s2
};

/// Collects the rows of one body within the detail. If the page stores every row, only the rows
/// nearest to raw samples are collected, because the others are already on the page.
class DetailFigures {
 public:
  /// `onto_joints`: the counterparts, which are joints of the body onto which this body was moved.
  /// `all_rows`: the detail stores every row, because the page does not. `row_step_s`: step of the
  /// take, s.
  DetailFigures(PageDetail detail, std::vector<std::size_t> onto_joints, double row_step_s,
                bool all_rows);

  /// `onto`: the rows of the other body; absent if this body was not moved.
  void add(double seconds, std::int64_t nearest_raw_ns, const JointRows& points,
           const std::optional<JointRows>& onto, std::size_t row);
  PageDetail finish() { return std::move(detail_); }

 private:
  PageDetail detail_;
  std::vector<std::size_t> onto_joints_;  // [P]
  double half_step_s_;
  bool all_rows_;
};

/// The transform that alignment applied to a stream of points. Raw samples must be moved in the
/// same way as resampled ones, so that both can be compared.
struct RawMove {
  const SpaceReport* space = nullptr;  // nullptr: not moved
  /// For the method "paper": the stream's root joint, and the positions of the other body's root.
  std::size_t root = 0;
  const std::vector<float>* onto_seconds = nullptr;  // [K]
  std::vector<Vec3> onto_root;                       // [K] m
};

/// Adds the raw samples of the part to `detail`. `first`: stamp of the take's first row.
void add_raw(const RawPoints& raw, const RawMove& move, Time first, PageDetail& detail);

/// A part of the take, in s from its first row.
struct DetailStretch {
  double begin_s = 0.0, end_s = 0.0;
};

/// Returns the part around the middle of `stretch` in which all nodes together have at most `most`
/// raw samples, assuming a constant rate. The limit keeps the page small, because nodes at 100 Hz
/// and more have many samples.
DetailStretch raw_node_stretch(const std::vector<RawNode>& raw, const DetailStretch& stretch,
                               std::size_t most);

/// Adds a node's raw samples of the part to its figures. The inverse of `sensor_from_bone` rotates
/// the vectors to the axes of the node's other signals.
void add_raw(const RawNode& raw, const Quat& sensor_from_bone, Time first,
             const DetailStretch& stretch, NodeFigures& figures);

}  // namespace kinalign
