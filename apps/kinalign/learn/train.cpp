// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"
#include "apps/cli/field_text.h"
#include "apps/kinalign/dataset/share.h"
#include "apps/kinalign/learn/shipped_models.h"
#include "apps/kinalign/learn/training_job.h"
#include "apps/kinalign/learn/worker.h"
#include "apps/kinalign/live/live_words.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/core/handle.h"
#include "kinalign/core/hash.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/file.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// The options of `kinalign train`. An empty text or 0 means the method's default.
struct Train {
  std::vector<std::string> method;
  std::string data, windows, split, where;
  std::string from, input, truth = "mocap", nodes, device = "cpu";
  double rate_hz = 30.0, hand_weight = 0.0, vary_speed = 0.0, vary_size = 0.0;
  std::int64_t steps = 0, seed = 1, patience = 0, processes = 1;
  bool resume = false, prepare = false;
};

/// The method that the command names. The parser has refused unknown names.
const TrainedMethod& method_of(const Train& o) { return *find_trained(o.method.front()); }

/// The command line of `kinalign train`, with checks that concern several flags.
Usage describe_train(Train& o) {
  Usage usage;
  usage.positionals = {{"METHOD", "method to train", &o.method}};
  for (const TrainedMethod& one : trained_methods()) {
    usage.positionals.front().choices.push_back(one.name);
  }
  usage.flags = {
      text_flag("data", "the data set's folder", &o.data, "FOLDER"),
      text_flag("windows", "a file of windows instead of a data set", &o.windows, "FILE"),
      text_flag("split", "a split of the data set: its parts train and validation are used",
                &o.split, "FILE"),
      text_flag("where",
                "use only takes of the data set that meet this condition, as in dataset query "
                "(default: takes whose verdict is not bad)",
                &o.where, "SQL"),
      input_field(o.input),
      truth_field(o.truth),
      nodes_field(o.nodes),
      {"rate", "frames per second of the model", &o.rate_hz, 1.0, 1000.0, {}, "HZ"},
      text_flag(
          "from",
          "a model of the same method to continue from: a file, or the name of a shipped model",
          &o.from, "MODEL"),
      {"hand-weight",
       "weight of wrists and hands in the loss, where other joints have 1; 0: the method's default",
       &o.hand_weight, 0.0, 100.0},
      {"vary-speed",
       "for poses and fusion: vary the speed of the training motion by up to this fraction",
       &o.vary_speed, 0.0, 1.0},
      {"vary-size",
       "for poses and fusion: vary the size of the training people by up to this fraction",
       &o.vary_size, 0.0, 1.0},
      {"steps", "batches; 0: the method's default", &o.steps, 0.0, 1e8},
      {"seed", "seed of all random numbers", &o.seed, 0.0, 1e9},
      {"patience", "stop after this many validations without improvement; 0: never", &o.patience,
       0.0, 1e6},
      choice_flag("device", "device to train on", &o.device, {"cpu", "cuda"}),
      {"processes",
       "number of processes of this machine that train together, with the same result as one",
       &o.processes, 1.0, 32.0},
      {"resume", "continue a stopped run", &o.resume},
      {"prepare", "write the job and its windows for another machine, without training",
       &o.prepare}};
  usage.check = [&o](const Common& common, const Sources& given) -> Result<void> {
    KA_TRY(check_task_flags(method_of(o), given));
    KA_TRY(check_out(common, {".safetensors"}, "-o FILE.safetensors"));
    return check_data(o.data, o.windows);
  };
  return usage;
}

/// The folder of a run, beside its model: "m.training" for "m.safetensors". It contains everything
/// but the model: job, log, curves, checkpoint and lock.
std::string run_folder(const std::string& model) {
  return model.substr(0, model.rfind('.')) + ".training";
}

/// The SHA-256 of a file, in hexadecimal digits.
Result<std::string> hash_of(FileSystem& files, const std::string& path) {
  InputFile in = KA_TRY(InputFile::open(files, path));
  Sha256 hash;
  for (;;) {
    const std::string_view piece = KA_TRY(in.next());
    if (piece.empty()) return hash.hex();
    hash.update(piece);
  }
}

