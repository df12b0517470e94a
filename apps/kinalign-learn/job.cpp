// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign-learn/job.h"

#include "apps/kinalign-learn/marks.h"

#include "kinalign/core/files.h"
#include "kinalign/core/find_named.h"
#include "kinalign/core/hash.h"
#include "kinalign/learn/checkpoint.h"
#include "kinalign/learn/fit_denoise.h"
#include "kinalign/learn/fuse/fit_fuse.h"
#include "kinalign/learn/loss_curve.h"
#include "kinalign/learn/methods/methods.h"
#include "kinalign/learn/pose/fit_pose.h"
#include "kinalign/learn/projection.h"
#include "kinalign/models/model_file.h"
#include "kinalign/models/windows_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <limits>
#include <optional>
#include <set>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

// Shorter stretches of frames are left out. docs/training.md states this limit.
constexpr std::size_t least_rows = 8;  // frames

/// Reads a whole file (a model, windows or a checkpoint) into memory.
Result<std::string> bytes_of(const std::string& path) {
  PosixFiles files;
  return read_whole(files, path, std::numeric_limits<std::size_t>::max());
}

/// Writes a file so that a kill meanwhile leaves the complete old file or the complete new one.
Result<void> write_file(const std::string& path, const std::string& bytes) {
  PosixFiles files;
  return write_whole(files, path, bytes, Overwrite::yes);
}

/// The default settings of a method of any task.
Result<TrainingOptions> options_of(const std::string& method, const std::string& name) {
  const auto denoise = denoise_methods();
  const auto pose = pose_methods();
  const auto fuse = fuse_methods();
  if (const auto* found = find_named(denoise, method)) return found->options;
  if (const auto* found = find_named(pose, method)) return found->options;
  if (const auto* found = find_named(fuse, method)) return found->options;
  return Failure(Error{name, 0, "a known method", method});
}

/// Sets gentle options for continuing a trained model: a fifth of the learning rate and at most 300
/// steps. The model then forgets little of the earlier data.
void go_on_gently(TrainingOptions& options) {
  options.rate *= 0.2;
  options.steps = std::min<std::int64_t>(options.steps, 300);
}

ProcessPlace place_of(const Json& json) {
  return {.rank = json.at("rank").get<std::int64_t>(),
          .size = json.at("size").get<std::int64_t>(),
          .address = json.at("address").get<std::string>(),
          .port = json.at("port").get<std::uint16_t>(),
          .interface = json.value("interface", "")};
}

/// Reads the options that a job may set. All other options are fixed by the method.
void read_options(const Json& json, TrainingOptions& out) {
  out.steps = json.value("steps", out.steps);
  out.rate = json.value("rate", out.rate);
  out.seed = json.value("seed", out.seed);
  out.judge_every = json.value("judge_every", out.judge_every);
  out.patience = json.value("patience", out.patience);
}

/// Writes the log of the training in three files: CSV, a curve and events for TensorBoard. Each
/// file is written anew from all points, so the log of a continued run is complete.
Result<void> save_log(const TrainingJob& job, const std::vector<TrainingPoint>& points) {
  if (job.log.empty()) return {};
  KA_TRY(write_file(job.log, csv_of(points)));
  const auto folder = std::filesystem::path(job.log).parent_path();
  KA_TRY(write_file(folder / "curves.svg", loss_curve(points, job.method)));
  return write_file(folder / "events.out.tfevents.0.kinalign", events_of(points));
}

/// Prints progress as JSON lines: at most two a second, and always the last one. The returned
/// function is called after each training step, which may take only milliseconds.
Progress progress_lines() {
  using Clock = std::chrono::steady_clock;
  auto last = std::make_shared<Clock::time_point>();
  return [last](std::string_view what, std::uint64_t done, std::uint64_t total) {
    const auto now = Clock::now();
    if (done != total && now - *last < std::chrono::milliseconds(500)) return true;
    *last = now;
    std::cout << Json{{"what", what}, {"done", done}, {"total", total}}.dump() << std::endl;
    // `kinalign train` reads these lines. If it has ended, the pipe is broken and the training
    // stops.
    return static_cast<bool>(std::cout);  // false: stop
  };
}

/// Counts of the training data. The model's file states them, so that a reader knows on how much
/// data the model was trained.
struct LearntFrom {
  std::size_t stretches = 0, frames = 0;
  std::set<std::string> subjects;

