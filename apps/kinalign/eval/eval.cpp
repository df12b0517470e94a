// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"
#include "apps/cli/field_text.h"
#include "apps/kinalign/dataset/table_output.h"
#include "apps/kinalign/eval/eval_tables.h"
#include "apps/kinalign/learn/eval_methods.h"
#include "apps/kinalign/learn/shipped_models.h"
#include "apps/kinalign/verbs.h"
#include "apps/kinalign/verbs/describe_model.h"

#include "kinalign/core/hash.h"
#include "kinalign/models/model_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// Larger files of windows are refused.
constexpr std::size_t most_windows_bytes = std::size_t{4} << 30U;
/// Larger cached results are refused.
constexpr std::size_t most_cached_bytes = std::size_t{64} << 20U;
/// The version of cached results. After a change of this number, every result is computed again.
constexpr int cache_version = 6;
Learns task_of(const std::string& method) {
  const TrainedMethod* found = find_trained(trained_part(method));
  return found == nullptr ? Learns::denoise : found->task;
}

/// A method or model that is compared, and its task.
struct Compared {
  std::string name;  // the method's name, or the model's file
  Learns task = Learns::denoise;
};

Result<void> check_one_task(const Compared& first, const Compared& other) {
  if (first.task == other.task) return {};
  return Failure(Error{"METHOD", 0, "methods and models of one task, one table for each",
                       shown(first.name) + ", which " + what_it_does(first.task) + ", and " +
                           shown(other.name) + ", which " + what_it_does(other.task)});
}

Result<void> check_methods(const Eval& o, const Sources& given) {
  for (const std::string& method : o.methods) {
    KA_TRY(
        check_one_task({o.methods.front(), task_of(o.methods.front())}, {method, task_of(method)}));
    KA_TRY(check_task_flags({method, "", task_of(method)}, given));
  }
  return {};
}

/// The command line of `kinalign eval`, with checks that concern several flags.
Usage describe_eval(Eval& o) {
  Usage usage;
  usage.positionals = {{"METHOD", "methods (default: those that clean a Kinect without training)",
                        &o.methods, 0, 100}};
  auto& choices = usage.positionals.front().choices;
  for (const EvalMethod& method : eval_methods()) choices.push_back(method.name);
  for (const TrainedMethod& method : trained_methods()) {
    if (method.task != Learns::denoise) choices.push_back(method.name);
  }
  usage.flags = {
      text_flag("data", "the data set's folder", &o.data, "FOLDER"),
      text_flag("windows", "a file of windows instead of a data set", &o.windows, "FILE"),
      choice_flag("folds", "folds: what is left out of training and tested", &o.folds,
                  {"people", "runs", "actions", "split"}),
      text_flag("split",
                "a split of the data set, instead of folds: its part train for training, its part "
                "test for the test",
                &o.split, "FILE"),
      text_flag("model",
                "a finished model, shown in a row of its own; may be repeated. Test it only on "
                "people who were not in its training",
                &o.models, "FILE"),
      input_field(o.input),
      truth_field(o.truth),
      nodes_field(o.nodes),
      {"rate", "frames per second of methods that clean", &o.rate_hz, 1.0, 1000.0, {}, "HZ"},
      {"seeds", "number of trainings per network", &o.seeds, 1.0, 100.0},
      {"steps", "batches per training; 0: the method's default", &o.steps, 0.0, 1e8},
      {"hand-weight", "weight of wrists and hands in the loss of networks; 0: the method's default",
       &o.hand_weight, 0.0, 100.0},
      {"own-root",
       "for methods that clean: positions relative to each skeleton's own root and heading, like "
       "BRA's published marks",
       &o.own_root},
      choice_flag("device", "device that trains networks", &o.device, {"cpu", "cuda"}),
      format_field(o.format)};
  usage.check = [&o](const Common& common, const Sources& given) -> Result<void> {
    KA_TRY(check_out(common, {}, "-o FOLDER for results"));
    KA_TRY(check_data(o.data, o.windows));
    if (!o.split.empty() && (o.data.empty() || (given.count("folds") > 0 && o.folds != "split"))) {
      return Failure(Error{"--split", 0, "a data set (--data) without other folds",
                           o.data.empty() ? "--windows (--folds split uses the file's own parts)"
                                          : "--folds " + o.folds});
    }
    return check_methods(o, given);
  };
  return usage;
}

