// SPDX-License-Identifier: Apache-2.0
// The marks of a model: its errors on the people of the test part, as JSON.
#pragma once

#include "apps/kinalign-learn/job.h"

#include "kinalign/learn/fuse/fuse_data.h"
#include "kinalign/models/fuse/fuse_model.h"
#include "kinalign/models/pose/pose_model.h"
#include "kinalign/models/windows_file.h"

#include <string>

namespace kinalign {

/// The marks to store in the model's file. Empty if the data has no test part. The marks are
/// computed once, after training, on people whom the model has not seen. `kinalign info` shows
/// them.
Result<std::string> pose_metrics_json(const PoseModel& model, const PoseData& data);
Result<std::string> fuse_metrics_json(const FuseModel& model, const FuseData& data);

/// Takes the Kinect's joints from the stream named `input`. If the file has no such stream, the
/// Kinect is simulated.
FuseDataOptions fuse_options(const std::string& input, const Windows& windows);

/// Prints the marks of the job's model, one JSON object a line. A model for poses has one line for
/// each state of the nodes. A model for fusion has lines for the model and for a filter without
/// learning: one for each choice of devices, and one for each node's heading. "people" has the
/// marks of each person. `model`: the bytes of the file job.evaluate.
Result<void> print_marks(const TrainingJob& job, const Windows& windows, const std::string& model);

}  // namespace kinalign
