// SPDX-License-Identifier: Apache-2.0
// Folds of a cross-validation: which takes are tested and which are used for training.
#pragma once

#include "kinalign/core/error.h"

#include <string>
#include <vector>

namespace kinalign {

/// A take with the labels that assign it to a fold.
struct FoldTake {
  std::string name, subject, action;
  int run = 0;
  std::string part{};  // part of a split: "train", "validation" or "test"
};

/// The takes of one fold. Methods are fitted to the takes `learnt` and judged on the takes
/// `tested`. No take is in both.
struct Fold {
  std::string name;                         // such as "subject 03"
  std::vector<std::string> learnt, tested;  // names of takes
  std::vector<std::string> judged{};        // with a split: the takes of its part "validation"
};

/// Makes the folds of a kind. "people": each person is tested once. "runs": runs 5 and 10 of every
/// action are tested (REP of UI-PRMD). "actions": five folds; each tests every fifth action in the
/// order of names (MOV). "split": one fold with the parts of a split. Fails for another kind, and
/// if a fold has no take for training or testing.
Result<std::vector<Fold>> folds_of(const std::string& kind, const std::vector<FoldTake>& takes);

/// Returns the run in a take's name: 3 for "sub-01_task-walk_run-03"; 0 if the name has none.
int run_of(const std::string& take);

}  // namespace kinalign
