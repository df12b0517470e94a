// SPDX-License-Identifier: Apache-2.0
// Compares the recording of a simulated scene with the truth: the time that each sample was given,
// and the values in the rows of a take.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/motion/pose.h"
#include "kinalign/take/recording.h"
#include "kinalign/take/take.h"
#include "kinalign/take/truth.h"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kinalign {

/// Absolute errors of a device's stamps on the take's axis.
struct TimeJudgement {
  std::string stream, node;
  std::uint64_t samples = 0;
  double median_s = 0.0, most_s = 0.0, worst_s = 0.0;  // most: 95 % of the errors are not greater
  std::optional<double> half_width_s;                  // greatest half-width of all intervals
  /// Number of stamps with an interval, and of those whose error exceeds it.
  std::uint64_t certified = 0, outside = 0;
};

/// `shift`: the recording's UTC minus that of the truth at the same instant. Fails if the truth has
/// no such device, or if the stream can't be read.
Result<TimeJudgement> judge_time(const RecordedStream& stream, const TrueRecording& truth,
                                 Duration shift);

/// Errors of a stream's values, rms: m for points and skeletons, rad/s for the rotation of nodes.
/// `after` may be compared with `alone`: what alignment adds to the device's own error.
struct ValueJudgement {
  std::string stream, node;
  std::uint64_t count = 0;
  std::optional<double> before;  // error of the device's own values: points in the camera's space
  double after = 0.0;            // in the take, compared with the truth at the row's stamp
  /// The device's own noise: at true times and with the true position of the camera.
  std::optional<double> alone;
};

/// References only: all four must outlive the judging.
struct JudgedTake {
  const Take& take;
  const Recording& recording;
  const TrueRecording& truth;
  const Motion& motion;  // motion of the truth
  Duration shift{};
};

/// All nodes of a stream together, weighted by their rows in the take: "all nodes".
ValueJudgement together(std::span<const ValueJudgement> nodes);

/// Judges every group of the take whose device is in the truth. For nodes it compares the speed of
/// rotation, which does not depend on how they are worn: first each node, then all together.
Result<std::vector<ValueJudgement>> judge_values(const JudgedTake& judged);

}  // namespace kinalign