std::vector<std::string> chosen_methods(const Eval& o) {
  if (!o.methods.empty() || !o.models.empty()) return o.methods;
  std::vector<std::string> out;
  for (const EvalMethod& method : eval_methods()) {
    if (!is_trained(method.name)) out.push_back(method.name);
  }
  return out;
}

/// A finished model from --model. `training`: the part of its file that describes its training.
struct FinishedModel {
  std::string file, hash;
  Learns task = Learns::denoise;
  Json training;
};

Result<std::vector<FinishedModel>> finished_models(const Eval& o, Call& call) {
  std::vector<FinishedModel> out;
  for (const std::string& file : o.models) {
    const std::string bytes = KA_TRY(read_whole(call.surroundings.files, file, most_model_bytes));
    const ModelHeader header =
        KA_TRY(read_model_header(KA_TRY(read_safetensors(bytes, file)), file));
    const std::string word = KA_TRY(task_of_model(bytes, file));
    const auto task = learns_of(word);
    if (!task) {
      return Failure(Error{file, 0, "a model that cleans, poses or fuses", "task " + shown(word)});
    }
    out.push_back({file, sha256_of(bytes), *task, header.value("training", Json())});
  }
  return out;
}

/// The task that all methods and models share. Fails if they have different tasks.
Result<Learns> task_of_all(const Eval& o, const std::vector<FinishedModel>& models, Call& call) {
  std::vector<Compared> all;
  for (const std::string& method : chosen_methods(o)) all.push_back({method, task_of(method)});
  for (const FinishedModel& model : models) all.push_back({model.file, model.task});
  for (const Compared& one : all) {
    if (const auto same = check_one_task(all.front(), one); !same) {
      return call.console.refuse(same.error());
    }
  }
  return all.front().task;
}

/// A file of windows: its name, content and SHA-256.
struct WindowsFile {
  std::string file, bytes, hash;
};

/// The file of windows that the user gave. Without one, windows are cut from the data set into the
/// folder of results.
Result<WindowsFile> windows_of(const Eval& o, Learns task, Call& call) {
  WindowsFile out{o.windows, "", ""};
  if (out.file.empty()) {
    out.file = call.common.out + "/windows.npz";
    const WindowsWanted wanted{.data = o.data,
                               .split = o.split,
                               .where = "",
                               .input = rough_stream(o.input, task),
                               .truth = o.truth,
                               .rate_hz = o.rate_hz,
                               .valid = task == Learns::denoise ? "0" : "0.2"};
    KA_TRY(cut_windows(wanted, task, out.file));
  }
  out.bytes = KA_TRY(read_whole(call.surroundings.files, out.file, most_windows_bytes));
  out.hash = sha256_of(out.bytes);
  return out;
}

/// Everything that a run needs: the options, the data and the folds.
struct EvalRun {
  const Eval& options;
  std::vector<FinishedModel> models;
  Learns task;
  std::string windows, windows_hash;
  Comparison comparison;
  std::vector<Fold> folds;
};

/// Adds the people of a data set with whom a model was trained. If the training continued from
/// another model, the people of that model are added, too. `training`: the description in the
/// model's file.
void add_people_learnt(const Json& training, const std::string& dataset,
                       std::set<std::string>& people) {
  if (!training.is_object()) return;
  for (const Json& data : training.value("data", Json::array())) {
    if (!data.is_object() || data.value("name", "") != dataset) continue;
    for (const Json& subject : data.value("subjects", Json::array())) {
      if (subject.is_string()) people.insert(subject.get<std::string>());
    }
  }
  if (training.contains("from")) add_people_learnt(training.at("from"), dataset, people);
}