/// Makes the JSON of the job file. `hash`: the SHA-256 of the windows. `from_hash`: that of the
/// model whose training is continued. The identity is a hash of all that changes the result, so
/// that --resume can refuse another training.
Json job_of(const Train& o, const std::string& windows, const std::string& hash,
            const std::string& from_hash, Call& call) {
  const std::string folder = run_folder(call.common.out);
  // Options with their defaults are not stated in the job.
  Json options{{"seed", o.seed}};
  if (o.steps > 0) options["steps"] = o.steps;
  if (o.patience > 0) options.update({{"patience", o.patience}, {"judge_every", 100}});
  Json job{{"schema", "kinalign.training_job/1"}, {"method", o.method.front()}};
  // Some methods have no input stream; nodes and a Kinect are then simulated from the mocap.
  const std::string input = rough_stream(o.input, method_of(o).task);
  if (!input.empty()) job["input"] = input;
  job["truth"] = o.truth;
  job["options"] = options;
  if (o.hand_weight > 0.0) job["hand_weight"] = o.hand_weight;
  if (!o.nodes.empty()) job["nodes"] = split_at_commas(o.nodes);
  if (o.vary_speed > 0.0) job["vary_speed"] = o.vary_speed;
  if (o.vary_size > 0.0) job["vary_size"] = o.vary_size;
  if (!from_hash.empty()) job["from_sha256"] = from_hash;
  job["identity"] = sha256_of(job.dump() + hash);  // the same in all folders
  // The members below do not belong to the identity: they say where files are and how to run.
  if (!o.from.empty()) job["from"] = o.from;
  job["windows"] = windows;
  job["out"] = call.common.out;
  job["log"] = folder + "/log.csv";
  job["checkpoint"] = folder + "/checkpoint.safetensors";
  job["resume"] = o.resume;
  job["device"] = o.device;
  return job;
}

/// The processes of one training, and those that run on this machine. Process 0 waits at `address`
/// and `port` for all others. A training with one process needs neither.
struct Places {
  std::size_t first = 0, here = 1, all = 1;  // numbers first to first + here - 1 of `all` run here
  std::string address, interface {};         // of process 0; empty if it is alone
  std::int64_t port = 0;

  bool is_first() const { return first == 0; }
};

// The port if the variable MASTER_PORT is empty.
constexpr std::int64_t usual_port = 29500;  // PyTorch's default

Result<std::int64_t> port_of(const std::string& text) {
  if (text.empty()) return usual_port;
  if (const auto port = parse_port(text)) return *port;
  return Failure(Error{"MASTER_PORT", 0, "a TCP port", shown(text)});
}

/// The processes that --processes asks for, or those that srun, mpirun or torchrun state in
/// environment variables.
Result<Places> places_of(const Train& o, Call& call) {
  const auto& variable = call.surroundings.variable;
  const BuildShare step = KA_TRY(step_share_of(variable));
  const auto processes = static_cast<std::size_t>(o.processes);
  // Without a cluster and without --processes one process trains alone.
  if (step.size == 1 && processes == 1) return Places{};
  if (step.size == 1) return Places{0, processes, processes, "127.0.0.1", "", KA_TRY(free_port())};
  const std::string address = variable("MASTER_ADDR");
  const std::string who = fmt::format("process {} of {}", step.rank, step.size);
  if (address.empty()) {
    return Failure(Error{"MASTER_ADDR", 0,
                         "the address of the first process's machine in the environment",
                         "no address in " + who});
  }
  // On a cluster the starter decides how many processes there are, so --processes could contradict
  // it.
  if (processes > 1) return Failure(Error{"--processes", 0, "1 in each process of a cluster", who});
  // Without --windows each process would cut windows, and all at the same time into the same
  // folder.
  if (o.windows.empty()) {
    return Failure(
        Error{"--data", 0, "a file of windows (--windows) that all processes read", who});
  }
  return Places{step.rank,
                1,
                step.size,
                address,
                variable("GLOO_SOCKET_IFNAME"),
                KA_TRY(port_of(variable("MASTER_PORT")))};
}

