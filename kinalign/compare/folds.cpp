// SPDX-License-Identifier: Apache-2.0
#include "kinalign/compare/folds.h"

#include <algorithm>
#include <charconv>
#include <functional>
#include <set>

namespace kinalign {

namespace {

// UI-PRMD has ten actions, so each fold tests two.
constexpr std::size_t action_folds = 5;

/// Returns the different values of one member, sorted. The order of folds therefore does not depend
/// on the order of takes.
std::set<std::string> all_of(const std::vector<FoldTake>& takes, std::string FoldTake::*member) {
  std::set<std::string> out;
  for (const FoldTake& take : takes) out.insert(take.*member);
  return out;
}

/// Makes a fold. Every take that is not tested is used for training.
Fold fold_where(std::string name, const std::vector<FoldTake>& takes,
                const std::function<bool(const FoldTake&)>& is_tested) {
  Fold out{std::move(name), {}, {}};
  for (const FoldTake& take : takes) {
    (is_tested(take) ? out.tested : out.learnt).push_back(take.name);
  }
  return out;
}

}  // namespace

int run_of(const std::string& take) {
  const std::size_t at = take.find("_run-");
  int run = 0;
  if (at != std::string::npos) {
    // If the name has no number, the run stays 0.
    std::from_chars(take.data() + at + 5, take.data() + take.size(), run);
  }
  return run;
}

Result<std::vector<Fold>> folds_of(const std::string& kind, const std::vector<FoldTake>& takes) {
  std::vector<Fold> out;
  if (kind == "people") {
    for (const std::string& subject : all_of(takes, &FoldTake::subject)) {
      out.push_back(fold_where("subject " + subject, takes,
                               [&](const FoldTake& take) { return take.subject == subject; }));
    }
  } else if (kind == "runs") {
    out.push_back(fold_where("runs 5 and 10", takes,
                             [](const FoldTake& take) { return take.run == 5 || take.run == 10; }));
  } else if (kind == "actions") {
    const auto names = all_of(takes, &FoldTake::action);
    const std::vector<std::string> actions(names.begin(), names.end());
    for (std::size_t k = 0; k < action_folds; ++k) {
      out.push_back(
          fold_where("actions " + std::to_string(k + 1), takes, [&](const FoldTake& take) {
            // The fold tests every fifth action in the order of names, so that similar neighbours
            // are in different folds.
            const auto at =
                std::find(actions.begin(), actions.end(), take.action) - actions.begin();
            return static_cast<std::size_t>(at) % action_folds == k;
          }));
    }
  } else if (kind == "split") {
    Fold& fold = out.emplace_back(Fold{"split", {}, {}});
    for (const FoldTake& take : takes) {
      if (take.part == "train") fold.learnt.push_back(take.name);
      if (take.part == "validation") fold.judged.push_back(take.name);
      if (take.part == "test") fold.tested.push_back(take.name);
    }
  } else {
    return Failure(Error{"", 0, "folds of people, runs or actions, or a split", kind});
  }
  // A fold without training or test takes is refused before any method is fitted.
  for (const Fold& fold : out) {
    if (!fold.learnt.empty() && !fold.tested.empty()) continue;
    return Failure(Error{"", 0, "takes for training and for the test in every fold",
                         fold.name + ": " + std::to_string(fold.learnt.size()) + " and " +
                             std::to_string(fold.tested.size())});
  }
  return out;
}

}  // namespace kinalign
