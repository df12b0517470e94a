// SPDX-License-Identifier: Apache-2.0
// A take: several streams of one motion on one grid, in one space, with the truth about every
// sample. Written and read in slabs of rows. The layout on disk: docs/formats/take.md.
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

/// How far a resampled stream's samples are from what the device said. Rows as the stream's.
struct SampleDistance {
  std::vector<std::int64_t> nearest_raw_ns;    // at most 10 s; empty: not resampled
  std::vector<std::int64_t> time_interval_ns;  // half-width of the stamp's interval; empty: unknown
  /// As `valid`: 1 between samples that miss some. In no file: only the report counts it.
  std::vector<std::uint8_t> over_loss{};
};

/// n rows of a skeleton's stream.
struct ClipRows {
  std::vector<double> positions;        // [n,J,3] m, in the take's space
  std::vector<double> local_positions;  // [n,J,3] m
  std::vector<double> local_rotations;  // [n,J,4]
  std::vector<std::uint8_t> valid;      // [n]; empty for the reference, where all are
  SampleDistance distance;              // [n]
};

/// n rows of a stream of points.
struct PointRows {
  std::vector<double> positions;    // [n,J,3] m; zeros where not valid
  std::vector<Tracking> state;      // [n,J] the lesser of both neighbouring raw samples
  std::vector<std::uint8_t> valid;  // [n,J] 0: nothing was seen near enough
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

struct ClipGroup {
  Skeleton skeleton;
};
struct PointGroup {
  std::vector<std::string> joint_names;
};
struct ImuGroup {
  std::vector<std::string> node_names;
  ImuContent content;
  std::string root_node;  // whose space the others are in; empty: the world's
};

/// Whether gravity stands in a node's acceleration. Below a root node it stands in the root's
/// alone: the others' are what they differ from it by.
bool has_gravity(const ImuGroup& group, std::size_t node);

/// What is known of a stream before its first row.
struct TakeGroup {
  std::string name;  // "mocap"
  std::variant<ClipGroup, PointGroup, ImuGroup> kind;
  bool resampled = false;       // nearest_raw_ns is there
  bool interval_known = false;  // time_interval_ns is there
  std::vector<InputFacts> files;
  std::string space = "take";  // of positions: the reference's, or a stream's that was not moved
};

struct TakeHeader {
  std::string subject, action;
  std::uint64_t frames = 0;
  std::vector<TakeGroup> groups;
  Manifest parameters;  // all that made it
};

/// Rows first, first + 1, ... of all streams, in the order of the header's groups.
struct TakeSlab {
  std::uint64_t first = 0;
  std::vector<Time> stamps;
  std::vector<std::variant<ClipRows, PointRows, ImuRows>> rows;
};

/// Puts the rows of `slab` behind those of `all`, which has the same groups or, still empty, none.
void append_rows(TakeSlab& all, const TakeSlab& slab);

/// A whole take in memory.
struct Take {
  TakeHeader header;
  TakeSlab all;
  AlignmentReport report;
};

}  // namespace kinalign
