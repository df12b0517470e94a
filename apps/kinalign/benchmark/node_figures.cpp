// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/benchmark/node_figures.h"

#include "apps/cli/console.h"
#include "apps/kinalign/benchmark/compared_motion.h"
#include "apps/kinalign/dataset/dataset_folder.h"
#include "apps/kinalign/learn/shipped_models.h"
#include "apps/kinalign/text/counts_text.h"
#include "apps/kinalign/verbs/describe_model.h"

#include "kinalign/dataset/scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <set>

namespace kinalign {

namespace {

/// More takes would make the run long without changing the means much.
constexpr std::size_t most_compared_takes = 12;
/// Instants that a figure shows.
constexpr std::size_t instants = 5;
constexpr double turn_bend_deg = 180.0 / std::numbers::pi;
/// Indices in compared_places.
constexpr std::size_t head_place = 2, nose_place = 15;

/// Joints whose mean distance to the truth is one column.
struct JointGroup {
  const char *key, *title;
  std::vector<std::size_t> places;
};

/// The first group is also the one of single frames' errors.
const std::vector<JointGroup>& joint_groups() {
  static const std::vector<JointGroup> all{
      // Places 0, 1, 9 and 12 (trunk and hips) are left out. Bodies are compared with the middle of
      // the hips in one place.
      {"all_cm", "all, cm", {2, 3, 4, 5, 6, 7, 8, 10, 11, 13, 14}},
      {"shoulders_cm", "shoulders, cm", {3, 6}},
      {"elbows_cm", "elbows, cm", {4, 7}},
      {"wrists_cm", "wrists, cm", {5, 8}},
      {"knees_cm", "knees, cm", {10, 13}},
      {"ankles_cm", "ankles, cm", {11, 14}},
      {"head_cm", "head, cm", {2}}};
  return all;
}

double distance_cm(const BodyPlaces& a, const BodyPlaces& b, std::size_t cell) {
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double apart = static_cast<double>(a[3 * cell + k] - b[3 * cell + k]);
    sum += apart * apart;
  }
  return 100.0 * std::sqrt(sum);
}

/// The angle between the directions in which two heads look in frame `t`, degrees.
/// The direction of look goes from the head's joint to the nose.
double look_apart_deg(const BodyPlaces& a, const BodyPlaces& b, std::size_t t) {
  double dot = 0.0, aa = 0.0, bb = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    // Cells are numbered frame by frame: t * 17 + place.
    const std::size_t nose = 3 * (t * compared_count + nose_place) + k,
                      head = 3 * (t * compared_count + head_place) + k;
    const auto x = static_cast<double>(a[nose] - a[head]),
               y = static_cast<double>(b[nose] - b[head]);
    dot += x * y;
    aa += x * x;
    bb += y * y;
  }
  // Rounding may put the cosine slightly above 1, for which acos is not defined. 1e-12 keeps a body
  // without a head from dividing by zero.
  const double cosine = dot / std::sqrt(std::max(aa * bb, 1e-12));
  return turn_bend_deg * std::acos(std::clamp(cosine, -1.0, 1.0));
}

/// The mean distance to the truth over the first joint group in one frame, cm.
double frame_error_cm(const ComparedMotion& motion, std::size_t answer, std::size_t t) {
  const auto& all = joint_groups().front().places;
  double sum = 0.0;
  for (const std::size_t p : all) {
    sum += distance_cm(motion.truth, motion.answers[answer], t * compared_count + p);
  }
  return sum / static_cast<double>(all.size());
}

/// The mean over the cells of all motions for which `counts` is true; absent if there is none.
/// All cells of all takes weigh the same, so a long take counts more than a short one.
std::optional<double> mean_distance(
    const std::vector<ComparedMotion>& motions, std::size_t answer,
    const std::vector<std::size_t>& places,
    const std::function<bool(const ComparedMotion&, std::size_t cell)>& counts) {
  double sum = 0.0, count = 0.0;
  for (const ComparedMotion& motion : motions) {
    for (std::size_t t = 0; t < motion.frames; ++t) {
      for (const std::size_t p : places) {
        const std::size_t cell = t * compared_count + p;
        if (!counts(motion, cell)) continue;
        sum += distance_cm(motion.truth, motion.answers[answer], cell);
        count += 1.0;
      }
    }
  }
  return count > 0.0 ? std::optional(sum / count) : std::nullopt;
}