/// A warning that finished models were trained with people who are tested now. The rows of such
/// models do not show how well they do on new people. Empty if there are no such people.
std::string known_people(const std::vector<FinishedModel>& models, const Comparison& comparison,
                         const std::vector<Fold>& folds) {
  std::set<std::string> tested;
  for (const FoldTake& take : comparison.takes) {
    for (const Fold& fold : folds) {
      if (std::find(fold.tested.begin(), fold.tested.end(), take.name) == fold.tested.end())
        continue;
      tested.insert(take.subject);
    }
  }
  std::vector<std::string> out;
  for (const FinishedModel& model : models) {
    std::set<std::string> learnt, both;
    add_people_learnt(model.training, comparison.dataset, learnt);
    std::set_intersection(learnt.begin(), learnt.end(), tested.begin(), tested.end(),
                          std::inserter(both, both.end()));
    if (both.empty()) continue;
    out.push_back(fmt::format("{} was trained on {} of the test part: {}", file_name(model.file),
                              both.size() == 1 ? "a person" : "people", fmt::join(both, ", ")));
  }
  return fmt::format("{}", fmt::join(out, "; "));
}

/// Reads the windows, makes the folds, and warns if a model was trained with tested people.
Result<EvalRun> open_run(const Eval& o, Call& call) {
  auto models = KA_TRY(finished_models(o, call));
  const Learns task = KA_TRY(task_of_all(o, models, call));
  KA_TRY(make_folders(call.common.out + "/cache"));
  const WindowsFile windows = KA_TRY(windows_of(o, task, call));
  Comparison comparison =
      KA_TRY(task == Learns::denoise ? denoise_comparison(o, windows.bytes, windows.file)
                                     : body_comparison(o, task, windows.bytes, windows.file));
  auto folds = KA_TRY(folds_of(o.split.empty() ? o.folds : "split", comparison.takes));
  const std::string known = known_people(models, comparison, folds);
  if (!known.empty()) comparison.note += (comparison.note.empty() ? "" : "; ") + known;
  return EvalRun{o,
                 std::move(models),
                 task,
                 windows.file,
                 windows.hash,
                 std::move(comparison),
                 std::move(folds)};
}

/// The name of a cached result: a hash of everything on which the marks depend. `model_hash`: the
/// hash of a finished model; empty: none.
std::string key_of(const EvalRun& run, const TrainingWanted& training, const Fold& fold,
                   const std::string& model_hash) {
  Json all{cache_version,  run.windows_hash, training.method, training.seed, training.steps,
           training.input, training.truth,   fold.learnt,     fold.tested};
  if (!training.nodes.empty()) all.push_back(training.nodes);
  if (training.hand_weight > 0.0) all.push_back({{"hand_weight", training.hand_weight}});
  if (!fold.judged.empty()) all.push_back(fold.judged);
  if (run.options.own_root) all.push_back("own_root");
  if (!model_hash.empty()) all.push_back(model_hash);
  return sha256_of(all.dump()).substr(0, 32);
}

/// Reads the marks from the cache. If they are missing or damaged, computes them and writes them
/// there.
Result<std::string> marks_for(const EvalRun& run, const Trial& trial, const std::string& key,
                              Call& call) {
  FileSystem& files = call.surroundings.files;
  const std::string file = call.common.out + "/cache/" + key + ".json";
  std::error_code fault;
  if (fs::exists(file, fault)) {
    std::string known = KA_TRY(read_whole(files, file, most_cached_bytes));
    if (!run.comparison.sum_up("", {{"", {known}}}).empty()) return known;
  }
  std::string made = KA_TRY(run.comparison.mark(trial, call));
  if (run.comparison.sum_up("", {{"", {made}}}).empty()) {
    return Failure(Error{trial.model.empty() ? trial.training.method : trial.model, 0,
                         "marks that are finite numbers", "no number"});
  }
  KA_TRY(write_whole(files, file, made, Overwrite::yes));
  return made;
}

