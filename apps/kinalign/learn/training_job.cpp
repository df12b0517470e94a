// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/learn/training_job.h"

#include "apps/cli/console.h"
#include "apps/kinalign/dataset/own_process.h"
#include "apps/kinalign/learn/worker.h"

#include "kinalign/core/find_named.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <filesystem>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

constexpr double pose_windows_hz = 60.0;  // frame rate of windows from which nodes are simulated

/// The words for each task, in the order of Learns, because what_it_does() uses the value as an
/// index.
struct TaskWords {
  Learns task;
  std::string_view name, does;
};
constexpr std::array<TaskWords, 3> task_words{
    {{Learns::denoise, "denoise", "cleans a Kinect"},
     {Learns::pose, "pose", "computes a pose from nodes"},
     {Learns::fuse, "fuse", "computes a pose from a Kinect and nodes"}}};

/// A flag that only methods with these tasks use. `why`: the reason, printed after the name of
/// another method.
struct TaskFlag {
  const char* flag;
  std::vector<Learns> tasks;
  const char *expected, *why = "";
};
const std::array<TaskFlag, 7> task_flags{
    {{"nodes", {Learns::pose, Learns::fuse}, "a method for poses or for fusion"},
     {"vary-speed", {Learns::pose, Learns::fuse}, "a method for poses or for fusion"},
     {"vary-size", {Learns::pose, Learns::fuse}, "a method for poses or for fusion"},
     {"hand-weight", {Learns::denoise}, "a method that cleans a Kinect"},
     {"own-root", {Learns::denoise}, "a method that cleans a Kinect"},
     {"input",
      {Learns::denoise, Learns::fuse},
      "a method with a Kinect as input",
      ", whose input is simulated nodes"},
     {"rate", {Learns::denoise}, "a method that cleans a stream", ", which works at 30 Hz"}}};

/// The JSON members that every job has. Members with their defaults are left out. `learn` and
/// `judge` are names of takes.
Json begun_job(const TrainingWanted& wanted, Call& call) {
  Json out{{"schema", "kinalign.training_job/1"},
           {"method", wanted.method},
           {"windows", wanted.windows},
           {"truth", wanted.truth},
           {"learn", wanted.learnt},
           {"judge", wanted.judged},
           {"device", wanted.device},
           {"threads", call.jobs}};
  if (!wanted.input.empty()) out["input"] = wanted.input;
  if (!wanted.nodes.empty()) out["nodes"] = wanted.nodes;
  if (wanted.hand_weight > 0.0) out["hand_weight"] = wanted.hand_weight;
  return out;
}

}  // namespace

std::optional<Learns> learns_of(const std::string& task) {
  for (const TaskWords& one : task_words) {
    if (one.name == task) return one.task;
  }
  return std::nullopt;
}

// The words are printed after the name of a method: "cnn, which cleans a Kinect".
std::string what_it_does(Learns task) {
  return std::string(task_words[static_cast<std::size_t>(task)].does);
}

/// The names are those of kinalign-learn. `summary` states where the method was published.
const std::vector<TrainedMethod>& trained_methods() {
  static const std::vector<TrainedMethod> all{
      {"refine", "ours", Learns::denoise},
      {"refine-linear",
       "ours, added to a linear answer, for people and rooms like those of the training",
       Learns::denoise},
      {"cnn", "convolutional autoencoder (Holden 2016), paired", Learns::denoise, true},
      {"cnn-manifold", "convolutional autoencoder of clean motion", Learns::denoise, true},
      {"bra", "bidirectional recurrent autoencoder (Li 2019)", Learns::denoise},
      {"bra-p", "the same, perceptual (Li 2020)", Learns::denoise},
      {"bra-p-plain", "bra-p without its second network", Learns::denoise},
      {"smoothnet", "layers along time (Zeng 2022), then the mean offset", Learns::denoise},
      {"inertial", "ours", Learns::pose},
      {"inertial-online", "ours, without later frames", Learns::pose},
      {"dip", "bidirectional recurrent network (Huang 2018)", Learns::pose},
      {"dip-512", "the same, as wide as published", Learns::pose},
      {"dip-robust", "the same, trained as ours", Learns::pose},
      {"wouda", "ridge regression over 11 frames (Wouda 2016)", Learns::pose},
      {"gated", "ours", Learns::fuse},
      {"gated-online", "ours, without later frames", Learns::fuse},
      {"bilstm", "bidirectional recurrent network (HFUT-MMD)", Learns::fuse},
      {"bilstm-kinect", "the same on a Kinect alone", Learns::fuse},
      {"bilstm-nodes", "the same on nodes alone", Learns::fuse}};
  return all;
}

const TrainedMethod* find_trained(const std::string& name) {
  return find_named(trained_methods(), name);
}