/// The mean angle between the answer's and the truth's direction of look, degrees.
double mean_look_deg(const std::vector<ComparedMotion>& motions, std::size_t answer) {
  double sum = 0.0, count = 0.0;
  for (const ComparedMotion& motion : motions) {
    for (std::size_t t = 0; t < motion.frames; ++t) {
      sum += look_apart_deg(motion.truth, motion.answers[answer], t);
      count += 1.0;
    }
  }
  return sum / std::max(count, 1.0);
}

/// An absent mean gives an empty cell and not a zero, which would look like a perfect answer.
Cell cell_of(const std::optional<double>& value) { return value ? Cell(*value) : Cell(); }

/// Frame `t` as a figure for a picture.
StickFigure figure_of(const BodyPlaces& places, std::size_t t, FigureColour colour) {
  const auto first = places.begin() + static_cast<std::ptrdiff_t>(3 * compared_count * t);
  StickFigure out{colour, false, {first, first + 3 * compared_count}, {}, {}};
  out.parents.assign(compared_parents.begin(), compared_parents.end());
  return out;
}

/// Frame `t` of the Kinect; missing joints are left out.
/// Only answers.front() of a device figure is a Kinect, so only it has states.
StickFigure seen_figure_of(const ComparedMotion& motion, std::size_t t) {
  StickFigure out = figure_of(motion.answers.front(), t, FigureColour::kinect);
  const auto first = motion.states.begin() + static_cast<std::ptrdiff_t>(compared_count * t);
  out.states.assign(first, first + compared_count);
  return out;
}

/// The truth is drawn first and pale, so the answer lies over it.
PosePicture answer_over_truth(const ComparedMotion& motion, std::size_t t, StickFigure answer,
                              std::string below) {
  StickFigure truth = figure_of(motion.truth, t, FigureColour::truth);
  truth.is_pale = true;
  return {{std::move(truth), std::move(answer)}, std::move(below)};
}

std::string second_of(const ComparedMotion& motion, std::size_t t) {
  return fmt::format("{:.1f} s", static_cast<double>(t) / motion.rate_hz);
}

/// Five frames, spread evenly over a stretch.
std::array<std::size_t, instants> even_instants(std::size_t from, std::size_t to) {
  std::array<std::size_t, instants> out{};
  for (std::size_t i = 0; i < instants; ++i) {
    // The instants are the middles of five equal parts: the first and the last frame are never
    // shown.
    out[i] = from + (to - from) * (2 * i + 1) / (2 * instants);
  }
  return out;
}

/// The takes that a figure is made from.
struct FigureTakes {
  std::vector<ComparedTake> nodes, both;  // with nodes; with nodes and a Kinect
  // False if no test person has such a take. The page then states that the takes are not of test
  // people.
  bool nodes_tested = true, both_tested = true;
};

/// The first takes of test people; if test people have none, the first of all takes.
/// Takes of test people are preferred, since a model that was trained on this split has not seen
/// them.
std::vector<ComparedTake> preferred(std::vector<std::pair<ComparedTake, bool>> all,
                                    bool& are_tested) {
  are_tested = std::any_of(all.begin(), all.end(), [](const auto& one) { return one.second; });
  std::vector<ComparedTake> out;
  for (auto& [take, is_tested] : all) {
    if (is_tested == are_tested && out.size() < most_compared_takes) out.push_back(std::move(take));
  }
  return out;
}

