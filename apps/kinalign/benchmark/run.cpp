// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"
#include "apps/cli/help.h"
#include "apps/cli/json_text.h"
#include "apps/kinalign/benchmark/cleaning.h"
#include "apps/kinalign/benchmark/node_figures.h"
#include "apps/kinalign/benchmark/pose_table.h"
#include "apps/kinalign/benchmark/program_method.h"
#include "apps/kinalign/dataset/dataset_folder.h"
#include "apps/kinalign/dataset/table_output.h"
#include "apps/kinalign/learn/eval_methods.h"
#include "apps/kinalign/text/counts_text.h"
#include "apps/kinalign/verbs.h"

#include "kinalign/view/models_page/models_html.h"
#include "kinalign/view/report_words.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <optional>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

// The largest file that check_page() reads; a page of a benchmark is smaller.
constexpr std::size_t longest_page = std::size_t{1} << 28U;

/// The options of `kinalign benchmark run`. `programs` has the values of --method. `methods` has
/// the words after the data set's folder.
struct BenchmarkRun {
  std::vector<std::string> data, methods, programs;
  std::string split, device = "cpu", format = "text";
  std::string pose_model, head_model, fuse_model;
  std::int64_t seed = 1, steps = 0;

  // The options for cleaning.h. If the user names no method, the default methods run.
  CleaningOptions cleaning(const Call& call) const {
    CleaningOptions out;
    out.data = folder_of(data);
    out.split = split.empty() ? out.data + "/splits/people.json" : split;
    out.folder = folder_of({call.common.out});
    out.methods = methods;
    if (methods.empty()) {
      out.methods = {"raw", "savgol", "offset", "ridge",        "cnn",
                     "bra", "bra-p",  "refine", "refine-linear"};
    }
    out.programs = programs;
    out.device = device;
    out.seed = seed;
    out.steps = steps;
    return out;
  }
};

/// The command line of `kinalign benchmark run`.
Usage describe_benchmark_run(BenchmarkRun& o) {
  Usage usage;
  usage.positionals = {folder_word(o.data),
                       {"METHOD",
                        "which methods clean the Kinect (default: raw, savgol, offset, ridge, cnn, "
                        "bra, bra-p, refine, refine-linear)",
                        &o.methods, 0, 100}};
  for (const EvalMethod& method : eval_methods()) {
    usage.positionals.back().choices.push_back(method.name);
  }
  usage.flags = {
      text_flag("split", "people to train on and to test (default: FOLDER/splits/people.json)",
                &o.split, "FILE"),
      {"steps", "batches per training; 0: the method's default", &o.steps, 0.0, 1e8},
      {"seed", "random seed of each training", &o.seed, 0.0, 1e9},
      choice_flag("device", "device that trains networks", &o.device, {"cpu", "cuda"}),
      format_field(o.format)};
  usage.flags.push_back(text_flag("method",
                                  "another method: a program that reads one NPZ and writes another",
                                  &o.programs, "NAME=PROGRAM"));
  const auto model = [&usage](const char* name, const char* meaning, std::string& file) {
    usage.flags.push_back(text_flag(name, meaning, &file, "FILE"));
  };
  model("pose-model", "model for figure 8: five nodes (default: the shipped model)", o.pose_model);
  model("head-model", "model for figure 9: nodes with one on the head (default: the shipped model)",
        o.head_model);
  model("fuse-model", "model for figure 10: a Kinect and nodes (default: the shipped model)",
        o.fuse_model);
  usage.check = [&o](const Common& common, const Sources&) -> Result<void> {
    // program_method() is called only for its errors: a wrong NAME=PROGRAM is wrong use, found
    // before any training.
    for (const std::string& words : o.programs) KA_TRY(program_method(words));
    return check_out(common, {}, "-o FOLDER for results");
  };
  return usage;
}