  void add(const std::string& subject, std::size_t count) {
    ++stretches;
    frames += count;
    subjects.insert(subject);
  }
};

/// Writes into the model's facts which data and which settings it was trained with. `before`: the
/// same facts of the model whose training was continued; "" if there is none.
void state_training(const TrainingJob& job, const WindowsFacts& facts, const LearntFrom& from,
                    const std::string& before, ModelFacts& model) {
  // The data's name, licence and hash are stored beside the weights, so that the model's origin can
  // be checked.
  Json out{{"data",
            {{{"name", facts.dataset},
              {"licence", facts.licence},
              {"citation", facts.citation},
              {"windows_sha256", job.windows_sha256},
              {"stretches", from.stretches},
              {"frames", from.frames},
              {"subjects", from.subjects}}}},
           {"steps", job.options.steps},
           {"rate", job.options.rate},
           {"seed", job.options.seed},
           {"identity", job.identity}};
  if (job.hand_weight > 0.0) out["hand_weight"] = job.hand_weight;
  if (job.vary_speed > 0.0) out["vary_speed"] = job.vary_speed;
  if (job.vary_size > 0.0) out["vary_size"] = job.vary_size;
  // The facts of the earlier model are nested here, because its data, too, shaped the weights.
  if (!job.from.empty()) out["from"] = Json::parse(before, nullptr, false);
  model.software = "kinalign " KINALIGN_VERSION;
  model.training = out.dump();
}

/// Reads the model whose training is continued. Empty if the job names no model. Fails if that
/// model has another method.
template <class Model, class Read>
Result<std::optional<Model>> model_before(const TrainingJob& job, Read read) {
  if (job.from.empty()) return std::optional<Model>();
  // Another method has another network, into which the weights would not fit.
  Model model = KA_TRY(read(KA_TRY(bytes_of(job.from)), job.from));
  if (model.facts.method == job.method) return std::optional<Model>(std::move(model));
  return Failure(Error{job.from, 0, "a model of the method " + job.method,
                       "a model of the method " + shown(model.facts.method)});
}

/// The error if the job's network differs from the earlier model's: its weights can't be used then.
Failure cannot_go_on(const TrainingJob& job, const std::string& expected) {
  return Failure(Error{job.from, 0, expected, "another one"});
}

/// Divides pairs of input and truth by the split in the file of windows. Without a split, all pairs
/// are for training. A part with another name, such as test, is neither trained on nor used to
/// judge.
DividedPairs divide(std::vector<Pair> all) {
  DividedPairs out;
  for (Pair& pair : all) {
    if (pair.part == "validation") out.judged.push_back(std::move(pair));
    if (pair.part == "train" || pair.part == "all") out.learnt.push_back(std::move(pair));
  }
  return out;
}

