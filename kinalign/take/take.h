// SPDX-License-Identifier: Apache-2.0
// A take: several streams of one motion on one grid and in one space, with the quality of every
// sample. It is written and read in slabs of rows. The layout on disk: docs/formats/take.md.
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

/// The distance of a resampled stream's samples from the raw ones. Rows as in the stream.
struct SampleDistance {
  std::vector<std::int64_t> nearest_raw_ns;    // limited to 10 s; empty: not resampled
  std::vector<std::int64_t> time_interval_ns;  // half-width of the stamp's interval; empty: unknown
  /// Shaped like `valid`; 1: between samples of which some are missing. No file stores it; only the
  /// report counts it.
  std::vector<std::uint8_t> over_loss{};
};

/// n rows of a skeleton's stream.
struct ClipRows {
  std::vector<double> positions;        // [n,J,3] m, in the take's space
  std::vector<double> local_positions;  // [n,J,3] m
  std::vector<double> local_rotations;  // [n,J,4]
  std::vector<std::uint8_t> valid;      // [n]; empty for the reference, whose rows are all valid
  SampleDistance distance;              // [n]
};

/// n rows of a stream of points.
struct PointRows {
  std::vector<double> positions;    // [n,J,3] m; zeros where not valid
  std::vector<Tracking> state;      // [n,J] the worse of both neighbouring raw samples
  std::vector<std::uint8_t> valid;  // [n,J] 0: no raw sample is near enough
  SampleDistance distance;          // [n]
};

/// n rows of a stream of nodes.
struct ImuRows {
  std::vector<double> orientation;       // [n,S,4] in the stream's space, see ImuGroup
  std::vector<double> acceleration;      // [n,S,3] m/s2
  std::vector<double> angular_velocity;  // [n,S,3] rad/s
  std::vector<std::uint8_t> valid;       // [n,S]
  SampleDistance distance;               // [n,S]
};

/// The constant part of a group, by its kind: the names of the columns of its rows.
struct ClipGroup {
  Skeleton skeleton;
};
struct PointGroup {
  std::vector<std::string> joint_names;
};
struct ImuGroup {
  std::vector<std::string> node_names;
  ImuContent content;
  std::string root_node;  // the others are in its space; empty: in the world's
};

/// True if a node's acceleration contains gravity. With a root node only the root's does: the
/// accelerations of the others are their difference from it.
bool has_gravity(const ImuGroup& group, std::size_t node);

/// The facts about a stream that are known before its first row.
struct TakeGroup {
  std::string name;  // "mocap"
  std::variant<ClipGroup, PointGroup, ImuGroup> kind;
  bool resampled = false;       // it has nearest_raw_ns
  bool interval_known = false;  // it has time_interval_ns
  std::vector<InputFacts> files;
  /// The space of positions: the reference's, or that of a stream that was not moved.
  std::string space = "take";
};

/// The facts about a take that are known before its first row. Writers need `frames` in advance,
/// because they create arrays of their final size.
struct TakeHeader {
  std::string subject, action;
  std::uint64_t frames = 0;
  std::vector<TakeGroup> groups;
  Manifest parameters;  // all that the take was made with
};

/// The rows first, first + 1, ... of all streams, in the order of the header's groups.
struct TakeSlab {
  std::uint64_t first = 0;
  std::vector<Time> stamps;
  std::vector<std::variant<ClipRows, PointRows, ImuRows>> rows;
};

/// Appends the rows of `slab` to `all`, which has the same groups or is still empty.
void append_rows(TakeSlab& all, const TakeSlab& slab);

/// A whole take in memory, for tests and small jobs. Programs pass slabs instead.
struct Take {
  TakeHeader header;
  TakeSlab all;
  AlignmentReport report;
};

}  // namespace kinalign