/// The takes of the data set that have nodes.
Result<FigureTakes> figure_takes(const NodeFigureOptions& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  const DatasetIndex index = KA_TRY(open_index(o.data, call));
  const auto takes = KA_TRY(built_takes(files, o.data, index, ""));
  std::set<TakeName> tested;
  // A take belongs to a test person if the split's part "test" names it.
  for (const SplitPart& part : KA_TRY(read_split(files, o.split)).parts) {
    if (part.name == "test") tested.insert(part.takes.begin(), part.takes.end());
  }
  std::vector<std::pair<ComparedTake, bool>> nodes, both;
  for (const SplitTake& take : takes) {
    if (!take.summary.has(Modality::imu)) continue;
    const std::pair one{
        ComparedTake{to_string(take.name), path_of(o.data, take.name, TakeFile::take)},
        tested.contains(take.name)};
    // A take with a Kinect and nodes serves all three figures.
    nodes.push_back(one);
    if (take.summary.has(Modality::kinect)) both.push_back(one);
  }
  FigureTakes out;
  out.nodes = preferred(std::move(nodes), out.nodes_tested);
  out.both = preferred(std::move(both), out.both_tested);
  return out;
}

/// Reads and builds the model. A model that can't be used fails here, before any take is read.
Result<PoseSolver> pose_solver(const std::string& path, Call& call) {
  const std::string bytes = KA_TRY(read_whole(call.surroundings.files, path, most_model_bytes));
  return PoseSolver::make(KA_TRY(read_pose_model(bytes, path)));
}

/// The motions of takes that could be answered, and the reason why others could not.
struct AnsweredTakes {
  std::vector<ComparedMotion> motions;
  bool are_tested = true;  // the takes are of test people
  std::size_t failed = 0;
  std::string fault;  // the fault of the first failed take

  /// The note for the page; empty if all takes were answered.
  std::string note() const {
    if (failed == 0) return "";
    return fmt::format("{} left out: {}.", counted(failed, "take was", "takes were"), fault);
  }
};

/// Compares all takes. A take that fails is counted, and stops no other.
/// The page is worth having even if some takes can't be answered. The first fault stands for all of
/// them in the note.
AnsweredTakes answered(const std::vector<ComparedTake>& takes, bool are_tested,
                       const std::function<Result<ComparedMotion>(const ComparedTake&)>& compare) {
  AnsweredTakes out;
  out.are_tested = are_tested;
  for (const ComparedTake& take : takes) {
    auto motion = compare(take);
    if (motion) {
      out.motions.push_back(std::move(*motion));
      continue;
    }
    if (out.failed == 0) out.fault = to_string(motion.error());
    ++out.failed;
  }
  return out;
}

std::string takes_text(const AnsweredTakes& all) {
  const bool are_tested = all.are_tested;
  return counted(all.motions.size(), are_tested ? "take of test people" : "take",
                 are_tested ? "takes of test people" : "takes");
}

const std::string how_compared =
    "Both bodies are drawn with the middle of their hips in one place, facing forward; red: the "
    "truth. The answer has the bone lengths of the model's training people, so a part of the "
    "distance comes from bone lengths.";

/// Figure 8: answers of a model for five nodes.
PosePictures pose_figure(const AnsweredTakes& all) {
  const auto& motions = all.motions;
  PosePictures out;
  out.id = "figure-8";
  out.title = "Figure 8: the pose from five nodes";
  // A figure without data keeps its title and says why it is empty, so the page has the same parts
  // on every data set.
  if (motions.empty()) {
    out.absent = "No take has the nodes that the model needs. " + all.note();
    return out;
  }
  out.absent = all.note();
  const ComparedMotion& shown = motions.front();
  out.caption = fmt::format(
      "{}, five instants evenly over the take. Blue: the answer to five "
      "nodes. {}",
      shown.take, how_compared);
  out.rows = {{"five nodes", {}}, {"truth", {}}};
  // The pictures show the first take that could be answered. The table is over all of them.
  for (const std::size_t t : even_instants(0, shown.frames)) {
    out.columns.emplace_back(second_of(shown, t), "");
    out.rows[0].second.push_back(
        answer_over_truth(shown, t, figure_of(shown.answers[0], t, FigureColour::imu),
                          fmt::format("{:.1f} cm", frame_error_cm(shown, 0, t))));
    out.rows[1].second.push_back({{figure_of(shown.truth, t, FigureColour::truth)}, ""});
  }
  Table table;
  table.caption = "Mean distance to the truth over " + takes_text(all);
  table.columns = {{"answer", "answer"}};
  table.rows = {{std::string("five nodes")}};
  for (const JointGroup& group : joint_groups()) {
    table.columns.push_back({group.key, group.title, 1});
    table.rows[0].push_back(cell_of(mean_distance(
        motions, 0, group.places, [](const ComparedMotion&, std::size_t) { return true; })));
  }
  out.tables = {table};
  return out;
}

