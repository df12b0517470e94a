// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/benchmark/cleaning.h"

#include "apps/cli/console.h"
#include "apps/kinalign/benchmark/program_method.h"
#include "apps/kinalign/learn/eval_methods.h"
#include "apps/kinalign/text/counts_text.h"
#include "apps/kinalign/verbs/describe_model.h"

#include "kinalign/core/hash.h"
#include "kinalign/evaluate/statistics.h"
#include "kinalign/models/joint_names.h"
#include "kinalign/motion/shared_joints.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::size_t most_bench_windows = std::size_t{4} << 30U;  // a larger file is refused
constexpr std::size_t least_bench_rows = 8;  // frames; shorter stretches are left out
constexpr const char *kinect_stream = "kinect", *true_stream = "mocap";

/// The time of one training step with one thread, s. It was measured over 150 steps on the
/// simulated data set of scale 0.02. The core also ran other programs, so an idle machine needs
/// less time.
struct TrainingSpeed {
  std::string_view method;
  double step_s = 0.0;
};
// For a method that is not in this table, the plan states no time.
constexpr std::array<TrainingSpeed, 6> training_speeds{{{"cnn", 0.73},
                                                        {"bra", 2.7},
                                                        {"bra-p", 5.9},
                                                        {"bra-p-plain", 5.9},
                                                        {"refine", 0.24},
                                                        {"refine-linear", 0.28}}};
constexpr std::int64_t own_steps = 1200;  // training steps of a method by default

std::string model_file(const CleaningOptions& o, const std::string& method) {
  return o.folder + "/models/" + method + ".safetensors";
}

/// Makes the job for kinalign-learn. Its identity does not depend on the folders of the files.
Json job_of_method(const CleaningOptions& o, const CleaningData& data, const std::string& method) {
  // If `steps` is 0, the job does not state it, and the method's default counts.
  Json options{{"seed", o.seed}};
  if (o.steps > 0) options["steps"] = o.steps;
  Json job{{"schema", "kinalign.training_job/1"},
           {"method", method},
           {"input", kinect_stream},
           {"truth", true_stream},
           {"learn", data.learnt},
           {"options", options}};
  // The identity is a hash of all that changes the training: the job so far and the bytes of the
  // windows. Paths, threads and the device are added later, so they do not change the identity.
  job["identity"] = sha256_of(job.dump() + data.windows_hash);
  return job;
}

/// True if a job with this identity has trained the model.
Result<bool> has_identity(const std::string& bytes, const std::string& file,
                          const std::string& identity) {
  // kinalign-learn writes the identity of its job into the model. A model of another program has no
  // identity.
  const DenoiseModel model = KA_TRY(read_denoise_model(bytes, file));
  const Json training = Json::parse(model.facts.training, nullptr, false);
  return training.is_object() && training.value("identity", "") == identity;
}

/// Returns the file of the trained model, and trains the model if the file is missing. An existing
/// model with another identity is refused without --force.
Result<std::string> trained_method(const CleaningOptions& o, const CleaningData& data,
                                   const std::string& method, Call& call) {
  FileSystem& files = call.surroundings.files;
  const std::string file = model_file(o, method);
  Json job = job_of_method(o, data, method);
  const auto identity = job.at("identity").get<std::string>();
  std::error_code fault;
  // A model with the right identity is used again, so that a run that was stopped need not repeat
  // it.
  if (fs::exists(file, fault)) {
    const std::string bytes = KA_TRY(read_whole(files, file, most_model_bytes));
    if (KA_TRY(has_identity(bytes, file, identity))) return file;
    if (!call.common.force) {
      return Failure(Error{file, 0, "a model trained on these takes with this seed and these steps",
                           "a model of other takes, seed or steps (--force trains it again)"});
    }
  }
  // These members say where to train. They do not belong to the identity.
  job.update({{"windows", data.windows}, {"device", o.device}});
  call.console.detail("training " + method);
  KA_TRY(train_in(o.folder + "/models/" + method + ".training", std::move(job), file, call));
  return file;
}

