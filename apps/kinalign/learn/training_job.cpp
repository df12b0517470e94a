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

constexpr double pose_windows_hz = 60.0;  // the windows' rate; nodes are simulated from them

/// One row for each value of Learns, in the order of the enum: what_it_does() uses it as an index.
struct TaskWords {
  Learns task;
  std::string_view name, does;
};
constexpr std::array<TaskWords, 3> task_words{
    {{Learns::denoise, "denoise", "cleans a Kinect"},
     {Learns::pose, "pose", "computes a pose from nodes"},
     {Learns::fuse, "fuse", "computes a pose from a Kinect and nodes"}}};

/// The members that every job has.
/// `learn` and `judge` are names of takes. Members with defaults are left out.
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

// The words follow a method's name: "cnn, which cleans a Kinect".
std::string what_it_does(Learns task) {
  return std::string(task_words[static_cast<std::size_t>(task)].does);
}

/// The names are those of kinalign-learn. `summary` says where a method was published.
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

Field input_field(std::string& input) {
  return {"input", "the rough stream (default: kinect; for methods that fuse: a simulated Kinect)",
          &input,  0.0,
          0.0,     {},
          "NAME"};
}

Field truth_field(std::string& truth) {
  return {"truth", "the precise stream", &truth, 0.0, 0.0, {}, "NAME"};
}

/// The flag --nodes, for methods that get nodes.
Field nodes_field(std::string& nodes) {
  return {"nodes",
          "for poses and fusion: 3 to 6 of wrist_left, wrist_right, ankle_left, ankle_right, head "
          "and, as the last, waist (default: all except head)",
          &nodes,
          0.0,
          0.0,
          {},
          "NAME,NAME,..."};
}

/// A flag without effect is wrong use: a user would believe that it had one.
Result<void> check_task_flags(const TrainedMethod& method, const Sources& given) {
  if (method.task == Learns::denoise && given.count("nodes") > 0) {
    return Failure(Error{"--nodes", 0, "a method for poses or for fusion", method.name});
  }
  for (const char* flag : {"vary-speed", "vary-size"}) {
    if (method.task != Learns::denoise || given.count(flag) == 0) continue;
    return Failure(
        Error{std::string("--") + flag, 0, "a method for poses or for fusion", method.name});
  }
  if (method.task != Learns::denoise && given.count("hand-weight") > 0) {
    return Failure(Error{"--hand-weight", 0, "a method that cleans a Kinect", method.name});
  }
  if (method.task != Learns::denoise && given.count("own-root") > 0) {
    return Failure(Error{"--own-root", 0, "a method that cleans a Kinect", method.name});
  }
  if (method.task == Learns::pose && given.count("input") > 0) {
    return Failure(Error{"--input", 0, "a method with a Kinect as input",
                         method.name + ", whose input is simulated nodes"});
  }
  if (method.task != Learns::denoise && given.count("rate") > 0) {
    return Failure(Error{"--rate", 0, "a method that cleans a stream",
                         method.name + ", which works at 30 Hz"});
  }
  return {};
}

Result<void> cut_windows(const WindowsWanted& wanted, Learns task, const std::string& file) {
  const bool is_denoise = task == Learns::denoise;
  // The lengths are in rows; windows do not overlap, because the step is the length.
  const std::string length = is_denoise ? "32" : "64";
  const double rate_hz = is_denoise ? wanted.rate_hz : pose_windows_hz;
  std::vector<std::string> words{
      "dataset",  "windows",   wanted.data,  "-o",     file,
      "--force",  "--quiet",   "--length",   length,   "--step",
      length,     "--valid",   wanted.valid, "--rate", fmt::format("{:g}", rate_hz),
      "--stream", wanted.truth};
  if (!wanted.input.empty()) words.insert(words.end(), {"--stream", wanted.input});
  if (!wanted.split.empty()) words.insert(words.end(), {"--split", wanted.split});
  // A bad take would teach the model its faults, so it is left out unless the user says otherwise.
  words.insert(words.end(), {"--where", wanted.where.empty() ? "verdict <> 'bad'" : wanted.where});
  const Ended ended = KA_TRY(run_own_process(words));
  if (ended.code == 0) return {};
  std::string why = ended.complaint;  // "kinalign dataset windows: ..."
  // The error of the child begins with its own name, which would confuse users of `train` and
  // `eval`.
  if (const auto end = why.find(": "); end != std::string::npos) why = why.substr(end + 2);
  while (!why.empty() && why.back() == '\n') why.pop_back();
  return Failure(Error{wanted.data, 0, "a data set to cut windows from", why});
}

Result<std::string> trained_model(const TrainingWanted& wanted, Call& call) {
  const std::string model = wanted.folder + "/model.safetensors";
  std::error_code fault;
  // The name of the folder depends on everything that the model depends on, so an existing model is
  // the right one.
  if (std::filesystem::exists(model, fault)) return model;
  KA_TRY(make_folders(wanted.folder));
  Json options{{"seed", wanted.seed}};
  if (wanted.steps > 0) options["steps"] = wanted.steps;
  Json job = begun_job(wanted, call);
  job.update({{"out", model},
              {"log", wanted.folder + "/log.csv"},
              {"checkpoint", wanted.folder + "/checkpoint.safetensors"},
              // A checkpoint that was left by a stopped training is used, since the folder belongs
              // to this training alone.
              {"resume", true},
              {"options", options}});
  const std::string file = wanted.folder + "/job.json";
  KA_TRY(write_whole(call.surroundings.files, file, job.dump(1), Overwrite::yes));
  KA_TRY(run_worker(file, {.progress = call.console.progress()}));
  return model;
}

Result<std::vector<std::string>> rows_of_model(const TrainingWanted& wanted,
                                               const std::string& model, Call& call) {
  KA_TRY(make_folders(wanted.folder));
  Json job = begun_job(wanted, call);
  job["evaluate"] = model;
  // The job has another name than that of the training, which is kept.
  const std::string file = wanted.folder + "/marks.json";
  KA_TRY(write_whole(call.surroundings.files, file, job.dump(1), Overwrite::yes));
  std::vector<std::string> out;
  KA_TRY(run_worker(file, {.progress = call.console.progress(),
                           .row = [&](const std::string& row) { out.push_back(row); }}));
  return out;
}

// The text "" gives one empty name.
std::vector<std::string> split_at_commas(const std::string& text) {
  std::vector<std::string> out{""};
  for (const char c : text) {
    if (c == ',') {
      out.emplace_back();
    } else {
      out.back() += c;
    }
  }
  return out;
}

}  // namespace kinalign
