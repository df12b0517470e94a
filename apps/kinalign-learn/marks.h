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

/// For the model's own facts; empty where the data have no test part.
Result<std::string> pose_metrics_json(const PoseModel& model, const PoseData& data);
Result<std::string> fuse_metrics_json(const FuseModel& model, const FuseData& data);

/// The file's own Kinect where it has a stream of the name `input`, else simulated ones.
FuseDataOptions fuse_options(const std::string& input, const Windows& windows);

/// Prints a JSON object a line: of a model for poses for each state of the nodes; of one for fusion
/// and of the filter for each device and both, and for each node's heading. "people" has the same
/// of each person. `model`: the bytes of job.evaluate.
Result<void> print_marks(const TrainingJob& job, const Windows& windows, const std::string& model);

}  // namespace kinalign
