// SPDX-License-Identifier: Apache-2.0
// A training job as `kinalign train` hands it over: JSON, schema kinalign.training_job/1.
#pragma once

#include "apps/kinalign-learn/processes.h"

#include "kinalign/learn/trainer.h"

#include <string>
#include <vector>

namespace kinalign {

struct TrainingJob {
  std::string method;
  std::string windows;             // the file of windows
  std::string windows_sha256{};    // of its bytes, once it is read
  std::string input, truth;        // streams
  std::vector<std::string> nodes;  // of a method for poses; the root's last
  std::string evaluate;            // a model for poses to judge instead of training; empty: none
  std::string project;             // a model whose answers are projected instead; empty: none
  std::string bodies;              // of `project`: SafeTensors "0.positions" [T,J,3] m, "0.seen"
                                   // [T,J], "1.positions", ...; answers have the same names
  std::string out;                 // the model
  std::string from;                // a model to go on from; empty: from random weights
  std::string log;                 // CSV, and events beside it; empty: none
  std::string checkpoint;          // kept there while it runs; empty: nowhere
  std::int64_t keep_every = 200;   // steps between checkpoints
  bool resume = false;             // from that file, where it is there
  std::string device = "cpu";      // cpu, cuda
  std::int64_t threads = 1;
  ProcessPlace place;  // where several processes train: this one. The first writes all files
  TrainingOptions options;
  double hand_weight = 0.0;                  // of the loss; 0: the method's own
  double vary_speed = 0.0, vary_size = 0.0;  // of poses and fusion (Variety)
  /// Names of takes that are trained on, and that judge; all others are the test part. Empty: by
  /// the parts of the file's split.
  std::vector<std::string> learn, judge;
  std::string identity;  // of the job: all that the result depends on
};

/// Settings that the job does not name are the method's own.
Result<TrainingJob> read_job(const std::string& text, const std::string& name);

/// Does it. Progress goes to stdout, a JSON object a line.
Result<void> run_job(const TrainingJob& job);

}  // namespace kinalign
