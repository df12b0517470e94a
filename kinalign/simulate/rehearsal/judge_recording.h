// SPDX-License-Identifier: Apache-2.0
// What became of a simulated recording, held against the truth: of every sample the time that it
// was given, and of a take's rows the values.
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
  double median_s = 0.0, most_s = 0.0, worst_s = 0.0;  // most: of 95 %
  std::optional<double> half_width_s;                  // the widest of the intervals
  std::uint64_t certified = 0, outside = 0;  // stamps with an interval; beyond it of these
};

/// `shift`: how much later the recording's UTC is than the truth's, of the same instant. Fails
/// where the truth has no such device, or the stream can't be read.
Result<TimeJudgement> judge_time(const RecordedStream& stream, const TrueRecording& truth,
                                 Duration shift);

/// Errors of what a stream says, rms: m of points and skeletons, rad/s of nodes' turning.
struct ValueJudgement {
  std::string stream, node;
  std::uint64_t count = 0;
  std::optional<double> before;  // as the device gave it: points in the camera's space
  double after = 0.0;            // in the take, against the truth at the row's stamp
  std::optional<double> alone;   // by the device's own noise, at true times, in its true place
};

struct JudgedTake {
  const Take& take;
  const Recording& recording;
  const TrueRecording& truth;
  const Motion& motion;  // the truth's
  Duration shift{};
};

/// All nodes of a stream as one, each as often as it has rows in the take: "all nodes".
ValueJudgement together(std::span<const ValueJudgement> nodes);

/// Of every group of the take whose device the truth has; of nodes how fast they turn, which does
/// not depend on how they are worn: each, and behind them all.
Result<std::vector<ValueJudgement>> judge_values(const JudgedTake& judged);

}  // namespace kinalign
