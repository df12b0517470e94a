// SPDX-License-Identifier: Apache-2.0
// Methods that clean a Kinect. Each is fitted to the training people of a data set and run on the
// takes of its test people.
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

/// The flags of `benchmark run` that concern methods. The folder keeps windows, models and tables,
/// so a run that was stopped continues.
struct CleaningOptions {
  std::string data, split, folder;  // the data set; the split of its people; the folder for results
  std::vector<std::string> methods;   // names in eval_methods()
  std::vector<std::string> programs;  // NAME=PROGRAM (program_method.h)
  std::string device = "cpu";         // for the training of networks
  std::int64_t seed = 1, steps = 0;   // 0 steps: each method's own number
};

/// The pairs that methods learn from, and those that they are tested on.
/// `tested` points into `pairs`, so the structure must not be copied. Each pair is a stretch of one
/// take in which both streams have frames.
struct CleaningData {
  std::string windows, windows_hash;
  Pairs pairs;
  DenoiseLayout layout;
  std::vector<std::string> learnt;  // names of takes
  std::vector<const Pair*> tested;  // pointers into `pairs`
  std::size_t learnt_people = 0, tested_people = 0, tested_takes = 0;
};

/// Cuts the windows into the folder and reads them. Fails if the split has no part "train" or no
/// part "test" with pairs.
Result<CleaningData> open_cleaning(const CleaningOptions& o, Call& call);

/// The answers of a method to data.tested.
/// `answers` and `marks` have the order of data.tested.
struct CleanedTakes {
  std::string method;
  std::vector<std::vector<float>> answers;         // each stretch [T,Jout,3] m, not steadied
  std::vector<std::array<DenoiseMarks, 2>> marks;  // each stretch: plain, and steadied
};

/// Trains the models that the folder lacks (models/METHOD.safetensors), and runs all methods. A
/// model trained on other takes or with other settings is refused; --force trains it again.
Result<std::vector<CleanedTakes>> run_methods(const CleaningOptions& o, const CleaningData& data,
                                              Call& call);

/// A training of a run, before it is done.
struct TrainingPlan {
  std::string method;
  bool is_there = false;  // the model exists already
  std::int64_t steps = 0;
  std::optional<double> seconds;  // on one busy core; absent: not known
};
/// The trainings that run_methods() would do, in its order. Nothing is read but the names in the
/// folder.
std::vector<TrainingPlan> training_plan(const CleaningOptions& o);

/// Table 9: the paper's three columns and the well-defined ones, mean and deviation over the test
/// people. Each method has two rows: plain, and steadied.
Table marks_table(const CleaningData& data, const std::vector<CleanedTakes>& all);
/// The same table for people, with cells like "3.42 ± 1.05".
Table with_joined_deviations(const Table& table);

/// The mean distance to the truth over the marked joints, cm, for each frame [T]. 0 if no joint is
/// valid.
/// A curve for one method and one stretch. The joints are those that a Kinect and the truth share.
std::vector<float> errors_over_time(const CleaningData& data, const Pair& pair,
                                    const std::vector<float>& answer);

}  // namespace kinalign
