// SPDX-License-Identifier: Apache-2.0
// What train and eval hand to kinalign-learn: methods by name, windows of a data set, a job.
#pragma once

#include "apps/cli/verb.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// What a method learns: to clean a Kinect, to answer nodes with a pose, to answer both.
enum class Learns : std::uint8_t { denoise, pose, fuse };

/// "denoise", as the file of a model says; absent for another word.
std::optional<Learns> learns_of(const std::string& task);
/// "cleans a Kinect".
std::string what_it_does(Learns task);

struct TrainedMethod {
  std::string name, summary;
  Learns task = Learns::denoise;
  bool has_code = false;  // an autoencoder, whose answer may be brought to constraints
};
/// All methods that kinalign-learn knows.
const std::vector<TrainedMethod>& trained_methods();
/// nullptr: no such method.
const TrainedMethod* find_trained(const std::string& name);

/// Flags that train and eval share.
Field input_field(std::string& input);
Field truth_field(std::string& truth);
Field nodes_field(std::string& nodes);
/// Fails for --nodes, --input or --rate where a method of that task has no use for it.
Result<void> check_task_flags(const TrainedMethod& method, const Sources& given);

/// Windows to be cut of a data set.
struct WindowsWanted {
  std::string data, split;    // split: empty: all is trained on
  std::string where;          // empty: takes whose verdict is not bad
  std::string input, truth;   // streams; input may be empty
  double rate_hz = 30.0;      // of methods that clean; others have their own
  std::string valid = "0.2";  // least share of valid cells
};
/// Writes the windows that methods of the task learn from. Fails where there are none.
Result<void> cut_windows(const WindowsWanted& wanted, Learns task, const std::string& file);

/// A training as eval wants it.
struct TrainingWanted {
  std::string method, windows, input, truth;
  std::vector<std::string> nodes{};             // empty: the usual ones
  std::vector<std::string> learnt{}, judged{};  // names of takes
  std::string folder{};  // of the run: its job, its log and its model, which is used if it is there
  std::string device;    // cpu, cuda
  std::int64_t seed = 1, steps = 0;  // steps 0: the method's own number
  double hand_weight = 0.0;          // of the loss; 0: the method's own
};
/// The file of the model, trained where it is not there. A training that was stopped goes on.
Result<std::string> trained_model(const TrainingWanted& wanted, Call& call);

/// The rows that kinalign-learn prints for a model for poses or fusion on the takes that are
/// neither learnt nor judged: a JSON object each.
Result<std::vector<std::string>> rows_of_model(const TrainingWanted& wanted,
                                               const std::string& model, Call& call);

/// "a,b" in two.
std::vector<std::string> split_at_commas(const std::string& text);

}  // namespace kinalign
