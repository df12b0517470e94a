// SPDX-License-Identifier: Apache-2.0
// The comparison of methods and models of one task on folds of takes.
#pragma once

#include "apps/kinalign/learn/training_job.h"

#include "kinalign/compare/folds.h"
#include "kinalign/compare/method_marks.h"

#include <functional>
#include <string>
#include <vector>

namespace kinalign {

/// The options of `kinalign eval`. Exactly one of `data` and `windows` is set. `split` replaces
/// `folds`. An empty `nodes` or a 0 stands for each method's own default.
struct Eval {
  // `methods` are names, `models` are files of finished models. Each of them becomes a row of the
  // table, or two.
  std::vector<std::string> methods, models;
  std::string data, windows, split, input, truth = "mocap", nodes, folds = "people";
  std::string format = "text", device = "cpu";
  double rate_hz = 30.0, hand_weight = 0.0;
  std::int64_t seeds = 1, steps = 0;
  bool own_root = false;
};

/// A method or a model on one fold, trained from one seed.
/// The unit of the cache: the same trial on the same windows always has the same marks.
struct Trial {
  TrainingWanted training;          // the method is "model" if `model` names a file
  std::string model;                // a finished model's file; empty: one is trained
  std::vector<std::string> tested;  // names of takes
};

/// A column of the tables. `key` is the name in the rows and in JSON; `title` is for people and has
/// the unit.
struct MarkColumn {
  std::string key, title;
  int decimals = 1;
};

/// The marks of a method on one fold, one text for each seed.
/// The texts are those that Comparison::mark returned. A method without training has one text.
struct FoldMarks {
  std::string fold;
  std::vector<std::string> texts;
};

/// The marking of trials, and the titles of the table.
/// This structure is all that eval.cpp knows of a task. The functions hold their data themselves,
/// so a Comparison may be moved and kept after the content of the windows is gone.
struct Comparison {
  std::string dataset;  // the name of the data set in the windows
  // Each take once, although it may have many windows. Folds are made of these.
  std::vector<FoldTake> takes;
  std::vector<MarkColumn> columns;
  std::vector<MarkColumn> joints{};  // columns of a second table, one for each joint; empty: none
  /// "people": each value of a row is one person's. "folds": each value is one fold's, or one
  /// person's if there is a single fold.
  std::string over;
  std::string note;  // added to the caption
  /// The marks of a trial as a JSON array, which the cache keeps.
  /// It trains a model first if the trial names none, so a call may take hours.
  std::function<Result<std::string>(const Trial&, Call&)> mark;
  /// Sums up all trials of a method; the table calls the method `name`. Empty if a text can't be
  /// read as marks.
  /// It is called for a single text too, to check whether a cached text is still readable.
  std::function<std::vector<MethodMarks>(const std::string& name, const std::vector<FoldMarks>&)>
      sum_up;
};

/// Compares methods that clean a Kinect. `bytes`: the content of the file of windows. Fails if a
/// stream is missing in it.
Result<Comparison> denoise_comparison(const Eval& o, const std::string& bytes,
                                      const std::string& file);
/// Compares methods for poses or for fusion.
/// Both tasks are marked by kinalign-learn, since only that program makes nodes and a Kinect with
/// errors from the mocap.
Result<Comparison> body_comparison(const Eval& o, Learns task, const std::string& bytes,
                                   const std::string& file);

}  // namespace kinalign