/// Writes a job file for each process on this machine and returns the names of the files. The jobs
/// differ only in the number of the process; windows, output and identity are the same.
Result<std::vector<std::string>> write_jobs(Json job, const Places& places, Call& call) {
  const std::string folder = run_folder(call.common.out);
  // The processes of this machine share its threads.
  job["threads"] = std::max<std::size_t>(call.jobs / places.here, 1);
  std::vector<std::string> out;
  for (std::size_t rank = places.first; rank < places.first + places.here; ++rank) {
    if (places.all > 1) {
      job["place"] = {{"rank", rank},
                      {"size", places.all},
                      {"address", places.address},
                      {"port", places.port},
                      {"interface", places.interface}};
    }
    out.push_back(rank == 0 ? folder + "/job.json" : fmt::format("{}/job.{}.json", folder, rank));
    KA_TRY(write_whole(call.surroundings.files, out.back(), job.dump(1), Overwrite::yes));
  }
  return out;
}

/// Prints the result of a training. `last`: the last line of kinalign-learn. The line about
/// judgement is printed only if the windows have a validation part.
void print_trained(const Train& o, const Json& last, Call& call) {
  std::string text =
      fmt::format("{}: trained, loss {:.4g}", o.method.front(), last.value("loss", 0.0));
  if (last.contains("judgement")) {
    text += fmt::format(", {:.4g} on the validation part", last.at("judgement").get<double>());
  }
  text += fmt::format("\nlog      {}/curves.svg, log.csv, events for TensorBoard\n",
                      harmless(run_folder(call.common.out)));
  call.console.print(text);
  call.console.print_json(last.dump(1));
}

/// Prints the files that another machine needs, and the command to run there. The jobs have the
/// paths that the user typed, so the files must have the same paths on that machine.
void print_prepared(const Train& o, const std::vector<std::string>& jobs,
                    const std::string& windows, Call& call) {
  std::string text = harmless(windows) + ": windows\n";
  if (!o.from.empty()) text += harmless(o.from) + ": the model to continue from\n";
  for (const std::string& job : jobs) text += harmless(job) + ": a job\n";
  text += "Copy these files to the other machine, with the same names, and run there:\n";
  for (const std::string& job : jobs) text += "  kinalign-learn " + harmless(job) + "\n";
  call.console.print(text);
  call.console.print_json(Json{{"windows", windows}, {"jobs", jobs}}.dump(1));
}

/// The file of windows that the user gave. Without one, windows are cut from the data set into the
/// run's folder.
Result<std::string> windows_of(const Train& o, const std::string& folder) {
  if (!o.windows.empty()) return o.windows;
  std::string file = folder + "/windows.npz";
  const WindowsWanted wanted{.data = o.data,
                             .split = o.split,
                             .where = o.where,
                             .input = rough_stream(o.input, method_of(o).task),
                             .truth = o.truth,
                             .rate_hz = o.rate_hz};
  // The lock protects the run's folder, so no other training writes windows there.
  KA_TRY(cut_windows(wanted, method_of(o).task, file));
  return file;
}

/// Runs kinalign-learn with all jobs and returns its last line. Afterwards only the job file of the
/// first process is kept.
Result<Json> run_jobs(const std::vector<std::string>& jobs, Call& call) {
  // All processes do the same steps at the same time, so only the first one reports progress.
  const WorkerWatch watch{.progress = call.console.progress(),
                          .warn = [&](const std::string& text) {
                            call.console.note("kinalign train: warning: " + harmless(text));
                          }};
  Json last = Json::parse(KA_TRY(run_workers(jobs, watch)), nullptr, false);
  std::error_code fault;
  for (const std::string& file : jobs) {
    if (!file.ends_with("/job.json")) fs::remove(file, fault);
  }
  return last;
}