/// The frames in which the true head looks farthest aside, one in each fifth of the take.
/// "Aside" is the distance from head to nose to the left or right and up or down. Straight ahead it
/// is near zero.
std::array<std::size_t, instants> head_instants(const ComparedMotion& motion) {
  std::array<std::size_t, instants> out{};
  for (std::size_t i = 0; i < instants; ++i) {
    double most = -1.0;
    // One frame of each fifth spreads the instants over the take.
    for (std::size_t t = motion.frames * i / instants; t < motion.frames * (i + 1) / instants;
         ++t) {
      const std::size_t nose = 3 * (t * compared_count + nose_place),
                        head = 3 * (t * compared_count + head_place);
      const double aside =
          static_cast<double>(std::hypot(motion.truth[nose] - motion.truth[head],
                                         motion.truth[nose + 1] - motion.truth[head + 1]));
      if (aside <= most) continue;
      most = aside;
      out[i] = t;
    }
  }
  return out;
}

/// Figure 9: the head in answers without and with a node on it.
PosePictures head_figure(const AnsweredTakes& all, bool has_head_model) {
  const auto& motions = all.motions;
  PosePictures out;
  out.id = "figure-9";
  out.title = "Figure 9: the head without and with a node on it";
  if (motions.empty()) {
    out.absent = "No take has the nodes that the model needs. " + all.note();
    return out;
  }
  // A missing second model is no reason to leave the figure out: the first row still shows the head
  // without a node.
  if (!has_head_model) {
    out.absent =
        "No model with a node on the head was given. kinalign train inertial --nodes "
        "wrist_left,wrist_right,ankle_left,ankle_right,head,waist makes one; --head-model names "
        "it.";
  }
  const ComparedMotion& shown = motions.front();
  out.caption = fmt::format(
      "{}, in each fifth of the take the instant at which the true head is turned furthest to the "
      "side. The line from the head is its direction of look. Below: degrees between the answer's "
      "and the "
      "truth's direction of look. {} {}",
      shown.take,
      has_head_model ? "The data has no node on the head: one without errors is computed from the "
                       "truth. The two models may have been trained on different people."
                     : "",
      how_compared);
  // The number of answers is that of the models, in the order of make_pose_figures().
  const std::vector<std::string> names =
      has_head_model ? std::vector<std::string>{"five nodes", "and one on the head"}
                     : std::vector<std::string>{"five nodes"};
  Table table;
  table.caption = "The head over " + takes_text(all);
  table.columns = {
      {"answer", "answer"}, {"look_deg", "direction of look, °", 1}, {"head_cm", "head, cm", 1}};
  for (std::size_t a = 0; a < names.size(); ++a) {
    out.rows.emplace_back(names[a], std::vector<PosePicture>{});
    table.rows.push_back(
        {names[a], mean_look_deg(motions, a),
         cell_of(mean_distance(motions, a, {head_place},
                               [](const ComparedMotion&, std::size_t) { return true; }))});
  }
  out.rows.emplace_back("truth", std::vector<PosePicture>{});
  for (const std::size_t t : head_instants(shown)) {
    out.columns.emplace_back(second_of(shown, t), "");
    for (std::size_t a = 0; a < names.size(); ++a) {
      out.rows[a].second.push_back(answer_over_truth(
          shown, t, figure_of(shown.answers[a], t, FigureColour::imu),
          fmt::format("{:.0f}°", look_apart_deg(shown.truth, shown.answers[a], t))));
    }
    out.rows.back().second.push_back({{figure_of(shown.truth, t, FigureColour::truth)}, ""});
  }
  out.tables = {table};
  return out;
}

