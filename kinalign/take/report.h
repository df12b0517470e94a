// SPDX-License-Identifier: Apache-2.0
// The result and the quality of an alignment as data. The reference is the stream whose stamps are
// the grid. Pages and messages are made from it.
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

/// The distance between a joint and its counterpart, m rms, over the rows in which both are
/// tracked.
struct JointResidual {
  std::string joint, onto;
  std::uint64_t rows = 0;
  double before_m = 0.0;  // distance before the stream was moved
  double after_m = 0.0;
};

/// How a stream of points was moved into the take's space.
struct SpaceReport {
  std::string stream, onto;
  std::string method;        // one of SpaceOptions::method
  RigidTransform transform;  // method "paper": only the rotation; frames differ in translation
  double magnification = 1.0;
  double before_m = 0.0, after_m = 0.0;  // rms over all paired joints
  std::vector<JointResidual> joints;     // the joint with the largest distance first
};

/// The quality of one stream. Several streams of nodes may share the name of a group; `nodes`
/// distinguishes them.
struct StreamReport {
  std::string stream;              // group in the take
  std::vector<std::string> nodes;  // nodes that this stream measures
  StampSurvey survey;
  bool counted = false;          // the device wrote no stamps; they are computed by the rate
  double rate_hz = 0.0;          // nominal, or else from the median step
  std::int64_t gap_ns = 0;       // longer times without samples are gaps
  std::uint64_t held_back = 0;   // samples dropped because they were delayed: the next sample
                                 // followed too soon
  Arrivals arrivals;             // delays of the stream's stamps
  std::uint64_t gaps = 0;        // number of gaps within the take
  std::int64_t gap_time_ns = 0;  // sum of the gaps' lengths
  std::uint64_t samples = 0;     // rows x joints (or nodes) of the take; rows for a skeleton
  std::uint64_t invalid = 0;     // number of invalid samples
  std::uint64_t empty_rows = 0;  // rows of the take without a valid sample of this stream
  std::uint64_t inferred = 0;    // valid, but estimated by the device (state 1)
  std::uint64_t bridged = 0;     // valid, but interpolated over missing samples: state 0, or raw
                                 // samples more than 1.5 steps apart
  std::int64_t worst_nearest_ns = 0;  // over valid rows: longest time to the nearest raw sample
  std::optional<std::int64_t> worst_interval_ns;  // half-width; absent: not known
  std::uint64_t unsure = 0;  // valid samples without an interval, if other samples have one
};

/// The report of one alignment. The take stores it as JSON. Texts, pages and verdicts are made from
/// it without reading the rows again.
struct AlignmentReport {
  std::uint64_t frames = 0;
  Time begin{}, end{};   // of the grid
  double rate_hz = 0.0;  // of the grid
  std::string reference;
  std::vector<StreamReport> streams;
  std::vector<SpaceReport> spaces;
  /// The marks of the recordings, on the take's time axis. Some may be before the first frame.
  std::vector<TakeMark> marks;
  Findings findings;  // from readers and alignment, the most severe first
};

}  // namespace kinalign