/// Replaces the split of the file by the job's lists of takes: train, validation, and test for all
/// other takes. Without lists the file's split stays. `kinalign eval` and `kinalign benchmark` use
/// the lists, so that all folds share one file of windows.
void divide_by_lists(const TrainingJob& job, Windows& windows) {
  if (job.learn.empty()) return;
  const auto holds = [](const std::vector<std::string>& list, const std::string& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  windows.facts.parts = {"train", "validation", "test"};
  for (Stretch& stretch : windows.stretches) {
    const std::string& name = windows.facts.takes[stretch.take].name;
    stretch.part = holds(job.judge, name) ? 1 : holds(job.learn, name) ? 0 : 2;
  }
}

/// The result of a training: the bytes of the model's file and the points of the log. The file
/// itself is written only after all processes have finished.
struct Fitted {
  std::string model;
  std::vector<TrainingPoint> points;
};

// Each device other than "cuda" is the processor. main() has checked that there is a GPU.
FitOptions fit_options(const TrainingJob& job) {
  return {job.options, job.device == "cuda" ? torch::Device(torch::kCUDA) : torch::kCPU};
}

/// The training pairs, with the joints of the model whose training is continued, else with all
/// joints of the file.
Result<Pairs> pairs_to_learn(const TrainingJob& job, const Windows& windows,
                             const std::optional<DenoiseModel>& from) {
  if (!from) return pairs_of(windows, job.input, job.truth, least_rows);
  const DenoiseLayout& layout = from->layout;
  // A network learns speeds at one frame rate; at another rate they would be wrong.
  if (std::abs(windows.facts.rate_hz - layout.rate_hz) > 0.01 * layout.rate_hz) {
    return Failure(Error{job.windows, 0, "windows at the model's rate", "another rate"});
  }
  const Pairs joints{layout.inputs, layout.outputs, layout.rate_hz, layout.parents};
  return pairs_for(windows, job.input, job.truth, joints, least_rows);
}

/// Trains a model that cleans the joints of a Kinect.
Result<Fitted> fit_denoise_job(const TrainingJob& job, DenoiseMethod method, const Windows& windows,
                               TrainingState state, const TrainingHooks& hooks) {
  if (job.hand_weight > 0.0) method.training.loss.hands = job.hand_weight;
  const auto from = KA_TRY(model_before<DenoiseModel>(job, read_denoise_model));
  // A method with a perceptual loss has a second network. A model's file does not contain it, so
  // such a training can't be continued.
  if (from && method.perceptual) {
    return Failure(
        Error{job.from, 0, "a method with one network, to continue training", job.method});
  }
  Pairs pairs = KA_TRY(pairs_to_learn(job, windows, from));
  const DividedPairs divided = divide(std::move(pairs.all));
  DenoiseFit fit = KA_TRY(fit_denoise(method, pairs, divided, fit_options(job), std::move(state),
                                      hooks, from ? &*from : nullptr));
  LearntFrom learnt;
  for (const Pair& pair : divided.learnt) learnt.add(pair.subject, pair.input.frames());
  state_training(job, windows.facts, learnt, from ? from->facts.training : "", fit.model.facts);
  return Fitted{write_denoise_model(fit.model), std::move(fit.points)};
}

/// The random changes of the training data: the method's values, replaced by values of the job that
/// are above 0.
Variety variety_of(const TrainingJob& job, Variety own) {
  if (job.vary_speed > 0.0) own.speed = job.vary_speed;
  if (job.vary_size > 0.0) own.size = job.vary_size;
  return own;
}

/// Trains a model for poses. The first process also computes the model's marks on the test part.
Result<Fitted> fit_pose_job(const TrainingJob& job, PoseMethod method, const Windows& windows,
                            TrainingState state, const TrainingHooks& hooks) {
  method.training.variety = variety_of(job, method.training.variety);
  const auto from = KA_TRY(model_before<PoseModel>(job, read_pose_model));
  const PoseData data = KA_TRY(pose_data(windows, job.truth, job.nodes));
  // The method wouda is solved and not trained, so there is no training to continue.
  if (from && (method.begin != nullptr || from->layout.nodes != data.nodes)) {
    return cannot_go_on(job, "a network of the same nodes");
  }
  PoseFit fit = KA_TRY(
      fit_pose(method, data, fit_options(job), std::move(state), hooks, from ? &*from : nullptr));
  LearntFrom learnt;
  for (const PoseSequence& one : data.learnt) learnt.add(one.subject, one.frames());
  state_training(job, windows.facts, learnt, from ? from->facts.training : "", fit.model.facts);
  if (hooks.share.is_first()) {
    fit.model.facts.metrics = KA_TRY(pose_metrics_json(fit.model, data));
  }
  return Fitted{write_pose_model(fit.model), std::move(fit.points)};
}

/// Trains a model for fusion. The first process also computes the model's marks on the test part.
Result<Fitted> fit_fuse_job(const TrainingJob& job, FuseMethod method, const Windows& windows,
                            TrainingState state, const TrainingHooks& hooks) {
  method.training.variety = variety_of(job, method.training.variety);
  const auto from = KA_TRY(model_before<FuseModel>(job, read_fuse_model));
  const FuseData data =
      KA_TRY(fuse_data(windows, job.truth, job.nodes, fuse_options(job.input, windows)));
  if (from && from->layout != fuse_layout(data)) {
    return cannot_go_on(job, "a network of the same nodes and joints");
  }
  FuseFit fit = KA_TRY(
      fit_fuse(method, data, fit_options(job), std::move(state), hooks, from ? &*from : nullptr));
  LearntFrom learnt;
  for (const PoseSequence& one : data.pose.learnt) learnt.add(one.subject, one.frames());
  state_training(job, windows.facts, learnt, from ? from->facts.training : "", fit.model.facts);
  if (hooks.share.is_first()) {
    fit.model.facts.metrics = KA_TRY(fuse_metrics_json(fit.model, data));
  }
  return Fitted{write_fuse_model(fit.model), std::move(fit.points)};
}

/// The body with this number in a file of bodies.
Result<JointFrames> body_of(const TensorFile& file, const std::string& number, std::size_t joints,
                            const std::string& name) {
  const auto positions = file.tensors.find(number + ".positions");
  const auto seen = file.tensors.find(number + ".seen");
  JointFrames out;
  out.joints = joints;
  if (positions != file.tensors.end() && seen != file.tensors.end()) {
    out.positions = positions->second.values;
    out.seen.assign(seen->second.values.begin(), seen->second.values.end());
    if (out.positions.size() == 3 * out.seen.size() && out.seen.size() % joints == 0) return out;
  }
  return Failure(Error{name, 0, "positions and states of body " + number,
                       "no such arrays, or arrays of other sizes"});
}

/// Projects the model's answers for all bodies of a file and writes them. The last line of output
/// states the mean errors of the constraints before and after the projection.
Result<void> project_bodies(const TrainingJob& job) {
  // The projection runs in this program, because each of its steps needs gradients. They come from
  // LibTorch, which the program kinalign does not contain.
  const DenoiseModel model = KA_TRY(read_denoise_model(KA_TRY(bytes_of(job.project)), job.project));
  const TensorFile bodies = KA_TRY(read_safetensors(KA_TRY(bytes_of(job.bodies)), job.bodies));
  const std::size_t joints = model.layout.inputs.size(), count = bodies.tensors.size() / 2;
  const Progress progress = progress_lines();
  TensorFile out;
  ConstraintErrors before, after;
  // Each sum becomes the mean over all bodies of the file.
  const auto add = [&](ConstraintErrors& sum, const ConstraintErrors& one) {
    const double share = 1.0 / static_cast<double>(count);
    sum.feet_cm += share * one.feet_cm;
    sum.path_cm += share * one.path_cm;
    sum.bone_cm += share * one.bone_cm;
  };
  for (std::size_t i = 0; i < count; ++i) {
    const std::string number = std::to_string(i);
    const JointFrames body = KA_TRY(body_of(bodies, number, joints, job.bodies));
    auto projected = KA_TRY(project(model, body).map_error(in_file(job.project)));
    out.tensors[number + ".positions"] = {{body.frames(), model.layout.outputs.size(), 3},
                                          std::move(projected.answer.positions)};
    add(before, projected.before);
    add(after, projected.after);
    if (!progress("projecting", i + 1, count)) return Failure(interruption());
  }
  KA_TRY(write_file(job.out, write_safetensors(out)));
  const auto as_json = [](const ConstraintErrors& errors) {
    return Json{
        {"feet_cm", errors.feet_cm}, {"path_cm", errors.path_cm}, {"bone_cm", errors.bone_cm}};
  };
  const Json row{{"written", job.out}, {"before", as_json(before)}, {"after", as_json(after)}};
  std::cout << row.dump() << std::endl;
  return {};
}

/// Trains a model for the task of the job's method; read_job() has checked that the method exists.
/// The lists must outlive the pointers that find_named() returns.
Result<Fitted> fit_job(const TrainingJob& job, const Windows& windows, TrainingState state,
                       const TrainingHooks& hooks) {
  const auto denoise = denoise_methods();
  const auto pose = pose_methods();
  const auto fuse = fuse_methods();
  // The three lists may be searched in any order, since each name occurs in one list only.
  if (const auto* method = find_named(pose, job.method)) {
    return fit_pose_job(job, *method, windows, std::move(state), hooks);
  }
  if (const auto* method = find_named(fuse, job.method)) {
    return fit_fuse_job(job, *method, windows, std::move(state), hooks);
  }
  return fit_denoise_job(job, *find_named(denoise, job.method), windows, std::move(state), hooks);
}

}  // namespace

