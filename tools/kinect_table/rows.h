// SPDX-License-Identifier: Apache-2.0
// Every statistic with its band, real and simulated.
#pragma once

#include "tools/kinect_table/cameras.h"
#include "tools/kinect_table/figures.h"

#include <string>

namespace kinalign {

struct Row {
  std::string name;   // the statistic's name with its unit
  double real = 0.0;  // the reference's value for the real recordings
  double least = 0.0, most = 0.0;
  double simulated = 0.0;  // mean over seeds (two cameras: median)
  bool met() const { return simulated >= least && simulated <= most; }
};

/// UI-PRMD's rows and those of two cameras, on seeds 1 … seeds.
Result<std::vector<Row>> measured_rows(const std::vector<Repetition>& real, std::size_t seeds,
                                       std::size_t jobs);

/// The rows of two cameras and of stamps, which need no recordings.
Result<std::vector<Row>> camera_rows(std::size_t seeds, std::size_t jobs);

std::string plain(const std::vector<Row>& rows);
std::string markdown(const std::vector<Row>& rows, std::size_t seeds);

}  // namespace kinalign
