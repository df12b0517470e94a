// SPDX-License-Identifier: Apache-2.0
// The content of a take's page as plain data. take_figures.h makes it from a take's rows, and
// page_html.h makes the page from it. Units are metres, seconds and radians; axes are right-handed
// with y up; arrays are row-major. T: number of rows of the take. K: number of rows that the page
// stores (every stride-th row). D: number of rows of the detail, a part of the take.
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

/// The colours of the HFUT-MMD paper: mocap red, Kinect green, nodes blue. Points are red if they
/// are a reference: other streams were moved onto them, or their joints are not those of a Kinect.
enum class PageColour { mocap, kinect, imu };

/// A skeleton or points, as shown by the player and the figures. All arrays have the K rows that
/// the page stores.
struct PageBody {
  std::string name;  // name of the group in the take
  PageKind kind = PageKind::clip;
  PageColour colour = PageColour::mocap;
  std::vector<std::string> joint_names;  // [J], for a skeleton including its longer end sites
  std::vector<int> parents;              // [J] -1: none
  std::vector<float> positions;          // [K,J,3] m, zeros where missing
  std::vector<std::uint8_t> state;       // [K,J] values of Tracking; empty: all tracked
  bool in_take_space = true;             // false: own space, not drawn with others
};

/// A part of the take with every row and the raw samples of one body, for figure 7 of the HFUT-MMD
/// paper. Times are in s from the take's first row.
struct PageDetail {
  std::size_t body = 0;  // index in TakePage::bodies; resampled points
  double begin_s = 0.0, end_s = 0.0;
  /// All rows of the part; empty if the page already stores every row.
  std::vector<float> seconds;         // [D]
  std::vector<float> positions;       // [D,J,3] m
  std::vector<std::uint8_t> state;    // [D,J]
  std::vector<float> onto_positions;  // [D,P,3] m, counterparts of PageSpace::pairs
  /// The rows nearest to a raw sample. They are drawn instead of raw samples if the inputs can't be
  /// read.
  std::vector<float> near_seconds;  // [N]
  float near_s = 0.0f;              // longest time to the raw sample
  /// Raw samples of the stream's input, moved into the body's space. Empty if no input could be
  /// read.
  bool has_raw = false;
  std::vector<float> raw_seconds;       // [R]
  std::vector<float> raw_positions;     // [R,J,3] m
  std::vector<std::uint8_t> raw_state;  // [R,J]
};

/// The transform of a stream of points into the space of another body. Figures 5 to 7 show its
/// effect; `report` has its numbers.
struct PageSpace {
  SpaceReport report;
  std::size_t body = 0, onto = 0;  // indices in TakePage::bodies
  /// Indices of joints of both bodies, in the order of report.joints.
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  // One transform applies to all rows. Otherwise original positions and zones are not known.
  bool once_per_take = true;
};

/// The zones of a Kinect v2 (HFUT-MMD paper, section 2.2), measured along the floor from the
/// Kinect.
enum class Zone : std::uint8_t { best, largest, outside };
inline constexpr std::size_t zone_count = 3;
inline constexpr double best_near_m = 0.8, best_far_m = 3.5;
inline constexpr double largest_near_m = 0.5, largest_far_m = 4.5;
inline constexpr double field_deg = 70.0;

/// The Kinect in the take's space, and the states of joints by zone. It exists only if the Kinect
/// has one transform for the whole take (floor_of()).
struct PageFloor {
  std::size_t body = 0;
  Vec3 camera = Vec3::Zero();    // m
  Vec3 forward = Vec3::UnitZ();  // unit vector along the floor
  struct Counts {
    std::uint64_t tracked = 0, inferred = 0;
  };
  std::array<Counts, zone_count> zones{};  // counts of rows x joints
  std::uint64_t missing = 0;               // number of missing joints
};