/// Returns a method as a function from the joints of a Kinect to cleaned joints. kinalign-learn
/// trains networks, and their answers come from the model's file. All other methods are fitted to
/// the training takes in this process.
Result<Answer> answer_for(const CleaningOptions& o, const CleaningData& data,
                          const std::string& method, Call& call) {
  if (is_trained(method)) {
    std::vector<JointFrames> tested;
    for (const Pair* pair : data.tested) tested.push_back(pair->input);
    // Some methods differ only in the use of a network and share one training: "cnn+project" uses
    // the network of "cnn".
    const std::string model = KA_TRY(trained_method(o, data, trained_part(method), call));
    return trained_answer(method, model, data.layout, tested, call);
  }
  // The task names the same takes as the jobs of the networks, so all methods learn from the same
  // data.
  const EvalTask task{data.layout,
                      data.pairs.all,
                      {.method = method,
                       .windows = data.windows,
                       .input = kinect_stream,
                       .truth = true_stream,
                       .learnt = data.learnt,
                       .folder = o.folder,
                       .device = o.device,
                       .seed = o.seed,
                       .steps = o.steps}};
  return make_answer(task, call);
}

/// Computes the marks of a method on all tested stretches. answer_to(i) returns the function that
/// answers for data.tested[i].
CleanedTakes marked_answers(const std::string& method, const Steadying& steadying,
                            const CleaningData& data, const DenoiseMarker& marker,
                            const std::function<Answer(std::size_t)>& answer_to) {
  const Steadier steadier(steadying, data.layout);
  CleanedTakes out;
  out.method = method;
  for (std::size_t i = 0; i < data.tested.size(); ++i) {
    const Pair& pair = *data.tested[i];
    const Answer answer = answer_to(i);
    Denoised plain = answer(pair.input);
    // The figures show the plain answers, so a copy is kept before the answers are steadied.
    out.answers.push_back(plain.positions);
    out.marks.push_back(both_marks(marker, steadier, answer, pair, std::move(plain)));
  }
  return out;
}

/// A column of table 9. The first three columns have the definitions of the HFUT-MMD paper.
/// docs/models.md defines the other columns.
struct MarksColumn {
  const char *key, *title;
  int decimals;
};
constexpr std::array<MarksColumn, 9> marks_columns{
    {{"table_9_position_cm2", "E_p, cm²", 1},
     {"table_9_bone_cm", "E_b, cm", 2},
     {"table_9_smooth_cm", "E_s, cm", 3},
     {"position_cm", "position, cm", 2},
     {"fitted_cm", "fitted, cm", 2},
     {"bone_cm", "bones, cm", 2},
     {"constancy_cm", "constancy, cm", 2},
     {"acceleration_mm", "acceleration, mm/frame²", 2},
     {"jitter", "jitter, × truth", 1}}};

using PersonMarks = std::array<std::optional<double>, marks_columns.size()>;

/// The mean marks over one person's stretches.
PersonMarks marks_of_person(const CleaningData& data, const CleanedTakes& method,
                            const std::string& person, std::size_t which) {
  std::vector<ProtocolMarks> protocol;
  // The three marks of the HFUT-MMD paper are means over frames, so a long stretch has more weight
  // than a short one.
  std::array<double, 3> sums{};
  double frames = 0.0;
  for (std::size_t i = 0; i < data.tested.size(); ++i) {
    if (data.tested[i]->subject != person) continue;
    const DenoiseMarks& marks = method.marks[i][which];
    protocol.push_back(marks.protocol);
    const auto n = static_cast<double>(data.tested[i]->input.frames());
    const TableNine& nine = marks.table_nine;
    const std::array<double, 3> values{nine.position, nine.bone, nine.smooth};
    for (std::size_t k = 0; k < values.size(); ++k) sums[k] += n * values[k];
    frames += n;
  }
  // protocol_row() takes the means of the other marks, some of which may be missing.
  const ProtocolMeans means = protocol_row(protocol);
  return {sums[0] / frames,   sums[1] / frames,      sums[2] / frames,
          means.position_cm,  means.fitted_cm,       means.bone_cm,
          means.constancy_cm, means.acceleration_mm, means.jitter};
}

/// The smoothness E_s of the truth itself, cm, as a mean over frames. A good answer has the same
/// value. The truth is the same for all methods, so the marks of any method give it.
double true_smoothness(const CleaningData& data, const CleanedTakes& method) {
  double sum = 0.0, frames = 0.0;
  for (std::size_t i = 0; i < data.tested.size(); ++i) {
    const auto n = static_cast<double>(data.tested[i]->input.frames());
    sum += n * method.marks[i][0].table_nine.true_smooth;
    frames += n;
  }
  return sum / frames;
}

