// SPDX-License-Identifier: Apache-2.0
// Compares the recording of a simulated scene with the truth: the times of the samples, and the
// values in the rows of a take.
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

/// Absolute errors of a device's stamps on the take's time axis.
struct TimeJudgement {
  std::string stream, node;
  std::uint64_t samples = 0;
  double median_s = 0.0, most_s = 0.0, worst_s = 0.0;  // most: 95 % of the errors are at most this
  std::optional<double> half_width_s;                  // greatest half-width of all intervals
  /// Number of stamps with an interval, and number of those whose error exceeds the interval.
  std::uint64_t certified = 0, outside = 0;
};

/// `shift`: UTC of the recording minus UTC of the truth at the same moment. Fails if the truth does
/// not contain the device, or if the stream can't be read.
Result<TimeJudgement> judge_time(const RecordedStream& stream, const TrueRecording& truth,
                                 Duration shift);

/// Errors of a stream's values, rms: m for points and skeletons, rad/s for the rotation of nodes.
/// The difference between `after` and `alone` is the error that alignment adds to the device's own
/// error.
struct ValueJudgement {
  std::string stream, node;
  std::uint64_t count = 0;
  std::optional<double> before;  // error of the device's own values, with points in camera space
  double after = 0.0;            // error in the take, compared with the truth at the row's stamp
  /// The device's own error: with true times and the true position of the camera.
  std::optional<double> alone;
};

/// References; all four objects must exist while the take is judged.
struct JudgedTake {
  const Take& take;
  const Recording& recording;
  const TrueRecording& truth;
  const Motion& motion;  // the true motion
  Duration shift{};
};

/// Combines all nodes of a stream, weighted by their rows in the take: "all nodes".
ValueJudgement together(std::span<const ValueJudgement> nodes);

/// Judges every group of the take whose device is in the truth. Nodes are compared by the size of
/// their angular rate, which does not depend on how they are worn. The result lists each node, then
/// all together.
Result<std::vector<ValueJudgement>> judge_values(const JudgedTake& judged);

}  // namespace kinalign
