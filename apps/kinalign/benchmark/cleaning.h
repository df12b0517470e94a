// SPDX-License-Identifier: Apache-2.0
// Runs methods that clean the joints of a Kinect. Each method is fitted to the training people of a
// data set and then applied to the takes of the test people.
#pragma once

#include "apps/cli/verb.h"

#include "kinalign/compare/denoise_marks.h"
#include "kinalign/models/denoise_model.h"
#include "kinalign/models/pairs.h"
#include "kinalign/view/table.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// The options of `benchmark run` that concern methods. The folder keeps windows, models and
/// tables, so that a run that was stopped can continue.
struct CleaningOptions {
  std::string data, split, folder;  // the data set, the split of its people, the folder for results
  std::vector<std::string> methods;   // names from eval_methods()
  std::vector<std::string> programs;  // NAME=PROGRAM (program_method.h)
  std::string device = "cpu";         // "cpu" or "cuda", for trainings
  std::int64_t seed = 1, steps = 0;   // steps 0: the method's default
};

/// The data: pairs of a Kinect and the truth, for training and test. Each pair is a stretch of a
/// take in which both streams have frames. `tested` points into `pairs`, so the structure must not
/// be copied.
struct CleaningData {
  std::string windows, windows_hash;
  Pairs pairs;
  DenoiseLayout layout;
  std::vector<std::string> learnt;  // names of the takes to train on
  std::vector<const Pair*> tested;  // the pairs to test on, within `pairs`
  std::size_t learnt_people = 0, tested_people = 0, tested_takes = 0;
};

/// Cuts the windows, writes them into the folder and reads them. Fails if the part "train" or
/// "test" of the split has no pairs.
Result<CleaningData> open_cleaning(const CleaningOptions& o, Call& call);

/// The answers of a method to the tested stretches. `answers` and `marks` have the order of
/// data.tested.
struct CleanedTakes {
  std::string method;
  // The answers to each stretch: arrays [frame, joint, 3] in m, not steadied.
  std::vector<std::vector<float>> answers;
  std::vector<std::array<DenoiseMarks, 2>> marks;  // for each stretch: [0] plain, [1] steadied
};

/// Trains the models that are missing in the folder (models/METHOD.safetensors), and runs all
/// methods. A model that was trained on other takes or with other settings is refused. With --force
/// it is trained again.
Result<std::vector<CleanedTakes>> run_methods(const CleaningOptions& o, const CleaningData& data,
                                              Call& call);

/// A training that a run would do.
struct TrainingPlan {
  std::string method;
  bool is_there = false;  // true: the model exists already
  std::int64_t steps = 0;
  std::optional<double> seconds;  // time on one busy core, s; empty: not known
};
/// The trainings that run_methods() would do, in its order. No file is read; only the names in the
/// folder are used.
std::vector<TrainingPlan> training_plan(const CleaningOptions& o);

/// Table 9: the three columns of the HFUT-MMD paper and further ones, each with mean and deviation
/// over the test people. Each method has two rows: plain answers and steadied answers.
Table marks_table(const CleaningData& data, const std::vector<CleanedTakes>& all);
/// The same table for people: each cell has both numbers, such as "3.42 ± 1.05".
Table with_joined_deviations(const Table& table);

/// The error of one method in each frame of a stretch, cm. The error is the mean distance to the
/// truth over the joints that a Kinect and the truth share. 0 if no joint is valid.
std::vector<float> errors_over_time(const CleaningData& data, const Pair& pair,
                                    const std::vector<float>& answer);

}  // namespace kinalign