std::set<std::string> people_of(const std::vector<const Pair*>& pairs) {
  std::set<std::string> out;
  for (const Pair* pair : pairs) out.insert(pair->subject);
  return out;
}

/// A row of table 9: mean and deviation over people. `which`: 0 for plain answers, 1 for steadied
/// ones. Statistics are over people, because frames of one person are not independent. If no
/// stretch has a mark, its cell is empty.
std::vector<Cell> marks_row(const CleaningData& data, const CleanedTakes& method,
                            std::size_t which) {
  std::array<std::vector<double>, marks_columns.size()> values;
  for (const std::string& person : people_of(data.tested)) {
    const PersonMarks marks = marks_of_person(data, method, person, which);
    for (std::size_t c = 0; c < marks.size(); ++c) {
      if (marks[c]) values[c].push_back(*marks[c]);
    }
  }
  std::vector<Cell> out{method.method + (which == 1 ? ", steadied" : "")};
  // Each mark gives two cells, mean and deviation. with_joined_deviations() relies on this order.
  for (const auto& one : values) {
    out.push_back(cell_of(mean_of(one)));
    out.push_back(one.empty() ? Cell() : Cell(deviation(one)));
  }
  return out;
}

}  // namespace

// The windows are cut, read, hashed and divided into pairs. The identity of each model depends on
// the hash of the file.
Result<CleaningData> open_cleaning(const CleaningOptions& o, Call& call) {
  KA_TRY(make_folders(o.folder + "/models"));
  CleaningData out;
  out.windows = o.folder + "/windows.npz";
  // "0": windows need no least share of valid samples. Methods must cope with missing joints, and
  // marks leave out samples without a truth.
  const WindowsWanted wanted{.data = o.data,
                             .split = o.split,
                             .where = "",
                             .input = std::string(kinect_stream),
                             .truth = std::string(true_stream),
                             .valid = "0"};
  KA_TRY(cut_windows(wanted, Learns::denoise, out.windows));
  const std::string bytes =
      KA_TRY(read_whole(call.surroundings.files, out.windows, most_bench_windows));
  out.windows_hash = sha256_of(bytes);
  out.pairs = KA_TRY(pairs_of(KA_TRY(read_windows(bytes, out.windows)), kinect_stream, true_stream,
                              least_bench_rows));
  out.layout = KA_TRY(eval_layout(out.pairs));
  // Sets sort the names, so the job does not depend on the order of the pairs.
  std::set<std::string> learnt, learnt_people, tested_takes;
  for (const Pair& pair : out.pairs.all) {
    if (pair.part == "train") {
      learnt.insert(pair.take);
      learnt_people.insert(pair.subject);
    } else if (pair.part == "test") {
      // The pointer stays valid, because `pairs` does not change any more. Moving the structure
      // does not move the elements of the vector.
      out.tested.push_back(&pair);
      tested_takes.insert(pair.take);
    }
  }
  out.learnt.assign(learnt.begin(), learnt.end());
  if (out.learnt.empty() || out.tested.empty()) {
    return Failure(Error{o.split, 0, "takes with a Kinect and mocap in the parts train and test",
                         out.learnt.empty() ? "no take to train on" : "no take to test"});
  }
  out.learnt_people = learnt_people.size();
  out.tested_takes = tested_takes.size();
  out.tested_people = people_of(out.tested).size();
  return out;
}

Result<std::vector<CleanedTakes>> run_methods(const CleaningOptions& o, const CleaningData& data,
                                              Call& call) {
  // One marker is made from all pairs, so all methods are marked in the same way.
  const DenoiseMarker marker = KA_TRY(DenoiseMarker::make(data.layout, data.pairs.all));
  std::vector<CleanedTakes> out;
  for (const std::string& method : o.methods) {
    call.console.detail(method);
    const Answer answer = KA_TRY(answer_for(o, data, method, call));
    // The default steadies in three ways: with the answer to the mirrored input, by smoothing, and
    // with constant bones.
    out.push_back(marked_answers(method, {}, data, marker, [&](std::size_t) { return answer; }));
  }
  // The user's programs run last: if one fails, the results of a long training exist already.
  for (const std::string& words : o.programs) {
    const ProgramMethod method = KA_TRY(program_method(words));
    call.console.detail(method.name);
    const auto answers = KA_TRY(answers_of_program(method, o.folder, data, call));
    // A program runs once for each stretch, so it gives no answer to the mirrored input.
    out.push_back(marked_answers(method.name, {.mirror = false}, data, marker, [&](std::size_t i) {
      return [&answers, i](const JointFrames&) { return Denoised{answers[i], {}}; };
    }));
  }
  return out;
}

