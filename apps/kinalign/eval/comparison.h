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

struct Eval {
  std::vector<std::string> methods, models;
  std::string data, windows, split, input, truth = "mocap", nodes, folds = "people";
  std::string format = "text", device = "cpu";
  double rate_hz = 30.0, hand_weight = 0.0;
  std::int64_t seeds = 1, steps = 0;
  bool own_root = false;
};

/// The name of the rough stream. The default is a Kinect's for methods that clean one; others see
/// none or a simulated one.
std::string input_of(const Eval& o, Learns task);

/// A method or a model on one fold, trained from one seed.
struct Trial {
  TrainingWanted training;          // the method is "model" if `model` names a file
  std::string model;                // a finished model's file; empty: one is trained
  std::vector<std::string> tested;  // names of takes
};

struct MarkColumn {
  std::string key, title;
  int decimals = 1;
};

/// The marks of a method on one fold, one text for each seed.
struct FoldMarks {
  std::string fold;
  std::vector<std::string> texts;
};

/// The marking of trials, and the titles of the table.
struct Comparison {
  std::string dataset;  // the name of the data set in the windows
  std::vector<FoldTake> takes;
  std::vector<MarkColumn> columns;
  std::vector<MarkColumn> joints{};  // columns of a second table, one for each joint; empty: none
  /// "people": each value of a row is one person's. "folds": each value is one fold's, or one
  /// person's if there is a single fold.
  std::string over;
  std::string note;  // added to the caption
  /// The marks of a trial as a JSON array, which the cache keeps.
  std::function<Result<std::string>(const Trial&, Call&)> mark;
  /// Sums up all trials of a method; the table calls the method `name`. Empty if a text can't be
  /// read as marks.
  std::function<std::vector<MethodMarks>(const std::string& name, const std::vector<FoldMarks>&)>
      sum_up;
};

/// Compares methods that clean a Kinect. `bytes`: the content of the file of windows. Fails if a
/// stream is missing in it.
Result<Comparison> denoise_comparison(const Eval& o, const std::string& bytes,
                                      const std::string& file);
/// Compares methods for poses or for fusion.
Result<Comparison> body_comparison(const Eval& o, Learns task, const std::string& bytes,
                                   const std::string& file);

}  // namespace kinalign
