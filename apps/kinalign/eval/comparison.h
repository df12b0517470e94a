// SPDX-License-Identifier: Apache-2.0
// Compares methods and models of one task on folds: divisions of the takes into training and test.
#pragma once

#include "apps/kinalign/learn/training_job.h"

#include "kinalign/compare/folds.h"
#include "kinalign/compare/method_marks.h"

#include <functional>
#include <string>
#include <vector>

namespace kinalign {

/// The options of `kinalign eval`. Exactly one of `data` and `windows` is set. If `split` is set,
/// `folds` is not used. An empty `nodes` or a 0 means the default of each method.
struct Eval {
  // `methods` are names, `models` are files of finished models. Each gives one row of the table, or
  // two.
  std::vector<std::string> methods, models;
  std::string data, windows, split, input, truth = "mocap", nodes, folds = "people";
  std::string format = "text", device = "cpu";
  double rate_hz = 30.0, hand_weight = 0.0;
  std::int64_t seeds = 1, steps = 0;
  bool own_root = false;
};

/// One method or model on one fold, trained from one seed. The cache has one entry for each trial,
/// because the same trial on the same windows always has the same marks.
struct Trial {
  TrainingWanted training;          // the method is "model" if `model` is set
  std::string model;                // a finished model's file; empty: a model is trained
  std::vector<std::string> tested;  // names of the takes to test on
};

/// A column of the tables. `key` is its name in the rows and in JSON. `title` is its name for
/// people, with the unit.
struct MarkColumn {
  std::string key, title;
  int decimals = 1;
};

/// The marks of a method on one fold: the texts that Comparison::mark returned, one for each seed.
/// A method without training has one text.
struct FoldMarks {
  std::string fold;
  std::vector<std::string> texts;
};

/// How the trials of one task are marked, and the titles of the table. eval.cpp needs to know
/// nothing else about a task. The functions have their own data, so a Comparison may be moved.
struct Comparison {
  std::string dataset;  // name of the windows' data set
  // Folds are divisions of these takes. Each take is listed once, although it may have many
  // windows.
  std::vector<FoldTake> takes;
  std::vector<MarkColumn> columns;
  // The columns of a second table, one for each joint. Empty if there is no such table.
  std::vector<MarkColumn> joints{};
  /// "people" if each value of a row belongs to one person. "folds" if each value belongs to one
  /// fold; with a single fold the values belong to people.
  std::string over;
  std::string note;  // an addition to the table's caption
  /// Returns the marks of a trial as a JSON array, which is stored in the cache. If the trial names
  /// no model, one is trained first, which may take hours.
  std::function<Result<std::string>(const Trial&, Call&)> mark;
  /// Sums up all trials of a method, which the table calls `name`. Returns nothing if a text does
  /// not contain marks. To check one cached text, the function is called with this text alone.
  std::function<std::vector<MethodMarks>(const std::string& name, const std::vector<FoldMarks>&)>
      sum_up;
};

/// Compares methods that clean the joints of a Kinect. `bytes`: the content of the file of windows.
/// Fails if the windows lack a stream.
Result<Comparison> denoise_comparison(const Eval& o, const std::string& bytes,
                                      const std::string& file);
/// Compares methods for poses or for fusion. kinalign-learn computes their marks, since only that
/// program simulates nodes and a Kinect from the mocap.
Result<Comparison> body_comparison(const Eval& o, Learns task, const std::string& bytes,
                                   const std::string& file);

}  // namespace kinalign
