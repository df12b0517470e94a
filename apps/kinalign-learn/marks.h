// SPDX-License-Identifier: Apache-2.0
// The marks of a model on the people of the test part, as JSON.
#pragma once

#include "apps/kinalign-learn/job.h"

#include "kinalign/learn/fuse/fuse_data.h"
#include "kinalign/models/fuse/fuse_model.h"
#include "kinalign/models/pose/pose_model.h"
#include "kinalign/models/windows_file.h"

#include <string>

namespace kinalign {

/// The marks for the model's file. Empty if the data has no test part.
/// `kinalign info` shows these numbers. They are computed once, after training, on people of the
/// test part.
Result<std::string> pose_metrics_json(const PoseModel& model, const PoseData& data);
Result<std::string> fuse_metrics_json(const FuseModel& model, const FuseData& data);

/// The Kinect of the file if it has a stream named `input`, else simulated ones.
FuseDataOptions fuse_options(const std::string& input, const Windows& windows);

/// Prints one JSON object a line. For poses: one for each state of the nodes. For fusion: for the
/// model and for the filter, one for each device and both, and one for each node's heading.
/// "people" holds the marks of each person. `model`: the bytes of job.evaluate.
Result<void> print_marks(const TrainingJob& job, const Windows& windows, const std::string& model);

}  // namespace kinalign
