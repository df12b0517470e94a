// SPDX-License-Identifier: Apache-2.0
// Folds: which takes are tested while the others are learnt from.
#pragma once

#include "kinalign/core/error.h"

#include <string>
#include <vector>

namespace kinalign {

struct FoldTake {
  std::string name, subject, action;
  int run = 0;
  std::string part{};  // of a split: "train", "validation", "test"
};

struct Fold {
  std::string name;                         // "subject 03"
  std::vector<std::string> learnt, tested;  // names of takes
  std::vector<std::string> judged{};        // of a split: its part validation
};

/// "people": each person is tested once. "runs": runs 5 and 10 of every action are tested
/// (UI-PRMD's REP). "actions": five folds, every fifth action is tested (MOV), in the order of
/// their names. Fails for another word and where a fold has nothing to learn from or to test.
Result<std::vector<Fold>> folds_of(const std::string& kind, const std::vector<FoldTake>& takes);

/// The run in a take's name: 3 of "sub-01_task-walk_run-03"; 0 where it names none.
int run_of(const std::string& take);

}  // namespace kinalign
