// SPDX-License-Identifier: Apache-2.0
// The content of a take's page as plain data. take_figures.h makes it from a take's rows;
// page_html.h makes the page. Metres, seconds, radians, right-handed, y up; row-major arrays. T:
// rows of the take. K: rows that the page stores, every stride-th. D: rows of the detail.
#pragma once

#include "kinalign/align/verdict.h"
#include "kinalign/motion/arrays.h"
#include "kinalign/take/report.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

enum class PageKind { clip, points };

/// The paper's colours: mocap red, Kinect green, nodes blue. Points are red if other streams were
/// moved onto them, or if their joints are not a Kinect's: both are a reference.
enum class PageColour { mocap, kinect, imu };

/// A skeleton or points, over the stored rows.
/// One body of the player and of the figures. All arrays have the page's K rows.
struct PageBody {
  std::string name;  // the take's group
  PageKind kind = PageKind::clip;
  PageColour colour = PageColour::mocap;
  std::vector<std::string> joint_names;  // [J], for a clip with its longer end sites
  std::vector<int> parents;              // [J] -1: none
  std::vector<float> positions;          // [K,J,3] m, zeros where missing
  std::vector<std::uint8_t> state;       // [K,J] as Tracking; empty: all tracked
  bool in_take_space = true;             // false: in the stream's own space; not drawn with others
};

/// A part of the take with every row and the raw samples of one body: the paper's figure 7.
/// Times are in s from the take's first row.
struct PageDetail {
  std::size_t body = 0;  // index in TakePage::bodies; resampled points
  double begin_s = 0.0, end_s = 0.0;
  /// All rows of the part; empty if the page stores every row anyway.
  std::vector<float> seconds;         // [D]
  std::vector<float> positions;       // [D,J,3] m
  std::vector<std::uint8_t> state;    // [D,J]
  std::vector<float> onto_positions;  // [D,P,3] m, counterparts of PageSpace::pairs
  /// The rows nearest to a raw sample. They stand for it if the inputs can't be read.
  std::vector<float> near_seconds;  // [N]
  float near_s = 0.0f;              // largest distance in time from the raw sample
  /// Raw samples of the stream's input, moved into the body's space. None if no input could be
  /// read.
  bool has_raw = false;
  std::vector<float> raw_seconds;       // [R]
  std::vector<float> raw_positions;     // [R,J,3] m
  std::vector<std::uint8_t> raw_state;  // [R,J]
};

/// The transform of a stream of points into the space of another body, and what the page draws of
/// it.
/// Figures 5 to 7 draw it; `report` has its numbers.
struct PageSpace {
  SpaceReport report;
  std::size_t body = 0, onto = 0;  // indices in TakePage::bodies
  /// Joints of both bodies, in the order of report.joints.
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  bool once_per_take = true;  // one transform holds for all rows: `before` and the zones are known
};

/// The paper's zones of a Kinect v2 (section 2.2), measured along the floor from the Kinect.
enum class Zone : std::uint8_t { best, largest, outside };
inline constexpr std::size_t zone_count = 3;
inline constexpr double best_near_m = 0.8, best_far_m = 3.5;
inline constexpr double largest_near_m = 0.5, largest_far_m = 4.5;
inline constexpr double field_deg = 70.0;

/// The Kinect in the take's space, and the states of joints by the zone that they were in.
/// Only for a Kinect with one transform for the whole take (floor_of()).
struct PageFloor {
  std::size_t body = 0;
  Vec3 camera = Vec3::Zero();    // m
  Vec3 forward = Vec3::UnitZ();  // unit, along the floor
  struct Counts {
    std::uint64_t tracked = 0, inferred = 0;
  };
  std::array<Counts, zone_count> zones{};  // rows x joints
  std::uint64_t missing = 0;               // joints at an unknown place
};

/// The constancy of a bone. A skeleton's bones are constant by construction, a Kinect's are not.
/// Figure 10.
struct BoneLength {
  std::size_t body = 0, joint = 0;  // from the joint's parent to the joint
  std::uint64_t rows = 0;           // rows in which both ends are tracked
  double mean_m = 0.0, deviation_m = 0.0, shortest_m = 0.0, longest_m = 0.0;
};

/// The counts of tracked, inferred and missing rows of each joint of a body, over all rows.
/// Figure 9.
struct JointStates {
  std::size_t body = 0;
  std::vector<std::array<std::uint64_t, 3>> counts;  // [J] by Tracking
};

/// A stream's samples over time, in equal bins of the take.
/// Bins keep a lane small whatever the take's length is.
struct PageLane {
  std::string stream, part;  // "imu", "waist"
  PageColour colour = PageColour::mocap;
  bool resampled = false;
  bool interval_known = false;
  std::vector<float> tracked, inferred;  // [bins] shares of rows x joints; the rest is missing
  std::vector<float> nearest_raw_s;      // [bins] largest over valid rows
  std::vector<float> interval_s;         // [bins] largest half-width
};

/// A node and the bone that it is worn on. Signals are in the node's own space, as it was mounted.
/// Figures 11 to 13, and a row of the table of nodes.
struct NodeFigures {
  std::string node, joint;    // "wrist_left", "LeftForeArm"
  bool joint_by_name = true;  // false: the joint that turns most like the node
  std::string more_like;      // another node's joint that turns clearly more like this node
  std::uint64_t rows = 0;     // compared rows
  bool has_rate = false, has_acceleration = false, has_orientation = false;
  bool has_gravity = false;
  double rate_rms = 0.0;          // rad/s, of the difference after the best constant rotation
  double rate_correlation = 0.0;  // correlation of the magnitudes
  double acceleration_rms = 0.0;  // m/s2, in the same way
  double acceleration_correlation = 0.0;
  double orientation_rms = 0.0;  // rad, after the best constant rotations of world and sensor
  std::optional<double> lag_s;   // delay of the node against the mocap, by their rates
  std::vector<float> rate, mocap_rate;                  // [K,3] rad/s; zeros where not valid
  std::vector<float> acceleration, mocap_acceleration;  // [K,3] m/s2
  std::vector<float> orientation_error;                 // [K] rad
  std::vector<float> axes;          // [K,4] w,x,y,z, the node in the take's space
  std::vector<std::uint8_t> valid;  // [K]
  /// Raw samples within the detail, also in the node's own space. Empty if no input was read.
  std::vector<float> raw_seconds;                 // [R]
  std::vector<float> raw_rate, raw_acceleration;  // [R,3]
};

/// Everything that a page shows. Indices between the lists are named after the list that they refer
/// to.
struct TakePage {
  std::string file;  // name of the take, without its folder
  std::string software, subject, action;
  AlignmentReport report;
  // kinalign/align/verdict.h computes these verdicts; the page's first screen shows them.
  std::vector<Verdict> verdicts;  // one for each stream
  std::vector<Concern> worst;     // at most three, worst first
  std::vector<InputFacts> inputs;

  // The stored rows, and the figures made of them.
  std::uint64_t stride = 1;
  std::vector<float> seconds;  // [K] s since the first row
  std::vector<PageBody> bodies;
  std::vector<PageSpace> spaces;
  std::vector<PageFloor> floors;
  std::vector<BoneLength> bones;
  std::vector<JointStates> joint_states;
  std::vector<PageLane> lanes;
  std::size_t node_body = 0;  // index in `bodies`: the body that nodes are compared with
  std::vector<NodeFigures> nodes;
  double raw_nodes_begin_s = 0.0, raw_nodes_end_s = 0.0;  // s, with raw samples in `nodes`
  std::vector<PageDetail> details;
};

}  // namespace kinalign