/// Each of the three kinds of job reads only the members that it needs.
Result<TrainingJob> read_job(const std::string& text, const std::string& name) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || json.value("schema", "") != "kinalign.training_job/1") {
    return Failure(Error{name, 0, "a job of schema kinalign.training_job/1", "another file"});
  }
  TrainingJob out;
  try {
    out.threads = json.value("threads", std::int64_t{1});
    out.project = json.value("project", "");
    if (!out.project.empty()) {
      out.bodies = json.at("bodies").get<std::string>();
      out.out = json.at("out").get<std::string>();
      return out;
    }
    out.windows = json.at("windows").get<std::string>();
    out.input = json.value("input", "");
    out.truth = json.value("truth", "mocap");
    out.nodes = json.value("nodes", usual_pose_nodes());
    if (json.contains("learn")) json.at("learn").get_to(out.learn);
    if (json.contains("judge")) json.at("judge").get_to(out.judge);
    out.evaluate = json.value("evaluate", "");
    // The file of an evaluated model states its method, so the job need not.
    if (!out.evaluate.empty()) return out;
    out.method = json.at("method").get<std::string>();
    out.out = json.at("out").get<std::string>();
    out.log = json.value("log", "");
    out.checkpoint = json.value("checkpoint", "");
    out.keep_every = json.value("keep_every", out.keep_every);
    out.resume = json.value("resume", false);
    out.device = json.value("device", "cpu");
    out.identity = json.value("identity", "");
    out.hand_weight = json.value("hand_weight", out.hand_weight);
    out.vary_speed = json.value("vary_speed", out.vary_speed);
    out.vary_size = json.value("vary_size", out.vary_size);
    out.from = json.value("from", "");
    if (json.contains("place")) out.place = place_of(json.at("place"));
    out.options = KA_TRY(options_of(out.method, name));
    // These options are set before those of the job, so that the job's options override them.
    if (!out.from.empty()) go_on_gently(out.options);
    if (json.contains("options")) read_options(json.at("options"), out.options);
  } catch (const Json::exception& fault) {
    return Failure(Error{name, 0, "a complete job", shown(fault.what())});
  }
  return out;
}

