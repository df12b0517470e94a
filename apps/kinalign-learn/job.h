// SPDX-License-Identifier: Apache-2.0
// A training job as `kinalign train` writes it: JSON, schema kinalign.training_job/1.
#pragma once

#include "apps/kinalign-learn/processes.h"

#include "kinalign/learn/trainer.h"

#include <string>
#include <vector>

namespace kinalign {

/// One of three kinds: it projects (`project`), evaluates (`evaluate`) or trains (all else). The
/// paths are those of the machine on which the job runs.
struct TrainingJob {
  std::string method;
  std::string windows;             // the file of windows
  std::string windows_sha256{};    // SHA-256 of its bytes, once it is read
  std::string input, truth;        // names of streams
  std::vector<std::string> nodes;  // for methods with nodes; the root's node is the last
  std::string evaluate;            // a model to be marked instead of training; empty: none
  std::string project;             // a model whose answers are projected instead; empty: none
  std::string bodies;      // for `project`: SafeTensors "0.positions" [T,J,3] m, "0.seen" [T,J],
                           // "1.positions", ...; answers have the same names
  std::string out;         // the file of the model
  std::string from;        // a model to go on from; empty: random weights
  std::string log;         // CSV; a curve and events lie in its folder; empty: none
  std::string checkpoint;  // written while the training runs; empty: never
  std::int64_t keep_every = 200;  // steps between checkpoints
  bool resume = false;            // continue from the checkpoint if it exists
  std::string device = "cpu";     // cpu, cuda
  std::int64_t threads = 1;
  ProcessPlace place;  // this process among several; the first writes all files
  TrainingOptions options;
  double hand_weight = 0.0;                  // in the loss; 0: the method's own
  double vary_speed = 0.0, vary_size = 0.0;  // for poses and fusion (Variety)
  /// Names of takes that are trained on, and that judge the training; all others are the test part.
  /// Empty: the parts of the file's split count.
  std::vector<std::string> learn, judge;
  std::string identity;  // a hash of everything that the job's result depends on
};

/// Parses a job. Settings that it does not name are the method's own.
Result<TrainingJob> read_job(const std::string& text, const std::string& name);

/// Does the job. Progress goes to stdout, one JSON object a line.
/// The last line names the written file, or it is a row of marks.
Result<void> run_job(const TrainingJob& job);

}  // namespace kinalign
