// SPDX-License-Identifier: Apache-2.0
// A Kinect's stream whose stamps are sound, and findings as text.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/take/recording.h"

#include <string>

namespace kinalign::test {

inline std::string whole(const Finding& f) {
  return std::string(to_string(f.severity)) + ": " + to_string(f.what) + "; " + f.meaning + "; " +
         f.repair;
}

inline RecordedStream kinect() {
  RecordedStream out;
  out.name = "kinect";
  out.data = PointInput{{"SpineBase", "Head"}, {}};
  out.survey.samples = 1000;
  out.survey.first = utc_time(0);
  out.survey.last = utc_time(32'967'000'000);
  out.survey.median_step_ns = 33'000'000;
  return out;
}

}  // namespace kinalign::test