// The order must be that of compare_devices(): the Kinect's own joints, then the three answers of
// the model.
constexpr std::array<const char*, 4> device_rows{"Kinect as it is", "Kinect alone", "nodes alone",
                                                 "both"};
constexpr std::array<FigureColour, 4> device_colours{FigureColour::kinect, FigureColour::kinect,
                                                     FigureColour::imu, FigureColour::both};

/// A cell counts as seen only if the Kinect of the take tracked or inferred the joint in that
/// frame.
bool is_seen_place(const ComparedMotion& motion, std::size_t cell) {
  return motion.states[cell] != 0;
}

/// The table of figure 10: mean distances over all, hidden and seen joints.
Table device_table(const AnsweredTakes& all) {
  const auto& motions = all.motions;
  Table table;
  table.caption = fmt::format(
      "Mean distance to the truth over {}, in which limbs are hidden from the Kinect for 3 s, one "
      "after the other. Kinect as it is: a hidden joint keeps the position at which it was last "
      "seen",
      takes_text(all));
  table.columns = {{"answer", "answer"},
                   {"all_cm", "all, cm", 1},
                   {"hidden_cm", "hidden joints, cm", 1},
                   {"seen_cm", "seen joints, cm", 1}};
  const auto& joints = joint_groups().front().places;
  const auto any = [](const ComparedMotion&, std::size_t) { return true; };
  const auto hidden = [](const ComparedMotion& motion, std::size_t cell) {
    return motion.hidden[cell] != 0;
  };
  // Each row is one answer; the columns split the same joints into hidden and seen ones.
  for (std::size_t a = 0; a < device_rows.size(); ++a) {
    table.rows.push_back({std::string(device_rows[a]),
                          cell_of(mean_distance(motions, a, joints, any)),
                          cell_of(mean_distance(motions, a, joints, hidden)),
                          cell_of(mean_distance(motions, a, joints, is_seen_place))});
  }
  return table;
}

/// The first stretch in which a limb is hidden; the whole motion if nothing is hidden.
/// The picture shows one hidden stretch only, so that all instants are about the same limb.
std::pair<std::size_t, std::size_t> first_hidden(const ComparedMotion& motion) {
  const auto is_hidden_frame = [&](std::size_t t) {
    const auto first = motion.hidden.begin() + static_cast<std::ptrdiff_t>(t * compared_count);
    return std::any_of(first, first + compared_count, [](std::uint8_t one) { return one != 0; });
  };
  std::size_t from = 0;
  while (from < motion.frames && !is_hidden_frame(from)) ++from;
  std::size_t to = from;
  while (to < motion.frames && is_hidden_frame(to)) ++to;
  return from < to ? std::pair(from, to) : std::pair(std::size_t{0}, motion.frames);
}

/// Figure 10: answers to a Kinect, to nodes and to both, while a limb is hidden.
PosePictures device_figure(const AnsweredTakes& all) {
  const auto& motions = all.motions;
  PosePictures out;
  out.id = "figure-10";
  out.title = "Figure 10: a Kinect, nodes, and both, while the Kinect loses a limb";
  if (motions.empty()) {
    out.absent = "No take has the Kinect and the nodes that the model needs. " + all.note();
    return out;
  }
  out.absent = all.note();
  const ComparedMotion& shown = motions.front();
  const auto [from, to] = first_hidden(shown);
  out.caption = fmt::format(
      "{}: the right arm is hidden from the Kinect from {} to {}. One model computes the pose from "
      "the Kinect alone, from the nodes alone and from both. Below: mean distance to the truth. {}",
      shown.take, second_of(shown, from), second_of(shown, to), how_compared);
  for (const char* name : device_rows) out.rows.emplace_back(name, std::vector<PosePicture>{});
  out.rows.emplace_back("truth", std::vector<PosePicture>{});
  for (const std::size_t t : even_instants(from, to)) {
    out.columns.emplace_back(second_of(shown, t), "");
    for (std::size_t a = 0; a < device_rows.size(); ++a) {
      StickFigure answer =
          a == 0 ? seen_figure_of(shown, t) : figure_of(shown.answers[a], t, device_colours[a]);
      // Only the first row is the raw Kinect: its hidden joints are left out instead of standing
      // still.
      out.rows[a].second.push_back(answer_over_truth(
          shown, t, std::move(answer), fmt::format("{:.1f} cm", frame_error_cm(shown, a, t))));
    }
    out.rows.back().second.push_back({{figure_of(shown.truth, t, FigureColour::truth)}, ""});
  }
  out.tables = {device_table(all)};
  return out;
}