/// Fails if a file that is no page of a benchmark has the page's name. A page of an earlier run is
/// replaced without --force.
Result<void> check_page(const std::string& path, Call& call) {
  std::error_code fault;
  if (call.common.force || !std::filesystem::exists(path, fault)) return {};
  const std::string text = KA_TRY(read_whole(call.surroundings.files, path, longest_page));
  if (text.find(models_page_mark) != std::string::npos) return {};
  return Failure(Error{path, 0,
                       "no file of that name, or a page of a benchmark (--force overwrites)",
                       "another file"});
}

/// Prints the trainings that a run would do, for --dry-run, with their times.
Result<int> show_training_plan(const CleaningOptions& o, Call& call) {
  std::string text;
  Json json = Json::array();
  double seconds = 0.0;
  std::size_t trainings = 0, not_known = 0;
  // The sum is an upper bound, because the times were measured on a busy core.
  for (const TrainingPlan& one : training_plan(o)) {
    // An existing model takes no time. The run may still refuse it, if it was trained by another
    // job.
    const std::optional<double> takes = one.is_there ? 0.0 : one.seconds;
    trainings += one.is_there ? 0 : 1;
    not_known += takes ? 0 : 1;
    seconds += takes.value_or(0.0);
    text += one.is_there
                ? fmt::format("{:<13} is already trained\n", one.method)
                : fmt::format("{:<13} to train, {} steps, {}\n", one.method,
                              grouped(static_cast<std::uint64_t>(one.steps)),
                              takes ? "at most about " + duration_text(*takes) : "unknown time");
    json.push_back({{"method", one.method},
                    {"is_there", one.is_there},
                    {"steps", one.steps},
                    {"seconds", takes ? Json(*takes) : Json()}});
  }
  if (trainings == 0) text += "nothing to train\n";
  if (trainings > not_known) {
    text += fmt::format("at most about {} of training on one core{}\n", duration_text(seconds),
                        not_known > 0 ? ", without trainings of unknown time" : "");
  }
  call.console.print(text);
  call.console.print_json(Json{{"trainings", json}, {"seconds", seconds}}.dump());
  return 0;
}

/// Writes table 9 as Markdown, LaTeX and CSV, all with the same numbers. Deviations stand in the
/// cells of their means; in CSV they have their own columns.
Result<void> write_tables(const Table& table, const std::string& folder, Call& call) {
  const std::string path = folder + "/table_9";
  KA_TRY(write_table(with_joined_deviations(table), path,
                     {TableFormat::markdown, TableFormat::latex}, call));
  return write_table(table, path, {TableFormat::csv}, call);
}

/// The number in the row's cell of a column. Empty if the cell has no number. `key` must be a
/// column of the table.
std::optional<double> value_of(const Table& table, const std::vector<Cell>& row,
                               const std::string& key) {
  std::size_t column = 0;
  while (table.columns[column].key != key) ++column;
  const auto* value = std::get_if<double>(&row[column]);
  return value == nullptr ? std::nullopt : std::optional(*value);
}

/// The row with the smallest number in a column. nullptr if no row has a number there.
const std::vector<Cell>* best_row(const Table& table, const std::string& key) {
  const std::vector<Cell>* best = nullptr;
  for (const auto& row : table.rows) {
    const auto value = value_of(table, row, key);
    if (value && (best == nullptr || *value < *value_of(table, *best, key))) best = &row;
  }
  return best;
}