/// The table's rows for a method. If `method` is "model", the rows are for the finished model.
Result<std::vector<MethodMarks>> rows_of(const EvalRun& run, const std::string& method,
                                         const FinishedModel& model, Call& call) {
  const Eval& o = run.options;
  const bool trains = model.file.empty() && is_trained(method);
  std::vector<FoldMarks> folds;
  for (const Fold& fold : run.folds) {
    FoldMarks& marks = folds.emplace_back(FoldMarks{fold.name, {}});
    for (std::int64_t seed = 1; seed <= (trains ? o.seeds : 1); ++seed) {
      call.console.detail(fmt::format("{}: {}", method, fold.name));
      if (!go_on(call.console.progress(), method, folds.size() - 1, run.folds.size())) {
        return Failure(interruption());
      }
      Trial trial{{.method = method,
                   .windows = run.windows,
                   .input = rough_stream(o.input, run.task),
                   .truth = o.truth,
                   .learnt = fold.learnt,
                   .judged = fold.judged,
                   .device = o.device,
                   .seed = seed,
                   .steps = o.steps,
                   .hand_weight = o.hand_weight},
                  model.file,
                  fold.tested};
      if (!o.nodes.empty()) trial.training.nodes = split_at_commas(o.nodes);
      const std::string key = key_of(run, trial.training, fold, model.hash);
      TrainingWanted trained = trial.training;  // cnn and cnn+project need the same training
      trained.method = trained_part(method);
      trial.training.folder = call.common.out + "/models/" + key_of(run, trained, fold, model.hash);
      marks.texts.push_back(KA_TRY(marks_for(run, trial, key, call)));
    }
  }
  return run.comparison.sum_up(model.file.empty() ? method : model.file, folds);
}

/// Adds the rows that the table lacks. Every model for fusion also gives the rows of the filter,
/// which are needed once.
void add_new(const std::vector<MethodMarks>& more, std::vector<MethodMarks>& rows) {
  for (const MethodMarks& one : more) {
    const bool known = std::any_of(rows.begin(), rows.end(), [&](const MethodMarks& row) {
      return row.label() == one.label();
    });
    if (!known) rows.push_back(one);
  }
}

/// Compares all methods and models. The tables are written after each of them, so that a run that
/// is stopped leaves the rows so far.
Result<int> run_eval(Eval& o, Call& call) {
  for (std::string& model : o.models) model = KA_TRY(model_named(model, ""));
  const EvalRun run = KA_TRY(open_run(o, call));
  EvalRows all{run.comparison, run.folds.size() > 1 ? "folds of " + o.folds : "one split", {}};
  for (const std::string& method : chosen_methods(o)) {
    add_new(KA_TRY(rows_of(run, method, {}, call)), all.rows);
    KA_TRY(write_tables(all, call));
  }
  for (const FinishedModel& model : run.models) {
    add_new(KA_TRY(rows_of(run, "model", model, call)), all.rows);
    KA_TRY(write_tables(all, call));
  }
  print_tables(all, o.format, call);
  return 0;
}

}  // namespace

/// The verb `kinalign eval`.
Verb eval_verb() {
  return make_verb<Eval>(
      {.name = "eval",
       .summary = "compare methods and models on people that are not in their training",
       .text = "Each method is fitted or trained on all takes except those of a fold, and tested "
               "on the fold. The folder keeps the result of each fold, method and seed, so several "
               "runs extend a table and the same command continues a stopped run. Methods of one "
               "task share a table: they clean a Kinect, compute a pose from nodes, or from both. "
               "\"steadied\" rows have the same smoothing and constant bones for every method. "
               "\"both\", \"kinect\" and \"nodes\" name the input of a method that fuses; "
               "\"filter\" is fusion without learning. The folder contains table, people (each "
               "person's values) and tests (paired tests), each as .md, .tex, .csv and .json. For "
               "methods that clean a Kinect it also contains joints (each joint's error) and, for "
               "methods that state their uncertainty, radii.",
       .examples = {{"kinalign eval raw offset ridge --data walks -o results",
                     "without training: a table in seconds"},
                    {"kinalign eval refine bra --data walks -o results --folds people --seeds 3",
                     "two networks, each trained three times per person left out"},
                    {"kinalign eval inertial wouda --data cmu -o results --folds people",
                     "poses from nodes"},
                    {"kinalign eval --model fuse --data cmu --split cmu/split.json -o results",
                     "a finished model, and the filter, on the part test"}},
       .common = {"out", "json", "jobs"},
       .out_is_folder = true},
      describe_eval, run_eval);
}

}  // namespace kinalign
