// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"
#include "apps/kinalign/dataset/own_process.h"
#include "apps/kinalign/learn/worker.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/core/hash.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <filesystem>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

enum class Learns : std::uint8_t { denoise, pose, fuse };

struct TrainWord {
  std::string_view method;
  Learns task;
};

/// Methods by the names that kinalign-learn knows them by.
constexpr std::array<TrainWord, 17> train_words{{{"refine", Learns::denoise},
                                                 {"cnn", Learns::denoise},
                                                 {"cnn-manifold", Learns::denoise},
                                                 {"bra", Learns::denoise},
                                                 {"bra-p", Learns::denoise},
                                                 {"smoothnet", Learns::denoise},
                                                 {"inertial", Learns::pose},
                                                 {"inertial-online", Learns::pose},
                                                 {"dip", Learns::pose},
                                                 {"dip-512", Learns::pose},
                                                 {"dip-robust", Learns::pose},
                                                 {"wouda", Learns::pose},
                                                 {"gated", Learns::fuse},
                                                 {"gated-online", Learns::fuse},
                                                 {"bilstm", Learns::fuse},
                                                 {"bilstm-kinect", Learns::fuse},
                                                 {"bilstm-nodes", Learns::fuse}}};

constexpr double pose_windows_hz = 60.0;  // nodes are simulated from it

struct Train {
  std::vector<std::string> method;
  std::string data, windows, split, where;
  std::string from, input, truth = "mocap", nodes, device = "cpu";
  double rate_hz = 30.0, hand_weight = 0.0;
  std::int64_t steps = 0, seed = 1, patience = 0;
  bool resume = false;
};

Learns task_of(const Train& o) {
  const auto word = std::find_if(train_words.begin(), train_words.end(), [&](const TrainWord& one) {
    return one.method == o.method.front();
  });
  return word == train_words.end() ? Learns::denoise : word->task;
}

/// The rough stream: a Kinect's, unless the method sees none or a simulated one.
std::string input_of(const Train& o) {
  return o.input.empty() && task_of(o) == Learns::denoise ? "kinect" : o.input;
}

/// Fails for a flag that the method has no use for.
Result<void> check_task(const Train& o, const Sources& given) {
  const Learns task = task_of(o);
  if (task == Learns::denoise && given.count("nodes") > 0) {
    return Failure(Error{"--nodes", 0, "a method for poses or for fusion", o.method.front()});
  }
  if (task != Learns::denoise && given.count("hand-weight") > 0) {
    return Failure(Error{"--hand-weight", 0, "a method that cleans a Kinect", o.method.front()});
  }
  if (task == Learns::pose && given.count("input") > 0) {
    return Failure(Error{"--input", 0, "a method that sees a Kinect",
                         o.method.front() + ", which sees simulated nodes"});
  }
  if (task != Learns::denoise && given.count("rate") > 0) {
    return Failure(Error{"--rate", 0, "a method that cleans a stream",
                         o.method.front() + ", which works at 30 Hz"});
  }
  return {};
}