/// The length of a bone over time, for figure 10. The bones of a skeleton are constant by
/// definition, those of a Kinect are not.
struct BoneLength {
  std::size_t body = 0, joint = 0;  // from the joint's parent to the joint
  std::uint64_t rows = 0;           // rows in which both ends are tracked
  double mean_m = 0.0, deviation_m = 0.0, shortest_m = 0.0, longest_m = 0.0;
};

/// The numbers of tracked, inferred and missing rows of each joint of a body, over all rows. Used
/// in figure 9.
struct JointStates {
  std::size_t body = 0;
  std::vector<std::array<std::uint64_t, 3>> counts;  // [J] by values of Tracking
};

/// A stream's samples over time, in equal bins of the take. With bins, the size of a lane does not
/// depend on the take's length.
struct PageLane {
  std::string stream, part;  // such as "imu" and "waist"
  PageColour colour = PageColour::mocap;
  bool resampled = false;
  bool interval_known = false;
  std::vector<float> tracked, inferred;  // [bins] shares of rows x joints; the others are missing
  std::vector<float> nearest_raw_s;      // [bins] largest value over valid rows
  std::vector<float> interval_s;         // [bins] largest half-width
};

/// A node and the bone on which it is worn, for figures 11 to 13 and the table of nodes. Signals
/// are in the node's axes as it was mounted.
struct NodeFigures {
  std::string node, joint;    // such as "wrist_left" and "LeftForeArm"
  bool joint_by_name = true;  // false: the joint whose rotation is most similar to the node's
  std::string more_like;      // joint of another node whose rotation is clearly more similar
  std::uint64_t rows = 0;     // number of compared rows
  bool has_rate = false, has_acceleration = false, has_orientation = false;
  bool has_gravity = false;
  double rate_rms = 0.0;          // rad/s, rms difference after the best constant rotation
  double rate_correlation = 0.0;  // correlation of the magnitudes
  double acceleration_rms = 0.0;  // m/s2, rms difference in the same way
  double acceleration_correlation = 0.0;
  double orientation_rms = 0.0;  // rad, after the best constant rotations of world and sensor
  std::optional<double> lag_s;   // delay of the node relative to the mocap, from the rates
  std::vector<float> rate, mocap_rate;                  // [K,3] rad/s; zeros where not valid
  std::vector<float> acceleration, mocap_acceleration;  // [K,3] m/s2
  std::vector<float> orientation_error;                 // [K] rad
  std::vector<float> axes;          // [K,4] w,x,y,z, axes of the node in the take's space
  std::vector<std::uint8_t> valid;  // [K]
  /// Raw samples within the detail, in the node's axes. Empty if no input was read.
  std::vector<float> raw_seconds;                 // [R]
  std::vector<float> raw_rate, raw_acceleration;  // [R,3]
};

/// Everything that a page shows. An index has the name of the list to which it refers.
struct TakePage {
  std::string file;  // name of the take, without its folder
  std::string software, subject, action;
  AlignmentReport report;
  // Computed by kinalign/align/verdict.h and shown on the first screen.
  std::vector<Verdict> verdicts;  // one for each stream
  std::vector<Concern> worst;     // at most three, the worst first
  std::vector<InputFacts> inputs;

  // The stored rows, and figures computed from them.
  std::uint64_t stride = 1;
  std::vector<float> seconds;  // [K] s since the first row
  std::vector<PageBody> bodies;
  std::vector<PageSpace> spaces;
  std::vector<PageFloor> floors;
  std::vector<BoneLength> bones;
  std::vector<JointStates> joint_states;
  std::vector<PageLane> lanes;
  std::size_t node_body = 0;  // index in `bodies`: the body with which nodes are compared
  std::vector<NodeFigures> nodes;
  double raw_nodes_begin_s = 0.0, raw_nodes_end_s = 0.0;  // s; part with raw samples in `nodes`
  std::vector<PageDetail> details;
};

}  // namespace kinalign
