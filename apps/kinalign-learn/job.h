// SPDX-License-Identifier: Apache-2.0
// A job for the program kinalign-learn, as `kinalign train` writes it: JSON of schema
// kinalign.training_job/1.
#pragma once

#include "apps/kinalign-learn/processes.h"

#include "kinalign/learn/trainer.h"

#include <string>
#include <vector>

namespace kinalign {

/// A job of one of three kinds. If `project` is set, the job projects answers of a model. If
/// `evaluate` is set, the job computes a model's marks. Otherwise it trains a model. All paths are
/// those of the machine on which the job runs.
struct TrainingJob {
  std::string method;
  std::string windows;             // path of the file of windows
  std::string windows_sha256{};    // SHA-256 of that file's bytes, once it is read
  std::string input, truth;        // names of streams
  std::vector<std::string> nodes;  // for methods with inertial nodes; the last one is on the root
  std::string evaluate;            // path of a model whose marks are computed; empty: none
  std::string project;             // path of a model whose answers are projected; empty: none
  // For `project`: a SafeTensors file with "0.positions" [T,J,3] in m, "0.seen" [T,J],
  // "1.positions" and so on. The projected answers are written with the same names.
  std::string bodies;
  std::string out;   // path of the model's file
  std::string from;  // path of a model whose training is continued; empty: random weights
  // Path of a CSV file. A curve and events are written beside it. Empty: no log.
  std::string log;
  std::string checkpoint;         // path of a file written during the training; empty: none
  std::int64_t keep_every = 200;  // training steps between two checkpoints
  bool resume = false;            // continue from the checkpoint if it exists
  std::string device = "cpu";     // "cpu" or "cuda"
  std::int64_t threads = 1;
  ProcessPlace place;  // this process's place among several; the first one writes all files
  TrainingOptions options;
  double hand_weight = 0.0;                  // weight of the hands in the loss; 0: the method's own
  double vary_speed = 0.0, vary_size = 0.0;  // for poses and fusion: random changes (see Variety)
  /// The names of the takes to train on, and of those that judge the training. All other takes are
  /// the test part. If `learn` is empty, the split in the file of windows decides.
  std::vector<std::string> learn, judge;
  std::string identity;  // a hash of everything on which the job's result depends
};

/// Parses a job. A setting that the job does not name has the method's default.
Result<TrainingJob> read_job(const std::string& text, const std::string& name);

/// Does the job. Progress goes to stdout, one JSON object a line. The last line names the written
/// file, or is the last row of a model's marks.
Result<void> run_job(const TrainingJob& job);

}  // namespace kinalign
