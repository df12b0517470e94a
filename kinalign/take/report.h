// SPDX-License-Identifier: Apache-2.0
// What alignment did and how good it is: data first; pages and lines are made from it.
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

/// A joint's distances to its counterpart, m rms, over the rows where both are tracked.
struct JointResidual {
  std::string joint, onto;
  std::uint64_t rows = 0;
  double before_m = 0.0;  // as the device gave it
  double after_m = 0.0;
};

/// How a stream of points came into the take's space.
struct SpaceReport {
  std::string stream, onto;
  std::string method;        // as SpaceOptions names it
  RigidTransform transform;  // paper: the rotation; the translation is another one in each frame
  double magnification = 1.0;
  double before_m = 0.0, after_m = 0.0;  // rms over all named joints
  std::vector<JointResidual> joints;     // worst first
};

struct StreamReport {
  std::string stream;              // the take's group
  std::vector<std::string> nodes;  // of the group's, those that this stream measures
  StampSurvey survey;
  bool counted = false;          // its stamps, from the first by that rate: the device wrote none
  double rate_hz = 0.0;          // nominal, else from the median step
  std::int64_t gap_ns = 0;       // longer stretches are gaps
  std::uint64_t held_back = 0;   // samples left out: the next one came on their heels
  Arrivals arrivals;             // how late samples were stamped
  std::uint64_t gaps = 0;        // within the take
  std::int64_t gap_time_ns = 0;  // sum of their lengths
  std::uint64_t samples = 0;     // rows x joints (or nodes) of the take; of a skeleton rows
  std::uint64_t invalid = 0;     // of these
  std::uint64_t empty_rows = 0;  // of the take, in which nothing of the stream is valid
  std::uint64_t inferred = 0;    // valid, but the device guessed (state 1)
  std::uint64_t bridged = 0;     // valid, but between samples of which some are missing: state 0,
                                 // or more than 1.5 of the stream's steps apart
  std::int64_t worst_nearest_ns = 0;  // over valid rows: distance to the nearest raw sample
  std::optional<std::int64_t> worst_interval_ns;  // half-width; absent: nothing is known
  std::uint64_t unsure = 0;  // valid, of unknown time beside others whose interval is known
};

struct AlignmentReport {
  std::uint64_t frames = 0;
  Time begin{}, end{};   // of the grid
  double rate_hz = 0.0;  // of the grid
  std::string reference;
  std::vector<StreamReport> streams;
  std::vector<SpaceReport> spaces;
  std::vector<TakeMark>
      marks;          // of the recordings, on the take's axis; also before its first frame
  Findings findings;  // of readers and of alignment, worst first
};

}  // namespace kinalign