/// Locks the folder, so that no other training uses it. The system removes the lock when the file
/// is closed, even if this program crashes. The file "lock" may therefore stay.
Result<Handle> locked(const std::string& folder) {
  Handle file(::open((folder + "/lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644));
  // With LOCK_NB a second training does not wait but fails at once.
  if (file.fd() >= 0 && ::flock(file.fd(), LOCK_EX | LOCK_NB) == 0) return file;
  return Failure(Error{folder, 0, "a folder that no other training uses now",
                       file.fd() < 0 ? std::strerror(errno) : "another training in this folder"});
}

/// Makes the run's folder, which all processes share. The first process locks it.
Result<Handle> open_folder(const Train& o, const std::string& folder, const Places& places,
                           Call& call) {
  KA_TRY(make_folders(folder));
  Handle out;
  // Other processes of the same training use the same folder, so only the first one locks it.
  if (places.is_first()) out = KA_TRY(locked(folder));
  std::error_code fault;
  if (o.resume && !fs::exists(folder + "/checkpoint.safetensors", fault)) {
    call.console.note("kinalign train: no checkpoint in " + harmless(folder) +
                      ": the training starts from the beginning");
  }
  return out;
}

/// Writes the job files. If --from names a model that comes with kinalign, its file is found first.
Result<std::vector<std::string>> jobs_of(Train& o, const std::string& windows, const Places& places,
                                         Call& call) {
  FileSystem& files = call.surroundings.files;
  if (!o.from.empty()) o.from = KA_TRY(model_named(o.from, ""));
  const std::string from_hash = o.from.empty() ? "" : KA_TRY(hash_of(files, o.from));
  // The hash is that of the file's bytes, so the job is the same on every machine with this file.
  const std::string hash = KA_TRY(hash_of(files, windows));
  return write_jobs(job_of(o, windows, hash, from_hash, call), places, call);
}

/// Trains a model. Only the first of several processes prints the result and removes windows that
/// were cut for this run.
Result<int> run_train(Train& o, Call& call) {
  const std::string& out = call.common.out;
  std::error_code fault;
  // A training may take days, so the output is checked before it.
  if (fs::exists(out, fault) && !call.common.force) {
    return Failure(
        Error{out, 0, "no file of that name (--force overwrites)", "a file of that name"});
  }
  const Places places = KA_TRY(places_of(o, call));
  const std::string folder = run_folder(out);
  const auto lock = KA_TRY(open_folder(o, folder, places, call));
  const std::string windows = KA_TRY(windows_of(o, folder));
  const auto jobs = KA_TRY(jobs_of(o, windows, places, call));
  if (o.prepare) {
    print_prepared(o, jobs, windows, call);
    return 0;
  }
  const Json last = KA_TRY(run_jobs(jobs, call));
  // Process 0 writes the model. The other starters of a cluster print nothing.
  if (!places.is_first()) return 0;
  // Windows that the user gave are never removed.
  if (o.windows.empty()) fs::remove(windows, fault);
  call.console.wrote(out);
  print_trained(o, last, call);
  return 0;
}

}  // namespace

/// The verb `kinalign train`.
Verb train_verb() {
  return make_verb<Train>(
      {.name = "train",
       .summary = "train a model from a data set",
       .text =
           "Trains a network and writes one SafeTensors file. denoise, pose and fuse read this "
           "file; PyTorch and NumPy open it. refine, cnn, cnn-manifold, bra, bra-p, bra-p-plain "
           "and smoothnet clean a Kinect; inertial, inertial-online, dip, dip-512, dip-robust and "
           "wouda compute a pose from nodes; gated, gated-online and bilstm from a Kinect and "
           "nodes together. The last two kinds need only skeletons for training. The same seed "
           "gives the same weights on the same machine. --resume continues a stopped run. The "
           "program kinalign-learn does the work; it is built if LibTorch is installed.",
       .examples =
           {{"kinalign train refine --data walks -o denoise.safetensors",
             "a network that cleans a Kinect, from the pairs of a data set"},
            {"kinalign train bra --data walks --split walks/splits/people.json -o bra.safetensors "
             "--patience 10",
             "stops when the validation part no longer improves"},
            {"kinalign train inertial --data walks -o pose.safetensors",
             "a network that computes a pose from five nodes"},
            {"kinalign train gated --data walks -o fuse.safetensors",
             "a network for a Kinect and nodes together"},
            {"kinalign train refine --data own --from denoise -o own.safetensors",
             "the shipped model, fitted to your own takes"},
            {"kinalign train bra --data walks -o bra.safetensors --device cuda --prepare",
             "a folder bra.training for a machine with a GPU, where kinalign-learn trains"}},
       .common = {"out", "force", "json", "jobs"}},
      describe_train, run_train);
}

}  // namespace kinalign
