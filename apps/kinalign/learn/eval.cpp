// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"
#include "apps/kinalign/dataset/own_process.h"
#include "apps/kinalign/dataset/table_output.h"
#include "apps/kinalign/learn/eval_methods.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/compare/denoise_marks.h"
#include "kinalign/compare/folds.h"
#include "kinalign/core/hash.h"
#include "kinalign/evaluate/statistics.h"
#include "kinalign/view/table.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::size_t most_windows_bytes = std::size_t{4} << 30U;
constexpr std::size_t most_cached_bytes = std::size_t{64} << 20U;
constexpr std::size_t least_rows = 8;
/// The version of cached results: another number lets all be computed again.
constexpr int cache_version = 3;

struct Eval {
  std::vector<std::string> methods;
  std::string data, windows, input = "kinect", truth = "mocap", folds = "people", format = "text";
  std::string device = "cpu";
  double rate_hz = 30.0, hand_weight = 0.0;
  std::int64_t seeds = 1, steps = 0;
};

Usage describe_eval(Eval& o) {
  Usage usage;
  usage.positionals = {
      {"METHOD", "which methods (default: those without training)", &o.methods, 0, 100}};
  for (const EvalMethod& method : eval_methods()) {
    usage.positionals.front().choices.push_back(method.name);
  }
  usage.flags = {
      {"data", "the data set's folder", &o.data, 0.0, 0.0, {}, "FOLDER"},
      {"windows", "a file of windows in its place", &o.windows, 0.0, 0.0, {}, "FILE"},
      {"folds", "what is tested apart", &o.folds, 0.0, 0.0, {"people", "runs", "actions"}},
      {"input", "the rough stream", &o.input, 0.0, 0.0, {}, "NAME"},
      {"truth", "the precise stream", &o.truth, 0.0, 0.0, {}, "NAME"},
      {"rate", "frames a second", &o.rate_hz, 1.0, 1000.0, {}, "HZ"},
      {"seeds", "trainings of each network", &o.seeds, 1.0, 100.0},
      {"steps", "batches of each training; 0: the method's own number", &o.steps, 0.0, 1e8},
      {"hand-weight", "of wrists and hands in the loss of networks; 0: the method's own",
       &o.hand_weight, 0.0, 100.0},
      {"device", "where networks are trained", &o.device, 0.0, 0.0, {"cpu", "cuda"}},
      format_field(o.format)};
  usage.check = [&o](const Common& common, const Sources&) -> Result<void> {
    if (common.out.empty()) return Failure(Error{"-o", 0, "-o FOLDER for results", "none"});
    if (o.data.empty() == o.windows.empty()) {
      return Failure(Error{"--data", 0, "a data set (--data) or a file of windows (--windows)",
                           o.data.empty() ? "neither" : "both"});
    }
    return {};
  };
  return usage;
}

/// Marks of a method on a tested stretch: of its answer as it is, and steadied.
struct Marked {
  std::string take, subject;
  std::array<DenoiseMarks, 2> marks;
};