Usage describe_train(Train& o) {
  Usage usage;
  usage.positionals = {{"METHOD", "what is trained", &o.method}};
  for (const TrainWord& one : train_words) {
    usage.positionals.front().choices.emplace_back(one.method);
  }
  usage.flags = {
      {"data", "the data set's folder", &o.data, 0.0, 0.0, {}, "FOLDER"},
      {"windows", "a file of windows in its place", &o.windows, 0.0, 0.0, {}, "FILE"},
      {"split",
       "of the data set: its parts train and validation are used",
       &o.split,
       0.0,
       0.0,
       {},
       "FILE"},
      {"where",
       "of the data set: a condition as dataset query has it",
       &o.where,
       0.0,
       0.0,
       {},
       "SQL"},
      {"input",
       "the rough stream (default: kinect; of a method that fuses: a simulated Kinect)",
       &o.input,
       0.0,
       0.0,
       {},
       "NAME"},
      {"truth", "the precise stream", &o.truth, 0.0, 0.0, {}, "NAME"},
      {"nodes",
       "of poses and fusion: 3 to 6 of waist, which is the last, wrist_left, wrist_right, "
       "ankle_left, ankle_right, head (default: all but the head)",
       &o.nodes,
       0.0,
       0.0,
       {},
       "NAME,NAME,..."},
      {"rate", "frames a second that the model works at", &o.rate_hz, 1.0, 1000.0, {}, "HZ"},
      {"from",
       "a model of the same method to go on from, such as one that comes with the program",
       &o.from,
       0.0,
       0.0,
       {},
       "MODEL"},
      {"hand-weight",
       "of wrists and hands in the loss, beside 1 for other joints; 0: the method's own",
       &o.hand_weight, 0.0, 100.0},
      {"steps", "batches; 0: the method's own number", &o.steps, 0.0, 1e8},
      {"seed", "of everything that is random", &o.seed, 0.0, 1e9},
      {"patience", "judgements without a better one before it stops; 0: never", &o.patience, 0.0,
       1e6},
      {"device", "where it is trained", &o.device, 0.0, 0.0, {"cpu", "cuda"}},
      {"resume", "go on with a run that was stopped", &o.resume}};
  usage.check = [&o](const Common& common, const Sources& given) -> Result<void> {
    KA_TRY(check_task(o, given));
    if (!common.out.ends_with(".safetensors")) {
      return Failure(
          Error{"-o", 0, "-o FILE.safetensors", common.out.empty() ? "none" : shown(common.out)});
    }
    if (o.data.empty() == o.windows.empty()) {
      return Failure(Error{"--data", 0, "a data set (--data) or a file of windows (--windows)",
                           o.data.empty() ? "neither" : "both"});
    }
    return {};
  };
  return usage;
}

/// The folder of a run, beside its model: "m.training" of "m.safetensors".
std::string run_folder(const std::string& model) {
  return model.substr(0, model.rfind('.')) + ".training";
}

Result<void> make_windows(const Train& o, const std::string& file) {
  const bool is_denoise = task_of(o) == Learns::denoise;
  const std::string length = is_denoise ? "32" : "64", input = input_of(o);
  const double rate_hz = is_denoise ? o.rate_hz : pose_windows_hz;
  std::vector<std::string> words{
      "dataset",  "windows", o.data,     "-o",     file,
      "--force",  "--quiet", "--length", length,   "--step",
      length,     "--valid", "0.2",      "--rate", fmt::format("{:g}", rate_hz),
      "--stream", o.truth};
  if (!input.empty()) words.insert(words.end(), {"--stream", input});
  if (!o.split.empty()) words.insert(words.end(), {"--split", o.split});
  if (!o.where.empty()) words.insert(words.end(), {"--where", o.where});
  const Ended ended = KA_TRY(run_own_process(words));
  if (ended.code == 0) return {};
  return Failure(Error{o.data, 0, "a data set that windows can be cut from", ended.complaint});
}

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

Result<std::string> hash_of(FileSystem& files, const std::string& path) {
  InputFile in = KA_TRY(InputFile::open(files, path));
  Sha256 hash;
  for (;;) {
    const std::string_view piece = KA_TRY(in.next());
    if (piece.empty()) return hash.hex();
    hash.update(piece);
  }
}

/// `hash`, `from_hash`: of the windows, and of the model that it goes on from.
Json job_of(const Train& o, const std::string& windows, const std::string& hash,
            const std::string& from_hash, Call& call) {
  const std::string folder = run_folder(call.common.out);
  Json options{{"seed", o.seed}};
  if (o.steps > 0) options["steps"] = o.steps;
  if (o.patience > 0) options.update({{"patience", o.patience}, {"judge_every", 100}});
  Json job{{"schema", "kinalign.training_job/1"}, {"method", o.method.front()}};
  if (!input_of(o).empty()) job["input"] = input_of(o);
  job["truth"] = o.truth;
  job["options"] = options;
  if (o.hand_weight > 0.0) job["hand_weight"] = o.hand_weight;
  if (!o.nodes.empty()) job["nodes"] = split_at_commas(o.nodes);
  if (!from_hash.empty()) job["from_sha256"] = from_hash;
  Sha256 identity;
  identity.update(job.dump());
  identity.update(hash);
  job["identity"] = identity.hex();  // the same wherever the files lie
  if (!o.from.empty()) job["from"] = o.from;
  job["windows"] = windows;
  job["out"] = call.common.out;
  job["log"] = folder + "/log.csv";
  job["checkpoint"] = folder + "/checkpoint.safetensors";
  job["resume"] = o.resume;
  job["device"] = o.device;
  job["threads"] = call.jobs;
  return job;
}

