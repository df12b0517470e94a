// SPDX-License-Identifier: Apache-2.0
// A take: several streams of one motion on one grid of stamps and in one space, with the quality of
// every sample. It is written and read in blocks of rows (slabs). The layout on disk is in
// docs/formats/take.md.
#pragma once

#include "kinalign/motion/clip.h"
#include "kinalign/motion/streams.h"
#include "kinalign/take/manifest.h"
#include "kinalign/take/recording.h"
#include "kinalign/take/report.h"

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace kinalign {

/// How far the samples of a resampled stream are from its raw samples. One value for each row.
struct SampleDistance {
  // Time to the nearest raw sample, at most 10 s. Empty if the stream was not resampled.
  std::vector<std::int64_t> nearest_raw_ns;
  std::vector<std::int64_t> time_interval_ns;  // half-width of the stamp's interval; empty: unknown
  /// Same shape as `valid`. 1: interpolated over missing samples. No file stores this array; only
  /// the report counts it.
  std::vector<std::uint8_t> over_loss{};
};

/// n rows of a stream of skeletons with J joints.
struct ClipRows {
  std::vector<double> positions;        // [n,J,3] m, in the take's space
  std::vector<double> local_positions;  // [n,J,3] m
  std::vector<double> local_rotations;  // [n,J,4]
  std::vector<std::uint8_t> valid;      // [n]; empty for the reference: all rows are valid
  SampleDistance distance;              // [n]
};

/// n rows of a stream of points with J joints.
struct PointRows {
  std::vector<double> positions;    // [n,J,3] m; zeros where not valid
  std::vector<Tracking> state;      // [n,J] the worse state of the two neighbouring raw samples
  std::vector<std::uint8_t> valid;  // [n,J] 0: no raw sample is near enough
  SampleDistance distance;          // [n]
};

/// n rows of a stream of S nodes.
struct ImuRows {
  std::vector<double> orientation;       // [n,S,4] in the stream's space, see ImuGroup
  std::vector<double> acceleration;      // [n,S,3] m/s2
  std::vector<double> angular_velocity;  // [n,S,3] rad/s
  std::vector<std::uint8_t> valid;       // [n,S]
  SampleDistance distance;               // [n,S]
};

/// The constant part of a group, by its kind: the skeleton or the names of the columns.
struct ClipGroup {
  Skeleton skeleton;
};
struct PointGroup {
  std::vector<std::string> joint_names;
};
struct ImuGroup {
  std::vector<std::string> node_names;
  ImuContent content;
  std::string root_node;  // the other nodes are in its space; empty: all are in the world's space
};

/// Returns whether a node's acceleration contains gravity. If there is a root node, the root's
/// acceleration was subtracted from all others, so only the root's contains gravity.
bool has_gravity(const ImuGroup& group, std::size_t node);

/// The facts about a stream that are known before its first row.
struct TakeGroup {
  std::string name;  // "mocap"
  std::variant<ClipGroup, PointGroup, ImuGroup> kind;
  bool resampled = false;       // the group has nearest_raw_ns
  bool interval_known = false;  // the group has time_interval_ns
  std::vector<InputFacts> files;
  /// The space of the positions: "take" for the reference's space, or a space of a stream that was
  /// not moved.
  std::string space = "take";
};

/// The facts about a take that are known before its first row. Writers need `frames` in advance,
/// because they create arrays of the final size.
struct TakeHeader {
  std::string subject, action;
  std::uint64_t frames = 0;
  std::vector<TakeGroup> groups;
  Manifest parameters;  // all options with which the take was made
};

/// The rows first, first + 1, ... of all streams, in the order of the groups.
struct TakeSlab {
  std::uint64_t first = 0;
  std::vector<Time> stamps;
  std::vector<std::variant<ClipRows, PointRows, ImuRows>> rows;
};

/// Appends the rows of `slab` to `all`. `all` has the same groups or is empty.
void append_rows(TakeSlab& all, const TakeSlab& slab);

/// A whole take in memory, for tests and short recordings. Programs pass slabs instead.
struct Take {
  TakeHeader header;
  TakeSlab all;
  AlignmentReport report;
};

}  // namespace kinalign