Json number(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json marks_json(const DenoiseMarks& marks) {
  const ProtocolMarks& p = marks.protocol;
  const TableNine& t = marks.table_nine;
  return {number(p.position_cm),
          number(p.fitted_cm),
          number(p.bone_cm),
          number(p.constancy_cm),
          p.acceleration_mm,
          p.jitter_mm,
          p.true_jitter_mm,
          t.position,
          t.bone,
          t.smooth,
          t.true_smooth,
          marks.covered,
          marks.radius_cm,
          marks.cells,
          number(marks.hand_cm),
          marks.feet.contacts,
          marks.feet.skate_m_s,
          marks.feet.true_skate_m_s};
}

std::optional<double> number_of(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

DenoiseMarks marks_of(const Json& json) {
  DenoiseMarks out;
  ProtocolMarks& p = out.protocol;
  p.position_cm = number_of(json.at(0));
  p.fitted_cm = number_of(json.at(1));
  p.bone_cm = number_of(json.at(2));
  p.constancy_cm = number_of(json.at(3));
  p.acceleration_mm = json.at(4).get<double>();
  p.jitter_mm = json.at(5).get<double>();
  p.true_jitter_mm = json.at(6).get<double>();
  TableNine& t = out.table_nine;
  t.position = json.at(7).get<double>();
  t.bone = json.at(8).get<double>();
  t.smooth = json.at(9).get<double>();
  t.true_smooth = json.at(10).get<double>();
  out.covered = json.at(11).get<double>();
  out.radius_cm = json.at(12).get<double>();
  out.cells = json.at(13).get<std::size_t>();
  out.hand_cm = number_of(json.at(14));
  out.feet.contacts = json.at(15).get<std::size_t>();
  out.feet.skate_m_s = json.at(16).get<double>();
  out.feet.true_skate_m_s = json.at(17).get<double>();
  return out;
}

std::string written_marks(const std::vector<Marked>& all) {
  Json out = Json::array();
  for (const Marked& one : all) {
    out.push_back({one.take, one.subject, marks_json(one.marks[0]), marks_json(one.marks[1])});
  }
  return out.dump();
}

/// Nothing where the text is none of ours.
std::vector<Marked> read_marks(const std::string& text) {
  try {
    std::vector<Marked> out;
    for (const Json& one : Json::parse(text)) {
      out.push_back({one.at(0).get<std::string>(),
                     one.at(1).get<std::string>(),
                     {marks_of(one.at(2)), marks_of(one.at(3))}});
    }
    return out;
  } catch (const nlohmann::json::exception&) {
    return {};
  }
}

/// All that a table is made from.
struct Bench {
  std::string windows, windows_hash;
  Pairs pairs;
  DenoiseLayout layout;
  std::vector<Fold> folds;
};

Result<std::string> windows_of(const Eval& o, Call& call) {
  if (!o.windows.empty()) return o.windows;
  const std::string file = call.common.out + "/windows.npz";
  const Ended ended = KA_TRY(
      run_own_process({"dataset", "windows", o.data, "-o", file, "--force", "--quiet", "--length",
                       "32", "--step", "32", "--valid", "0", "--rate",
                       fmt::format("{:g}", o.rate_hz), "--stream", o.input, "--stream", o.truth}));
  if (ended.code == 0) return file;
  return Failure(Error{o.data, 0, "a data set that windows can be cut from", ended.complaint});
}

std::vector<FoldTake> takes_of(const Pairs& pairs) {
  std::vector<FoldTake> out;
  std::set<std::string> known;
  for (const Pair& pair : pairs.all) {
    if (known.insert(pair.take).second) {
      out.push_back({pair.take, pair.subject, pair.action, run_of(pair.take)});
    }
  }
  return out;
}

Result<Bench> open_bench(const Eval& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  Bench out;
  out.windows = KA_TRY(windows_of(o, call));
  const std::string bytes = KA_TRY(read_whole(files, out.windows, most_windows_bytes));
  Sha256 hash;
  hash.update(bytes);
  out.windows_hash = hash.hex();
  out.pairs =
      KA_TRY(pairs_of(KA_TRY(read_windows(bytes, out.windows)), o.input, o.truth, least_rows));
  out.layout = KA_TRY(eval_layout(out.pairs));
  out.folds = KA_TRY(folds_of(o.folds, takes_of(out.pairs)));
  return out;
}

/// One method on one fold, trained from one seed.
struct Trial {
  const Eval& options;
  const Bench& bench;
  const Fold& fold;
  std::string method;
  std::int64_t seed = 1;

  /// Of the result; of the model, `trained` is the method.
  std::string key() const { return key(method); }
  std::string key(const std::string& trained) const {
    Sha256 hash;
    hash.update(Json{cache_version, bench.windows_hash, trained, seed, options.steps, options.input,
                     options.truth, options.hand_weight, fold.learnt, fold.tested}
                    .dump());
    return hash.hex().substr(0, 32);
  }
};

Result<std::vector<Marked>> compute(const Trial& trial, const DenoiseMarker& marker, Call& call) {
  const Bench& bench = trial.bench;
  const EvalTask task{
      .layout = bench.layout,
      .pairs = bench.pairs.all,
      .learnt = trial.fold.learnt,
      .windows = bench.windows,
      .input = trial.options.input,
      .truth = trial.options.truth,
      .folder = call.common.out + "/models/" + trial.key(trained_part(trial.method)),
      .device = trial.options.device,
      .seed = trial.seed,
      .steps = trial.options.steps,
      .hand_weight = trial.options.hand_weight};
  const Answer answer = KA_TRY(make_answer(trial.method, task, call));
  const Steadier steadier({}, bench.layout);
  const auto& tested = trial.fold.tested;
  std::vector<Marked> out;
  for (const Pair& pair : bench.pairs.all) {
    if (std::find(tested.begin(), tested.end(), pair.take) == tested.end()) continue;
    Denoised plain = answer(pair.input);
    Marked one{pair.take, pair.subject, {}};
    one.marks[0] = marker.marks_of(pair, plain.positions, plain.spread);
    const Denoised steadied = steadier.steadied(answer, pair.input, std::move(plain));
    one.marks[1] = marker.marks_of(pair, steadied.positions, steadied.spread);
    out.push_back(std::move(one));
  }
  return out;
}

/// From the cache, or computed and put there.
Result<std::vector<Marked>> marks_for(const Trial& trial, const DenoiseMarker& marker, Call& call) {
  FileSystem& files = call.surroundings.files;
  const std::string file = call.common.out + "/cache/" + trial.key() + ".json";
  std::error_code fault;
  if (fs::exists(file, fault)) {
    auto known = read_marks(KA_TRY(read_whole(files, file, most_cached_bytes)));
    if (!known.empty()) return known;
  }
  auto made = KA_TRY(compute(trial, marker, call));
  KA_TRY(write_whole(files, file, written_marks(made), Overwrite::yes));
  return made;
}

/// Values of one method, a row for each fold (of a single fold: for each person).
using FoldRows = std::vector<ProtocolMeans>;

std::vector<std::vector<const Marked*>> groups_of(const std::vector<std::vector<Marked>>& folds) {
  std::vector<std::vector<const Marked*>> out;
  if (folds.size() > 1) {
    for (const auto& fold : folds) {
      out.emplace_back();
      for (const Marked& one : fold) out.back().push_back(&one);
    }
    return out;
  }
  std::map<std::string, std::vector<const Marked*>> people;
  for (const Marked& one : folds.front()) people[one.subject].push_back(&one);
  for (auto& [name, group] : people) out.push_back(std::move(group));
  return out;
}

void put_mean(std::vector<Cell>& row, const std::vector<double>& values) {
  if (values.empty()) {
    row.insert(row.end(), {Cell(), Cell()});
    return;
  }
  double sum = 0.0;
  for (const double value : values) sum += value;
  row.emplace_back(sum / static_cast<double>(values.size()));
  row.emplace_back(deviation(values));
}

std::vector<Cell> row_of(const std::string& method, const std::vector<std::vector<Marked>>& folds,
                         std::size_t which) {
  std::array<std::vector<double>, 10> values;
  for (const auto& group : groups_of(folds)) {
    std::vector<ProtocolMarks> marks;
    double covered = 0.0, radius = 0.0, cells = 0.0, skate = 0.0, contacts = 0.0;
    Mean hands;
    for (const Marked* one : group) {
      const DenoiseMarks& m = one->marks[which];
      marks.push_back(m.protocol);
      const auto n = static_cast<double>(m.cells);
      covered += m.covered * n;
      radius += m.radius_cm * n;
      cells += n;
      if (m.hand_cm) hands.add(*m.hand_cm);
      const auto standing = static_cast<double>(m.feet.contacts);
      skate += 100.0 * m.feet.skate_m_s * standing;
      contacts += standing;
    }
    const ProtocolMeans row = protocol_row(marks);
    const auto put = [&](std::size_t i, const std::optional<double>& value) {
      if (value) values[i].push_back(*value);
    };
    put(0, row.position_cm);
    put(1, row.fitted_cm);
    put(2, row.bone_cm);
    put(3, row.constancy_cm);
    put(4, row.acceleration_mm);
    put(5, row.jitter);
    if (cells > 0.0) put(6, 100.0 * covered / cells);
    if (cells > 0.0) put(7, radius / cells);
    put(8, hands.value());
    if (contacts > 0.0) put(9, skate / contacts);
  }
  std::vector<Cell> out{method + (which == 1 ? ", steadied" : "")};
  for (const auto& one : values) put_mean(out, one);
  return out;
}

Table empty_table(const Eval& o) {
  Table table;
  table.caption = "folds of " + o.folds + ": mean and standard deviation over folds";
  table.columns = {{"method", "method"}};
  const auto add = [&](const std::string& key, const std::string& title, int decimals) {
    table.columns.push_back({key, title, decimals});
    table.columns.push_back({key + "_sd", "±", decimals});
  };
  add("mpjpe_cm", "position, cm", 2);
  add("pa_mpjpe_cm", "fitted, cm", 2);
  add("bone_cm", "bones, cm", 2);
  add("constancy_cm", "constancy, cm", 2);
  add("acceleration_mm", "acceleration, mm/frame²", 2);
  add("jitter", "jitter, × truth", 2);
  add("covered_percent", "within 90 % radius, %", 1);
  add("radius_cm", "that radius, cm", 1);
  add("hand_cm", "wrists, cm", 2);
  add("skate_cm_s", "standing feet, cm/s", 2);
  return table;
}

std::vector<std::string> chosen_methods(const Eval& o) {
  if (!o.methods.empty()) return o.methods;
  std::vector<std::string> out;
  for (const EvalMethod& method : eval_methods()) {
    if (!method.trained) out.push_back(method.name);
  }
  return out;
}

Result<void> write_tables(const Table& table, const std::string& folder, Call& call) {
  for (const auto& [name, format] :
       {std::pair("table.md", TableFormat::markdown), std::pair("table.tex", TableFormat::latex),
        std::pair("table.csv", TableFormat::csv), std::pair("table.json", TableFormat::json)}) {
    KA_TRY(write_whole(call.surroundings.files, folder + "/" + name, written(table, format),
                       Overwrite::yes));
  }
  return {};
}

Result<int> run_eval(Eval& o, Call& call) {
  KA_TRY(make_folders(call.common.out + "/cache"));
  const Bench bench = KA_TRY(open_bench(o, call));
  const DenoiseMarker marker = KA_TRY(DenoiseMarker::make(bench.layout, bench.pairs.all));
  Table table = empty_table(o);
  for (const std::string& method : chosen_methods(o)) {
    std::vector<std::vector<Marked>> folds;
    const std::int64_t seeds = is_trained(method) ? o.seeds : 1;
    for (const Fold& fold : bench.folds) {
      folds.emplace_back();
      for (std::int64_t seed = 1; seed <= seeds; ++seed) {
        call.console.detail(fmt::format("{}: {}", method, fold.name));
        auto marks = KA_TRY(marks_for({o, bench, fold, method, seed}, marker, call));
        folds.back().insert(folds.back().end(), std::make_move_iterator(marks.begin()),
                            std::make_move_iterator(marks.end()));
      }
    }
    for (const std::size_t which : {std::size_t{0}, std::size_t{1}}) {
      table.rows.push_back(row_of(method, folds, which));
    }
    KA_TRY(write_tables(table, call.common.out, call));
  }
  print_table(table, o.format, "rows", call);
  return 0;
}

}  // namespace

Verb eval_verb() {
  return make_verb<Eval>(
      {.name = "eval",
       .summary = "methods that clean a Kinect, held against each other",
       .text =
           "Each method is fitted or trained on all takes but those of a fold, and tested on "
           "these. Every result of a fold, a method and a seed is kept in the folder, so that a "
           "table grows over several runs and a stopped run goes on. \"steadied\" rows have the "
           "same smoothing and constant bones for every method.",
       .examples = {{"kinalign eval raw offset ridge --data walks -o results",
                     "without training: a table in seconds"},
                    {"kinalign eval refine bra --data walks -o results --folds people --seeds 3",
                     "two networks, three trainings each for every person left out"}},
       .common = {"out", "json", "jobs"},
       .out_is_folder = true},
      describe_eval, run_eval);
}

}  // namespace kinalign
