// SPDX-License-Identifier: Apache-2.0
// Eval compares methods and models of one task on folds of takes.
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

/// The rough stream: a Kinect's, unless the methods see none or a simulated one.
std::string input_of(const Eval& o, Learns task);

/// A method or a model on one fold, trained from one seed.
struct Trial {
  TrainingWanted training;          // its method is "model" where `model` is one
  std::string model;                // the file of a finished model; empty: one is trained
  std::vector<std::string> tested;  // names of takes
};

struct MarkColumn {
  std::string key, title;
  int decimals = 1;
};

/// Marks of a method on one fold, a text for each seed.
struct FoldMarks {
  std::string fold;
  std::vector<std::string> texts;
};

/// How trials are marked, and what the table says of them.
struct Comparison {
  std::string dataset;  // its name, as the windows state it
  std::vector<FoldTake> takes;
  std::vector<MarkColumn> columns;
  std::vector<MarkColumn> joints{};  // a table of their own; empty: none
  /// "people": a value of a row is a person's; "folds": a fold's (of a single fold a person's).
  std::string over;
  std::string note;  // for the caption
  /// The marks of a trial as a JSON array, which the cache keeps.
  std::function<Result<std::string>(const Trial&, Call&)> mark;
  /// Sums up all trials of a method; the table calls it `name`. Empty where a text is not such
  /// marks.
  std::function<std::vector<MethodMarks>(const std::string& name, const std::vector<FoldMarks>&)>
      sum_up;
};

/// Compares methods that clean a Kinect. `bytes`: of the file of windows. Fails where it lacks a
/// stream.
Result<Comparison> denoise_comparison(const Eval& o, const std::string& bytes,
                                      const std::string& file);
/// Compares methods for poses or for fusion.
Result<Comparison> body_comparison(const Eval& o, Learns task, const std::string& bytes,
                                   const std::string& file);

}  // namespace kinalign
