// SPDX-License-Identifier: Apache-2.0
// Folds: the takes that are tested while the others are learnt from.
#pragma once

#include "kinalign/core/error.h"

#include <string>
#include <vector>

namespace kinalign {

/// A take as the folds see it: only its labels decide in which fold it is tested.
struct FoldTake {
  std::string name, subject, action;
  int run = 0;
  std::string part{};  // part of a split: "train", "validation", "test"
};

/// The takes of one comparison: `learnt` fit a method, `tested` give its marks. A take is never in
/// both.
struct Fold {
  std::string name;                         // "subject 03"
  std::vector<std::string> learnt, tested;  // names of takes
  std::vector<std::string> judged{};        // with a split: its part "validation"
};

/// "people": each person is tested once. "runs": runs 5 and 10 of every action are tested
/// (UI-PRMD's REP). "actions": five folds, each tests every fifth action (MOV), in the order of
/// their names. "split": one fold with the parts of a split. Fails for another word, and if a fold
/// has nothing to learn from or to test.
Result<std::vector<Fold>> folds_of(const std::string& kind, const std::vector<FoldTake>& takes);

/// The run in a take's name: 3 for "sub-01_task-walk_run-03"; 0 if the name has none.
int run_of(const std::string& take);

}  // namespace kinalign