/// Makes the page without its command and its figures.
ModelsPage page_of(const CleaningOptions& o, const CleaningData& data,
                   const std::vector<CleanedTakes>& all, const Table& table) {
  ModelsPage page;
  page.name = "Benchmark on " + std::filesystem::path(o.data).filename().string();
  page.software = "kinalign " + program_version();
  page.facts = {fmt::format("tested on {} of {}", counted(data.tested_takes, "take"),
                            counted(data.tested_people, "person", "people")),
                fmt::format("trained on {} of {} others", counted(data.learnt.size(), "take"),
                            grouped(data.learnt_people)),
                fmt::format("seed {}", o.seed)};
  if (o.steps > 0) {
    page.facts.push_back(
        fmt::format("{} steps per network", grouped(static_cast<std::uint64_t>(o.steps))));
  }
  // The page begins with the smallest mean error of position, the error of the first method (by
  // default the raw Kinect), and the smallest error of the bones.
  if (const auto* best = best_row(table, "position_cm")) {
    const auto& name = std::get<std::string>(best->front());
    const double cm = *value_of(table, *best, "position_cm");
    page.headline = fmt::format("{} is nearest to the truth: {:.1f} cm", name, cm);
    page.numbers.emplace_back(fmt::format("{:.1f} cm", cm), "position error of " + name);
    const auto& first = table.rows.front();
    page.numbers.emplace_back(
        fmt::format("{:.1f} cm", value_of(table, first, "position_cm").value_or(0.0)),
        "position error of " + std::get<std::string>(first.front()));
    const auto* bones = best_row(table, "bone_cm");
    page.numbers.emplace_back(fmt::format("{:.1f} cm", *value_of(table, *bones, "bone_cm")),
                              "error of bones of " + std::get<std::string>(bones->front()));
  }
  page.marks = with_joined_deviations(table);
  page.marks_note =
      "E_p is the mean square of a coordinate's error, E_b the mean error of a bone's length, E_s "
      "the roughness of the answer itself. E_s does not use the truth: compare it with the truth's "
      "own E_s. Position is "
      "the mean distance; fitted the same after a similarity fit of each frame; constancy the "
      "deviation of bones within a take; acceleration the difference of second differences; jitter "
      "the third difference. Steadied rows have the mean of the answer and of the answer to the "
      "mirror image, Savitzky-Golay over 11 frames, and bones of one length.";
  page.poses = pose_table(data, all);
  page.errors = error_plot(data, all);
  page.motion = side_by_side(data, all);
  return page;
}

/// Quotes a word for a shell if needed. The page shows its command, and users may copy it even if
/// names contain spaces or quotes.
std::string shell_word(const std::string& word) {
  const bool is_plain = std::all_of(word.begin(), word.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("_-./=+,:").find(c) != std::string_view::npos;
  });
  if (is_plain && !word.empty()) return word;
  std::string out = "'";
  // Within single quotes only a single quote needs an escape: the quoted text ends, an escaped
  // quote follows, and a new quoted text begins.
  for (const char c : word) out += c == '\'' ? "'\\''" : std::string(1, c);
  return out + "'";
}

/// The command that makes the same page again. Defaults are left out, except for the seed and the
/// folder.
std::string command_of(const BenchmarkRun& o, const CleaningOptions& cleaning) {
  std::vector<std::string> words{cleaning.data};
  words.insert(words.end(), cleaning.methods.begin(), cleaning.methods.end());
  const auto flag = [&words](const char* name, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {name, value});
  };
  for (const std::string& program : cleaning.programs) flag("--method", program);
  flag("--split", o.split);
  flag("--pose-model", o.pose_model);
  flag("--head-model", o.head_model);
  flag("--fuse-model", o.fuse_model);
  if (o.device != "cpu") flag("--device", o.device);
  if (o.steps > 0) flag("--steps", std::to_string(o.steps));
  flag("--seed", std::to_string(o.seed));
  flag("-o", cleaning.folder);
  std::string out = "kinalign benchmark run";
  for (const std::string& word : words) out += " " + shell_word(word);
  return out;
}

/// A line for each row in the tables of the figures: "figure 8   five nodes: all 8.7 cm".
std::string figure_lines(const std::vector<PosePictures>& figures) {
  std::string out;
  for (const PosePictures& figure : figures) {
    std::string name = figure.id;
    std::replace(name.begin(), name.end(), '-', ' ');
    // A figure without data prints the reason in place of numbers.
    if (!figure.absent.empty()) out += fmt::format("{:<9}  {}\n", name, harmless(figure.absent));
    for (const Table& table : figure.tables) {
      for (const auto& row : table.rows) {
        std::string words;
        for (std::size_t c = 1; c < row.size(); ++c) {
          words += fmt::format("{}{} {}", c == 1 ? "" : ", ", table.columns[c].title,
                               cell_text(row[c], table.columns[c]));
        }
        out += fmt::format("{:<9}  {}: {}\n", name, std::get<std::string>(row.front()), words);
      }
    }
  }
  return out;
}