/// The plan lists a training that several methods share once.
std::vector<TrainingPlan> training_plan(const CleaningOptions& o) {
  std::vector<TrainingPlan> out;
  std::set<std::string> planned;
  for (const std::string& name : o.methods) {
    const std::string method = trained_part(name);
    // If two methods need the same training, it is listed with the first one.
    if (!is_trained(name) || !planned.insert(method).second) continue;
    std::error_code fault;
    TrainingPlan plan{method, fs::exists(model_file(o, method), fault),
                      o.steps > 0 ? o.steps : own_steps, std::nullopt};
    for (const TrainingSpeed& speed : training_speeds) {
      if (speed.method == method) plan.seconds = speed.step_s * static_cast<double>(plan.steps);
    }
    out.push_back(std::move(plan));
  }
  return out;
}

// The caption has everything that a reader needs to judge the table: people, takes and the meaning
// of the columns.
Table marks_table(const CleaningData& data, const std::vector<CleanedTakes>& all) {
  Table out;
  out.caption = fmt::format(
      "Table 9: mean ± standard deviation over {} of the test part, {}. E_p, E_b and E_s are the "
      "paper's columns, for which it states no units; the truth's own E_s is {:.3f} cm",
      counted(data.tested_people, "person", "people"), counted(data.tested_takes, "take"),
      all.empty() ? 0.0 : true_smoothness(data, all.front()));
  out.columns = {{"method", "method"}};
  for (const MarksColumn& column : marks_columns) {
    out.columns.push_back({column.key, column.title, column.decimals});
    out.columns.push_back({std::string(column.key) + "_sd", "±", column.decimals});
  }
  for (const CleanedTakes& method : all) {
    // Each method has two rows: plain, then steadied.
    for (const std::size_t which : {std::size_t{0}, std::size_t{1}}) {
      out.rows.push_back(marks_row(data, method, which));
    }
  }
  return out;
}

// The first column is the method. After it, means and deviations alternate.
Table with_joined_deviations(const Table& table) {
  Table out;
  out.caption = table.caption;
  out.columns = {table.columns.front()};
  for (std::size_t c = 1; c + 1 < table.columns.size(); c += 2) {
    out.columns.push_back(table.columns[c]);
  }
  // A joined cell is text. CSV and JSON keep separate columns, so that programs can compute with
  // them.
  for (const auto& row : table.rows) {
    out.rows.push_back({row.front()});
    for (std::size_t c = 1; c + 1 < table.columns.size(); c += 2) {
      const TableColumn& column = table.columns[c];
      const std::string mean = cell_text(row[c], column);
      const bool is_known = !std::holds_alternative<std::monostate>(row[c]);
      out.rows.back().emplace_back(is_known ? mean + " ± " + cell_text(row[c + 1], column) : mean);
    }
  }
  return out;
}

std::vector<float> errors_over_time(const CleaningData& data, const Pair& pair,
                                    const std::vector<float>& answer) {
  const std::size_t joints = data.layout.outputs.size();
  const auto places = shared_joints_there(kinect_names(data.layout.outputs));
  // The factor 100 turns metres into centimetres. Joints without a valid truth do not count.
  std::vector<float> out;
  for (std::size_t t = 0; t < pair.input.frames(); ++t) {
    double sum = 0.0, count = 0.0;
    for (const auto& place : places) {
      if (!place || pair.valid[t * joints + *place] == 0) continue;
      const std::size_t at = 3 * (t * joints + *place);
      sum += static_cast<double>(std::hypot(answer[at] - pair.truth[at],
                                            answer[at + 1] - pair.truth[at + 1],
                                            answer[at + 2] - pair.truth[at + 2]));
      count += 1.0;
    }
    out.push_back(count > 0.0 ? static_cast<float>(100.0 * sum / count) : 0.0F);
  }
  return out;
}

}  // namespace kinalign
