// SPDX-License-Identifier: Apache-2.0
// Jobs for kinalign-learn, made by `train`, `eval` and `benchmark run`, and the windows for them.
#pragma once

#include "apps/cli/verb.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// The task of a method: to clean the joints of a Kinect, to compute poses from nodes, or to
/// compute poses from both devices (fusion). learns_of() and what_it_does() convert between a task
/// and its words.
enum class Learns : std::uint8_t { denoise, pose, fuse };

/// The task that a model's file names, such as "denoise". Empty for any other word.
std::optional<Learns> learns_of(const std::string& task);
/// The task in words: "cleans a Kinect".
std::string what_it_does(Learns task);

/// A method that kinalign-learn trains. kinalign itself only checks the method's flags and passes
/// its name on.
struct TrainedMethod {
  std::string name, summary;
  Learns task = Learns::denoise;
  bool has_code = false;  // true: an autoencoder, whose answer can be projected onto constraints
};
/// All methods that kinalign-learn can train.
const std::vector<TrainedMethod>& trained_methods();
/// The method with this name; nullptr if there is none.
const TrainedMethod* find_trained(const std::string& name);

/// Fails unless exactly one of --data and --windows is given.
Result<void> check_data(const std::string& data, const std::string& windows);
/// The name of the input stream. For methods that clean a Kinect the default is "kinect". Other
/// methods have no input stream, or simulate it.
std::string rough_stream(const std::string& input, Learns task);

/// The flags --input and --truth, which several verbs share.
Field input_field(std::string& input);
Field truth_field(std::string& truth);
Field nodes_field(std::string& nodes);
/// Fails if one of --nodes, --hand-weight, --own-root, --input, --rate, --vary-speed or --vary-size
/// was given and the method does not use it.
Result<void> check_task_flags(const TrainedMethod& method, const Sources& given);

/// The windows that are cut from a data set: the values of flags of `train` and `eval`, with which
/// cut_windows() starts `kinalign dataset windows`.
struct WindowsWanted {
  std::string data, split;    // empty split: all takes are trained on
  std::string where;          // empty: all takes whose verdict is not "bad"
  std::string input, truth;   // names of streams; input may be empty
  double rate_hz = 30.0;      // for methods that clean; others have a fixed rate
  std::string valid = "0.2";  // the least share of valid samples in a window
};
/// Cuts windows for methods of this task and writes them. Fails if there are none.
Result<void> cut_windows(const WindowsWanted& wanted, Learns task, const std::string& file);

/// A training for `eval` or `benchmark run`.
struct TrainingWanted {
  std::string method, windows, input, truth;
  std::vector<std::string> nodes{};             // empty: the method's default
  std::vector<std::string> learnt{}, judged{};  // names of takes
  // The folder for job, log and model. An existing model is used again.
  std::string folder{};
  std::string device;                // "cpu" or "cuda"
  std::int64_t seed = 1, steps = 0;  // steps 0: the method's default
  // The weight of the hands in the loss. 0: the method's own.
  double hand_weight = 0.0;
};
/// The file of the trained model. If it does not exist, the model is trained, or its stopped
/// training is continued. Each training has its own folder, whose name depends on everything that
/// changes the result.
Result<std::string> trained_model(const TrainingWanted& wanted, Call& call);

/// Trains a model. `job` has neither files nor threads; they are added here. The folder keeps job,
/// log and checkpoint, so that a training that was stopped can continue.
Result<void> train_in(const std::string& folder, nlohmann::ordered_json job,
                      const std::string& model, Call& call);

/// The rows that kinalign-learn prints about a model for poses or fusion, one JSON object each. The
/// model is tested on the takes that are neither in `learnt` nor in `judged`.
Result<std::vector<std::string>> rows_of_model(const TrainingWanted& wanted,
                                               const std::string& model, Call& call);

}  // namespace kinalign