Result<void> run_job(const TrainingJob& job) {
  if (!job.project.empty()) return project_bodies(job);
  // The bytes stay in memory, so that the hash is that of exactly the bytes that were trained on.
  const std::string bytes = KA_TRY(bytes_of(job.windows));
  Windows windows = KA_TRY(read_windows(bytes, job.windows));
  divide_by_lists(job, windows);
  if (!job.evaluate.empty()) {
    return print_marks(job, windows, KA_TRY(bytes_of(job.evaluate)));
  }
  TrainingState state;
  // Without a checkpoint the training begins anew: it may have been stopped before the first
  // checkpoint.
  if (job.resume && std::filesystem::exists(job.checkpoint)) {
    state = KA_TRY(read_checkpoint(KA_TRY(bytes_of(job.checkpoint)), job.identity, job.checkpoint));
  }
  Processes processes = KA_TRY(Processes::join(job.place));
  const bool is_first = processes.share().is_first();
  // All processes must have read the old checkpoint before the first process may write a new one.
  KA_TRY(processes.agree(job.identity + " " + std::to_string(job.options.steps) + " " +
                         std::to_string(state.step)));
  TrainingHooks hooks{.keep = {}, .every = job.keep_every, .share = processes.share()};
  // The other processes print only their result and errors, no progress.
  if (is_first) hooks.progress = progress_lines();
  if (is_first && !job.checkpoint.empty()) {
    hooks.keep = [&](const TrainingState& now) {
      return write_file(job.checkpoint, write_checkpoint(now, job.identity));
    };
  }
  TrainingJob hashed = job;
  hashed.windows_sha256 = sha256_of(bytes);
  const Fitted fit = KA_TRY(fit_job(hashed, windows, std::move(state), hooks));
  // The other processes end here; they need not wait while the first one writes files.
  processes.leave();
  if (!is_first) {
    std::cout << Json{{"trained_with", job.place.size}}.dump() << std::endl;
    return {};
  }
  KA_TRY(save_log(job, fit.points));
  KA_TRY(write_file(job.out, fit.model));
  std::error_code ignored;
  // The checkpoint is removed after the model is written. If the program is killed in between, the
  // run can still be continued.
  if (!job.checkpoint.empty()) std::filesystem::remove(job.checkpoint, ignored);
  Json last{{"written", job.out}, {"loss", fit.points.empty() ? 0.0 : fit.points.back().loss}};
  if (!fit.points.empty() && fit.points.back().judgement) {
    last["judgement"] = *fit.points.back().judgement;
  }
  std::cout << last.dump() << std::endl;
  return {};
}

}  // namespace kinalign
