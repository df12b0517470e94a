// SPDX-License-Identifier: Apache-2.0
// The result and the quality of an alignment as data; pages and lines are made from it.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/motion/arrivals.h"
#include "kinalign/motion/rigid_fit.h"
#include "kinalign/motion/stamps.h"
#include "kinalign/take/recording.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// A joint's distance to its counterpart, m rms, over the rows in which both are tracked.
struct JointResidual {
  std::string joint, onto;
  std::uint64_t rows = 0;
  double before_m = 0.0;  // before the stream was moved
  double after_m = 0.0;
};

/// How a stream of points was brought into the take's space.
struct SpaceReport {
  std::string stream, onto;
  std::string method;        // one of SpaceOptions::method
  RigidTransform transform;  // paper: only the rotation; the translation differs in each frame
  double magnification = 1.0;
  double before_m = 0.0, after_m = 0.0;  // rms over all named joints
  std::vector<JointResidual> joints;     // worst first
};

/// The quality of one stream. Several streams of nodes may share the name of a group; `nodes` tells
/// them apart.
struct StreamReport {
  std::string stream;              // the take's group
  std::vector<std::string> nodes;  // nodes of the group that this stream measures
  StampSurvey survey;
  bool counted = false;          // the device wrote no stamps; they are counted by the rate
  double rate_hz = 0.0;          // nominal, else from the median step
  std::int64_t gap_ns = 0;       // longer stretches without samples are gaps
  std::uint64_t held_back = 0;   // samples dropped since they were delayed: the next one followed
                                 // too soon
  Arrivals arrivals;             // delays of stamps
  std::uint64_t gaps = 0;        // within the take
  std::int64_t gap_time_ns = 0;  // sum of their lengths
  std::uint64_t samples = 0;     // rows x joints (or nodes) of the take; rows for a skeleton
  std::uint64_t invalid = 0;     // invalid ones among these samples
  std::uint64_t empty_rows = 0;  // rows of the take in which nothing of the stream is valid
  std::uint64_t inferred = 0;    // valid, but guessed by the device (state 1)
  std::uint64_t bridged = 0;  // valid, but between samples of which some are missing: state 0, or
                              // more than 1.5 of the stream's steps apart
  std::int64_t worst_nearest_ns = 0;  // over valid rows: largest distance to the nearest raw sample
  std::optional<std::int64_t> worst_interval_ns;  // half-width; absent: not known
  std::uint64_t unsure = 0;  // valid, of unknown time, while the interval of others is known
};

/// The report of one alignment. The take stores it as JSON. Lines, pages and verdicts are made from
/// it, so the rows need not be read again.
struct AlignmentReport {
  std::uint64_t frames = 0;
  Time begin{}, end{};   // the grid's
  double rate_hz = 0.0;  // the grid's
  std::string reference;
  std::vector<StreamReport> streams;
  std::vector<SpaceReport> spaces;
  /// The recordings' marks, on the take's axis; some may lie before its first frame.
  std::vector<TakeMark> marks;
  Findings findings;  // from readers and alignment, most severe first
};

}  // namespace kinalign
