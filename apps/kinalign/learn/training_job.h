// SPDX-License-Identifier: Apache-2.0
// The job of kinalign-learn, from train and eval: methods by name, windows of a data set.
#pragma once

#include "apps/cli/verb.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// The task of a method: clean a Kinect, answer nodes with a pose, or answer both devices with a
/// pose.
/// The word of a task is in models and jobs; learns_of() and what_it_does() translate it.
enum class Learns : std::uint8_t { denoise, pose, fuse };

/// The task by the word in a model's file, such as "denoise". Absent for another word.
std::optional<Learns> learns_of(const std::string& task);
/// The task in words: "cleans a Kinect".
std::string what_it_does(Learns task);

/// A method of kinalign-learn. kinalign itself knows no network: it only checks flags and passes
/// the name on.
struct TrainedMethod {
  std::string name, summary;
  Learns task = Learns::denoise;
  bool has_code = false;  // an autoencoder, whose answer can be projected onto constraints
};
/// All methods that kinalign-learn knows.
const std::vector<TrainedMethod>& trained_methods();
/// The method with that name; nullptr if there is none.
const TrainedMethod* find_trained(const std::string& name);

/// Fails unless exactly one of --data and --windows is given.
Result<void> check_data(const std::string& data, const std::string& windows);
/// The name of the rough stream. The default is a Kinect's for methods that clean one; others see
/// none or a simulated one.
std::string rough_stream(const std::string& input, Learns task);

/// Flags that train and eval share.
Field input_field(std::string& input);
Field truth_field(std::string& truth);
Field nodes_field(std::string& nodes);
/// Fails for --nodes, --hand-weight, --own-root, --input, --rate, --vary-speed or --vary-size if a
/// method of that task has no use for the flag.
Result<void> check_task_flags(const TrainedMethod& method, const Sources& given);

/// The windows to be cut from a data set.
/// The flags of `train` and `eval` that choose data. cut_windows() starts `kinalign dataset
/// windows` with them.
struct WindowsWanted {
  std::string data, split;    // empty split: all takes are trained on
  std::string where;          // empty: takes whose verdict is not bad
  std::string input, truth;   // names of streams; input may be empty
  double rate_hz = 30.0;      // for methods that clean; others have their own
  std::string valid = "0.2";  // least share of valid cells
};
/// Writes the windows that methods of the task learn from. Fails if there are none.
Result<void> cut_windows(const WindowsWanted& wanted, Learns task, const std::string& file);

/// A training that eval wants.
struct TrainingWanted {
  std::string method, windows, input, truth;
  std::vector<std::string> nodes{};             // empty: the method's default
  std::vector<std::string> learnt{}, judged{};  // names of takes
  std::string folder{};                         // for job, log and model; an existing model is used
  std::string device;                           // cpu, cuda
  std::int64_t seed = 1, steps = 0;             // steps 0: the method's own number
  double hand_weight = 0.0;                     // in the loss; 0: the method's own
};
/// The file of the model. Trains it if the file does not exist; a training that was stopped goes
/// on.
/// The folder belongs to one training: its name is made from everything that the result depends on.
Result<std::string> trained_model(const TrainingWanted& wanted, Call& call);

/// Trains a model by a job without files and threads. The folder belongs to this training: it keeps
/// job, log and checkpoint, so a training that was stopped goes on.
Result<void> train_in(const std::string& folder, nlohmann::ordered_json job,
                      const std::string& model, Call& call);

/// The rows that kinalign-learn prints about a model for poses or fusion, a JSON object each. The
/// model is tested on the takes that are neither in `learnt` nor in `judged`.
Result<std::vector<std::string>> rows_of_model(const TrainingWanted& wanted,
                                               const std::string& model, Call& call);

}  // namespace kinalign