/// `last`: what the program that trains said at its end.
void print_trained(const Train& o, const Json& last, Call& call) {
  std::string text =
      fmt::format("{}: trained, loss {:.4g}", o.method.front(), last.value("loss", 0.0));
  if (last.contains("judgement")) {
    text += fmt::format(", {:.4g} on the validation part", last.at("judgement").get<double>());
  }
  text += fmt::format("\nlog      {}/curves.svg, log.csv, events for TensorBoard beside them\n",
                      harmless(run_folder(call.common.out)));
  call.console.print(text);
  call.console.print_json(last.dump(1));
}

Result<int> run_train(Train& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  const std::string& out = call.common.out;
  std::error_code fault;
  if (fs::exists(out, fault) && !call.common.force) {
    return Failure(Error{out, 0, "no file of that name (--force overwrites)", "one"});
  }
  const std::string folder = run_folder(out);
  KA_TRY(make_folders(folder));
  std::string windows = o.windows;
  if (windows.empty()) {
    windows = folder + "/windows.npz";
    KA_TRY(make_windows(o, windows));
  }
  const std::string from_hash = o.from.empty() ? "" : KA_TRY(hash_of(files, o.from));
  const Json job = job_of(o, windows, KA_TRY(hash_of(files, windows)), from_hash, call);
  const std::string job_file = folder + "/job.json";
  KA_TRY(write_whole(files, job_file, job.dump(1), Overwrite::yes));
  const WorkerWatch watch{.progress = call.console.progress(),
                          .warn = [&](const std::string& text) {
                            call.console.note("kinalign train: warning: " + harmless(text));
                          }};
  const Json last = Json::parse(KA_TRY(run_worker(job_file, watch)), nullptr, false);
  if (o.windows.empty()) fs::remove(windows, fault);
  call.console.wrote(out);
  print_trained(o, last, call);
  return 0;
}

}  // namespace

Verb train_verb() {
  return make_verb<Train>(
      {.name = "train",
       .summary = "a model from a data set",
       .text =
           "Trains a network and writes one SafeTensors file, which denoise, pose or fuse reads "
           "and PyTorch and NumPy open. refine, cnn, cnn-manifold, bra, bra-p and smoothnet "
           "clean a Kinect; inertial, inertial-online, dip, dip-512, dip-robust and wouda answer "
           "nodes with a pose; "
           "gated, gated-online and bilstm answer a Kinect and nodes together. The last two "
           "kinds learn from a skeleton alone. The same seed gives the same weights on the "
           "same machine. A run that was stopped goes on with --resume. The program "
           "kinalign-learn does the work; it is built where LibTorch is installed.",
       .examples =
           {{"kinalign train refine --data walks -o denoise.safetensors",
             "a network that cleans a Kinect, from the pairs of a data set"},
            {"kinalign train bra --data walks --split walks/splits/people.json -o bra.safetensors "
             "--patience 10",
             "stops when the validation part gets no better"},
            {"kinalign train inertial --data walks -o pose.safetensors",
             "a network that answers five nodes with a pose"},
            {"kinalign train gated --data walks -o fuse.safetensors",
             "a network for a Kinect and nodes together"},
            {"kinalign train refine --data own --from models/denoise.safetensors -o "
             "own.safetensors",
             "the model that comes with the program, fitted to one's own takes"}},
       .common = {"out", "force", "json", "jobs"}},
      describe_train, run_train);
}

}  // namespace kinalign
