// SPDX-License-Identifier: Apache-2.0
// Methods that clean a Kinect, each fitted to the training people of a data set and run on the
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

struct CleaningOptions {
  std::string data, split, folder;    // of the data set; of its people; of all that is made
  std::vector<std::string> methods;   // of eval_methods()
  std::vector<std::string> programs;  // NAME=PROGRAM (program_method.h)
  std::string device = "cpu";         // where networks are trained
  std::int64_t seed = 1, steps = 0;   // 0: each method's own number
};

/// Pairs that the methods learn from, and takes that they are tested on.
struct CleaningData {
  std::string windows, windows_hash;
  Pairs pairs;
  DenoiseLayout layout;
  std::vector<std::string> learnt;  // names of takes
  std::vector<const Pair*> tested;  // of `pairs`
  std::size_t learnt_people = 0, tested_people = 0, tested_takes = 0;
};

/// Cuts the windows into the folder and reads them. Fails where the split has no part "train" or
/// no part "test" with pairs.
Result<CleaningData> open_cleaning(const CleaningOptions& o, Call& call);

/// A method's answers to data.tested.
struct CleanedTakes {
  std::string method;
  std::vector<std::vector<float>> answers;         // of each stretch [T,Jout,3] m, not steadied
  std::vector<std::array<DenoiseMarks, 2>> marks;  // of each stretch: as it is, and steadied
};

/// Trains what the folder lacks (models/METHOD.safetensors), and runs all methods. A model that was
/// trained on other takes or with other settings is refused; --force trains it again.
Result<std::vector<CleanedTakes>> run_methods(const CleaningOptions& o, const CleaningData& data,
                                              Call& call);

/// The trainings of a run, before they are done.
struct TrainingPlan {
  std::string method;
  bool is_there = false;
  std::int64_t steps = 0;
  std::optional<double> seconds;  // on one busy core; an idle one needs less. Absent: not known
};
std::vector<TrainingPlan> training_plan(const CleaningOptions& o);

/// Table 9: the paper's three columns and the well-defined ones, mean and deviation over the test
/// people. Two rows a method: as it is, and steadied.
Table marks_table(const CleaningData& data, const std::vector<CleanedTakes>& all);
/// The same with cells "3.42 ± 1.05" for people.
Table with_joined_deviations(const Table& table);

/// Mean distance to the truth over the marked joints, cm, of each frame [T]. 0 where none is valid.
std::vector<float> errors_over_time(const CleaningData& data, const Pair& pair,
                                    const std::vector<float>& answer);

}  // namespace kinalign