/// The path of a model: the given one, else the shipped one. Empty if neither exists.
/// A shipped model makes the figures work without any flag.
std::string model_or_shipped(const std::string& given, const std::string& name) {
  if (!given.empty()) return given;
  return shipped_model(name).value_or("");
}

PosePictures without_model(PosePictures figure, const std::string& how) {
  figure.absent = "No model was given, and the program has no shipped model. " + how;
  return figure;
}

/// Figure 10, or the note that no model is there for it.
Result<PosePictures> make_device_figure(const NodeFigureOptions& o, const FigureTakes& takes,
                                        Call& call) {
  // A fusion model is needed for all rows but the first, so without one the whole figure is left
  // out.
  const std::string path = model_or_shipped(o.fuse_model, "fuse");
  if (path.empty()) {
    return without_model(device_figure({}),
                         "kinalign train gated makes one; --fuse-model names it.");
  }
  const std::string bytes = KA_TRY(read_whole(call.surroundings.files, path, most_model_bytes));
  Fuser fuser = KA_TRY(Fuser::make(KA_TRY(read_fuse_model(bytes, path))));
  return device_figure(answered(takes.both, takes.both_tested, [&](const ComparedTake& take) {
    return compare_devices(fuser, take, call);
  }));
}

/// Figures 8 and 9, or notes that no model is there for them.
Result<std::vector<PosePictures>> make_pose_figures(const NodeFigureOptions& o,
                                                    const FigureTakes& takes, Call& call) {
  const std::string path = model_or_shipped(o.pose_model, "pose");
  if (path.empty()) {
    const std::string how = "kinalign train inertial makes one; --pose-model names it.";
    return std::vector<PosePictures>{without_model(pose_figure({}), how),
                                     without_model(head_figure({}, false), how)};
  }
  std::vector<PoseSolver> solvers;
  solvers.push_back(KA_TRY(pose_solver(path, call)));
  const std::string with_head = model_or_shipped(o.head_model, "pose_head");
  if (!with_head.empty()) {
    solvers.push_back(KA_TRY(pose_solver(with_head, call)));
    const auto& nodes = solvers.back().model().layout.nodes;
    // A model without this node would give the same answer as the first one, under a wrong title.
    if (std::find(nodes.begin(), nodes.end(), "head") == nodes.end()) {
      return Failure(
          Error{with_head, 0, "a model with a node on the head", "a model without this node"});
    }
  }
  const AnsweredTakes all =
      answered(takes.nodes, takes.nodes_tested,
               [&](const ComparedTake& take) { return compare_poses(solvers, take, call); });
  // Both figures come from the same answers, so each take is read once.
  return std::vector<PosePictures>{pose_figure(all), head_figure(all, solvers.size() > 1)};
}

}  // namespace

Result<std::vector<PosePictures>> node_figures(const NodeFigureOptions& o, Call& call) {
  // The figures stand on the page in this order: 8, 9, 10.
  const FigureTakes takes = KA_TRY(figure_takes(o, call));
  auto out = KA_TRY(make_pose_figures(o, takes, call));
  out.push_back(KA_TRY(make_device_figure(o, takes, call)));
  return out;
}

}  // namespace kinalign