Result<void> check_data(const std::string& data, const std::string& windows) {
  if (data.empty() != windows.empty()) return {};
  return Failure(Error{"--data", 0, "a data set (--data) or a file of windows (--windows)",
                       data.empty() ? "neither" : "both"});
}

std::string rough_stream(const std::string& input, Learns task) {
  return input.empty() && task == Learns::denoise ? "kinect" : input;
}

Field input_field(std::string& input) {
  return text_flag("input",
                   "the rough stream (default: kinect; for methods that fuse: a simulated Kinect)",
                   &input, "NAME");
}

Field truth_field(std::string& truth) {
  return text_flag("truth", "the precise stream", &truth, "NAME");
}

/// The flag --nodes, for methods whose input are nodes.
Field nodes_field(std::string& nodes) {
  return text_flag("nodes",
                   "for poses and fusion: 3 to 6 of wrist_left, wrist_right, ankle_left, "
                   "ankle_right, head and, as the last, waist (default: all except head)",
                   &nodes, "NAME,NAME,...");
}

Result<void> check_task_flags(const TrainedMethod& method, const Sources& given) {
  // A flag without effect is wrong use, because the user expects an effect.
  for (const TaskFlag& one : task_flags) {
    const bool is_used =
        std::find(one.tasks.begin(), one.tasks.end(), method.task) != one.tasks.end();
    if (is_used || given.count(one.flag) == 0) continue;
    return Failure(Error{std::string("--") + one.flag, 0, one.expected, method.name + one.why});
  }
  return {};
}

Result<void> cut_windows(const WindowsWanted& wanted, Learns task, const std::string& file) {
  const bool is_denoise = task == Learns::denoise;
  // The length of a window in rows. It is also the step from one window to the next, so windows do
  // not overlap.
  const std::string length = is_denoise ? "32" : "64";
  const double rate_hz = is_denoise ? wanted.rate_hz : pose_windows_hz;
  std::vector<std::string> words{
      "dataset",  "windows",   wanted.data,  "-o",     file,
      "--force",  "--quiet",   "--length",   length,   "--step",
      length,     "--valid",   wanted.valid, "--rate", fmt::format("{:g}", rate_hz),
      "--stream", wanted.truth};
  if (!wanted.input.empty()) words.insert(words.end(), {"--stream", wanted.input});
  if (!wanted.split.empty()) words.insert(words.end(), {"--split", wanted.split});
  // Takes with the verdict "bad" would teach the model their errors, so they are left out by
  // default.
  words.insert(words.end(), {"--where", wanted.where.empty() ? "verdict <> 'bad'" : wanted.where});
  const Ended ended = KA_TRY(run_own_process(words));
  if (ended.code == 0) return {};
  std::string why = ended.complaint;  // begins with "kinalign dataset windows: "
  // Users of `train` and `eval` did not call `kinalign dataset windows`, so this name is removed
  // from the error.
  if (const auto end = why.find(": "); end != std::string::npos) why = why.substr(end + 2);
  while (!why.empty() && why.back() == '\n') why.pop_back();
  return Failure(Error{wanted.data, 0, "a data set to cut windows from", why});
}

Result<void> train_in(const std::string& folder, Json job, const std::string& model, Call& call) {
  KA_TRY(make_folders(folder));
  job.update({{"out", model},
              {"log", folder + "/log.csv"},
              {"checkpoint", folder + "/checkpoint.safetensors"},
              // If a training was stopped, it continues from its checkpoint.
              {"resume", true},
              {"threads", call.jobs}});
  const std::string file = folder + "/job.json";
  KA_TRY(write_whole(call.surroundings.files, file, job.dump(1), Overwrite::yes));
  KA_TRY(run_worker(file, {.progress = call.console.progress()}));
  return {};
}

Result<std::string> trained_model(const TrainingWanted& wanted, Call& call) {
  const std::string model = wanted.folder + "/model.safetensors";
  std::error_code fault;
  // The folder's name depends on everything that changes the model, so an existing model is the
  // right one.
  if (std::filesystem::exists(model, fault)) return model;
  Json job = begun_job(wanted, call);
  job["options"]["seed"] = wanted.seed;
  if (wanted.steps > 0) job["options"]["steps"] = wanted.steps;
  KA_TRY(train_in(wanted.folder, std::move(job), model, call));
  return model;
}

Result<std::vector<std::string>> rows_of_model(const TrainingWanted& wanted,
                                               const std::string& model, Call& call) {
  KA_TRY(make_folders(wanted.folder));
  Json job = begun_job(wanted, call);
  job["evaluate"] = model;
  // The job of the training is kept, so this job gets another file name.
  const std::string file = wanted.folder + "/marks.json";
  KA_TRY(write_whole(call.surroundings.files, file, job.dump(1), Overwrite::yes));
  std::vector<std::string> out;
  KA_TRY(run_worker(file, {.progress = call.console.progress(),
                           .row = [&](const std::string& row) { out.push_back(row); }}));
  return out;
}

}  // namespace kinalign