/// The rows of a table as JSON.
Json rows_of_table(const Table& table) { return Json::parse(written(table, TableFormat::json)); }

/// Prints the tables as text or as JSON.
void print_results(const Table& table, const std::vector<PosePictures>& figures,
                   const std::string& format, const std::string& page_path, Call& call) {
  Json json{{"rows", rows_of_table(table)}, {"figures", Json::object()}, {"page", page_path}};
  for (const PosePictures& figure : figures) {
    // The JSON has one list of rows for each figure, even if the figure has several tables.
    Json rows = Json::array();
    for (const Table& one : figure.tables) {
      for (Json& row : rows_of_table(one)) rows.push_back(std::move(row));
    }
    json["figures"][figure.id] = rows;
  }
  // json_text() accepts names that are not UTF-8, which would otherwise end the program after hours
  // of training.
  call.console.print_json(json_text(json, 1));
  if (call.common.json) return;
  print_tables({{"rows", with_joined_deviations(table)}}, format, call);
  call.console.print(figure_lines(figures) + harmless(fmt::format("page       {}\n", page_path)));
}

/// Runs all methods and writes the tables and the page. Table 9 is written before the figures are
/// made.
Result<int> run_benchmark(BenchmarkRun& o, Call& call) {
  const CleaningOptions cleaning = o.cleaning(call);
  const std::string page_path = cleaning.folder + "/benchmark.html";
  // --dry-run reads no data, only the names of the models.
  if (call.common.dry_run) return show_training_plan(cleaning, call);
  // A page's name that another file has is an error before the training, not after it.
  KA_TRY(check_page(page_path, call));
  call.console.advise("trained networks are kept");
  const CleaningData data = KA_TRY(open_cleaning(cleaning, call));
  const auto all = KA_TRY(run_methods(cleaning, data, call));
  const Table table = marks_table(data, all);
  // Table 9 is written first: it must not be lost if a model for the figures can't be read.
  KA_TRY(write_tables(table, cleaning.folder, call));
  ModelsPage page = page_of(cleaning, data, all, table);
  page.command = command_of(o, cleaning);
  page.figures = KA_TRY(node_figures(
      {cleaning.data, cleaning.split, o.pose_model, o.head_model, o.fuse_model}, call));
  KA_TRY(write_whole(call.surroundings.files, page_path, models_html(page), Overwrite::yes));
  call.console.wrote(page_path);
  print_results(table, page.figures, o.format, page_path, call);
  return 0;
}

}  // namespace

/// The verb `kinalign benchmark run`.
Verb benchmark_run_verb() {
  return make_verb<BenchmarkRun>(
      {.name = "benchmark run",
       .summary = "the paper's methods on a twin, as tables and a page",
       .text =
           "Fits or trains each method on the training people of a data set, runs it on the takes "
           "of the test people, and writes the paper's tables 8 and 9 and figures 8 to 10 as one "
           "page (benchmark.html), with table 9 also as Markdown, LaTeX and CSV. Networks are kept "
           "in the folder and used again. --dry-run prints what would be trained, and for how "
           "long.",
       .examples = {{"kinalign benchmark run twin -o results",
                     "all methods; first: kinalign benchmark twin --scale 0.02 -o twin"},
                    {"kinalign benchmark run twin raw offset ridge -o quick",
                     "without training: a page in seconds"}},
       .common = {"out", "force", "json", "dry_run", "jobs"},
       .out_is_folder = true},
      describe_benchmark_run, run_benchmark);
}

}  // namespace kinalign
