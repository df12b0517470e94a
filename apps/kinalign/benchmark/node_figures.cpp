// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/benchmark/node_figures.h"

#include "apps/kinalign/benchmark/compared_motion.h"
#include "apps/kinalign/dataset/dataset_folder.h"
#include "apps/kinalign/learn/shipped_models.h"
#include "apps/kinalign/text/counts_text.h"
#include "apps/kinalign/verbs/describe_model.h"

#include "kinalign/dataset/scan.h"

#include <Eigen/Core>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <set>

namespace kinalign {

namespace {

/// The figures use at most this number of takes. More takes would take longer and hardly change the
/// means.
constexpr std::size_t most_compared_takes = 12;
/// The number of moments that a figure shows.
constexpr std::size_t instants = 5;
constexpr double turn_bend_deg = 180.0 / std::numbers::pi;
/// Indices of head and nose in compared_places.
constexpr std::size_t head_place = 2, nose_place = 15;

/// A group of joints. Their mean distance to the truth is one column of the table.
struct JointGroup {
  const char *key, *title;
  std::vector<std::size_t> places;
};

/// All groups. The errors of single frames are means over the first group.
const std::vector<JointGroup>& joint_groups() {
  static const std::vector<JointGroup> all{
      // Points 0, 1, 9 and 12 (trunk and hips) are left out, because bodies are compared with the
      // middle of the hips at the same position.
      {"all_cm", "all, cm", {2, 3, 4, 5, 6, 7, 8, 10, 11, 13, 14}},
      {"shoulders_cm", "shoulders, cm", {3, 6}},
      {"elbows_cm", "elbows, cm", {4, 7}},
      {"wrists_cm", "wrists, cm", {5, 8}},
      {"knees_cm", "knees, cm", {10, 13}},
      {"ankles_cm", "ankles, cm", {11, 14}},
      {"head_cm", "head, cm", {2}}};
  return all;
}

/// The position of a point. `cell` is frame * 17 + point.
Eigen::Vector3d place_at(const BodyPlaces& places, std::size_t cell) {
  return Eigen::Vector3f(&places[3 * cell]).cast<double>();
}

double distance_cm(const BodyPlaces& a, const BodyPlaces& b, std::size_t cell) {
  return 100.0 * (place_at(a, cell) - place_at(b, cell)).norm();
}

/// The direction in which the head looks in frame `t`: from the head's joint to the nose.
Eigen::Vector3d look_at(const BodyPlaces& places, std::size_t t) {
  const std::size_t first = t * compared_count;
  return place_at(places, first + nose_place) - place_at(places, first + head_place);
}

/// The angle between the directions of two heads in frame `t`, degrees.
double look_apart_deg(const BodyPlaces& a, const BodyPlaces& b, std::size_t t) {
  // Rounding may make the cosine slightly larger than 1, for which acos is not defined.
  const double cosine = look_at(a, t).normalized().dot(look_at(b, t).normalized());
  return turn_bend_deg * std::acos(std::clamp(cosine, -1.0, 1.0));
}

/// The error of an answer in one frame, cm: the mean distance to the truth over the first group.
double frame_error_cm(const ComparedMotion& motion, std::size_t answer, std::size_t t) {
  const auto& all = joint_groups().front().places;
  double sum = 0.0;
  for (const std::size_t p : all) {
    sum += distance_cm(motion.truth, motion.answers[answer], t * compared_count + p);
  }
  return sum / static_cast<double>(all.size());
}

/// The mean distance over all cells of all takes for which `counts` is true. Empty if there is no
/// such cell. All cells have the same weight, so a long take counts more than a short one.
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

/// The mean angle between the directions of the answer's head and of the truth's head, degrees.
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

/// The body of frame `t` for a picture.
StickFigure figure_of(const BodyPlaces& places, std::size_t t, FigureColour colour) {
  const auto first = places.begin() + static_cast<std::ptrdiff_t>(3 * compared_count * t);
  StickFigure out{colour, false, {first, first + 3 * compared_count}, {}, {}};
  out.parents.assign(compared_parents.begin(), compared_parents.end());
  return out;
}

/// The body that the Kinect saw in frame `t`; missing joints are left out. answers.front() must be
/// the Kinect, because only the Kinect has states.
StickFigure seen_figure_of(const ComparedMotion& motion, std::size_t t) {
  StickFigure out = figure_of(motion.answers.front(), t, FigureColour::kinect);
  const auto first = motion.states.begin() + static_cast<std::ptrdiff_t>(compared_count * t);
  out.states.assign(first, first + compared_count);
  return out;
}

std::string second_of(const ComparedMotion& motion, std::size_t t) {
  return fmt::format("{:.1f} s", static_cast<double>(t) / motion.rate_hz);
}

/// Five frames at equal distances within a stretch.
std::array<std::size_t, instants> even_instants(std::size_t from, std::size_t to) {
  std::array<std::size_t, instants> out{};
  for (std::size_t i = 0; i < instants; ++i) {
    // The frames are the middles of five equal parts, so the first and the last frame are never
    // shown.
    out[i] = from + (to - from) * (2 * i + 1) / (2 * instants);
  }
  return out;
}

/// The takes from which the figures are made.
struct FigureTakes {
  std::vector<ComparedTake> nodes, both;  // takes with nodes; takes with nodes and a Kinect
  // False if no test person has such a take. The page then says that its takes are not of test
  // people.
  bool nodes_tested = true, both_tested = true;
};

/// Chooses the first takes of test people, because a model trained with this split has not seen
/// them. If test people have no takes, chooses the first of all takes.
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
  // A take belongs to a test person if the part "test" of the split names the take.
  for (const SplitPart& part : KA_TRY(read_split(files, o.split)).parts) {
    if (part.name == "test") tested.insert(part.takes.begin(), part.takes.end());
  }
  std::vector<std::pair<ComparedTake, bool>> nodes, both;
  for (const SplitTake& take : takes) {
    if (!take.summary.has(Modality::imu)) continue;
    const std::pair one{
        ComparedTake{to_string(take.name), path_of(o.data, take.name, TakeFile::take)},
        tested.contains(take.name)};
    // A take with a Kinect and nodes can be used for all three figures.
    nodes.push_back(one);
    if (take.summary.has(Modality::kinect)) both.push_back(one);
  }
  FigureTakes out;
  out.nodes = preferred(std::move(nodes), out.nodes_tested);
  out.both = preferred(std::move(both), out.both_tested);
  return out;
}

/// Reads and builds a model. If it can't be used, the run fails here, before any take is read.
Result<PoseSolver> pose_solver(const std::string& path, Call& call) {
  const std::string bytes = KA_TRY(read_whole(call.surroundings.files, path, most_model_bytes));
  return PoseSolver::make(KA_TRY(read_pose_model(bytes, path)));
}

/// The takes for which the models have answered, and the reason why others failed.
struct AnsweredTakes {
  std::vector<ComparedMotion> motions;
  bool are_tested = true;  // true: the takes are of test people
  std::size_t failed = 0;
  std::string fault;  // the reason of the first take that failed

  /// A note for the page. Empty if no take failed.
  std::string note() const {
    if (failed == 0) return "";
    return fmt::format("{} left out: {}.", counted(failed, "take was", "takes were"), fault);
  }
};

/// Runs the models on all takes. A take that fails is only counted, because the page is useful
/// without it. The note states the reason of the first one.
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

/// Begins a figure. A figure without data keeps its title and says why it is empty, so that the
/// page always has the same parts. `lacks`: what is missing, such as "the nodes".
PosePictures begun_figure(int number, const std::string& title, const std::string& lacks,
                          const AnsweredTakes& all) {
  PosePictures out;
  out.id = fmt::format("figure-{}", number);
  out.title = fmt::format("Figure {}: {}", number, title);
  out.absent = all.note();
  if (all.motions.empty()) {
    out.absent = fmt::format("No take has {} that the model needs. ", lacks) + out.absent;
  }
  return out;
}

/// A row of pictures. Each picture shows an answer over the truth in one frame, with a text below.
struct AnswerRow {
  std::string name;
  std::function<StickFigure(std::size_t t)> figure;
  std::function<std::string(std::size_t t)> below;
};

/// Adds a column for each moment and all rows of pictures. The last row shows the truth.
void add_pictures(const ComparedMotion& shown, const std::array<std::size_t, instants>& times,
                  const std::vector<AnswerRow>& rows, PosePictures& out) {
  for (const AnswerRow& row : rows) out.rows.emplace_back(row.name, std::vector<PosePicture>{});
  out.rows.emplace_back("truth", std::vector<PosePicture>{});
  for (const std::size_t t : times) {
    out.columns.emplace_back(second_of(shown, t), "");
    StickFigure truth = figure_of(shown.truth, t, FigureColour::truth);
    out.rows.back().second.push_back({{truth}, ""});
    // The truth is pale and drawn first, so that the answer lies over it.
    truth.is_pale = true;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      out.rows[r].second.push_back({{truth, rows[r].figure(t)}, rows[r].below(t)});
    }
  }
}

/// The row of an answer to nodes.
AnswerRow nodes_row(const std::string& name, const ComparedMotion& shown, std::size_t answer,
                    std::function<std::string(std::size_t t)> below) {
  return {name,
          [&shown, answer](std::size_t t) {
            return figure_of(shown.answers[answer], t, FigureColour::imu);
          },
          std::move(below)};
}

std::string error_text(const ComparedMotion& shown, std::size_t answer, std::size_t t) {
  return fmt::format("{:.1f} cm", frame_error_cm(shown, answer, t));
}

bool is_any(const ComparedMotion&, std::size_t) { return true; }

/// Figure 8: the answers of a model for five nodes.
PosePictures pose_figure(const AnsweredTakes& all) {
  const auto& motions = all.motions;
  PosePictures out = begun_figure(8, "the pose from five nodes", "the nodes", all);
  if (motions.empty()) return out;
  // The pictures show the first take that has answers. The table is over all takes.
  const ComparedMotion& shown = motions.front();
  out.caption =
      fmt::format("{}, five instants evenly over the take. Blue: the answer to five nodes. {}",
                  shown.take, how_compared);
  add_pictures(shown, even_instants(0, shown.frames),
               {nodes_row("five nodes", shown, 0,
                          [&shown](std::size_t t) { return error_text(shown, 0, t); })},
               out);
  Table table;
  table.caption = "Mean distance to the truth over " + takes_text(all);
  table.columns = {{"answer", "answer"}};
  table.rows = {{std::string("five nodes")}};
  for (const JointGroup& group : joint_groups()) {
    table.columns.push_back({group.key, group.title, 1});
    table.rows[0].push_back(cell_of(mean_distance(motions, 0, group.places, is_any)));
  }
  out.tables = {table};
  return out;
}

/// The frames in which the true head looks farthest aside, one frame in each fifth of the take. The
/// measure is the distance from head to nose to the side, up or down; it is near zero straight
/// ahead.
std::array<std::size_t, instants> head_instants(const ComparedMotion& motion) {
  std::array<std::size_t, instants> out{};
  for (std::size_t i = 0; i < instants; ++i) {
    double most = -1.0;
    // One frame comes from each fifth, so that the frames are spread over the take.
    for (std::size_t t = motion.frames * i / instants; t < motion.frames * (i + 1) / instants;
         ++t) {
      const double aside = look_at(motion.truth, t).head<2>().norm();
      if (aside <= most) continue;
      most = aside;
      out[i] = t;
    }
  }
  return out;
}

/// Figure 9: the head in answers without and with a node on the head.
PosePictures head_figure(const AnsweredTakes& all, bool has_head_model) {
  const auto& motions = all.motions;
  PosePictures out = begun_figure(9, "the head without and with a node on it", "the nodes", all);
  if (motions.empty()) return out;
  out.absent.clear();  // figure 8 has the note about failed takes
  // Without the second model the figure still has its first row, the head without a node.
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
      "and the truth's direction of look. {} {}",
      shown.take,
      has_head_model ? "The data has no node on the head: one without errors is computed from the "
                       "truth. The two models may have been trained on different people."
                     : "",
      how_compared);
  // There is one answer for each model, in the order of make_pose_figures().
  const std::vector<std::string> names =
      has_head_model ? std::vector<std::string>{"five nodes", "and one on the head"}
                     : std::vector<std::string>{"five nodes"};
  Table table;
  table.caption = "The head over " + takes_text(all);
  table.columns = {
      {"answer", "answer"}, {"look_deg", "direction of look, °", 1}, {"head_cm", "head, cm", 1}};
  std::vector<AnswerRow> rows;
  for (std::size_t a = 0; a < names.size(); ++a) {
    rows.push_back(nodes_row(names[a], shown, a, [&shown, a](std::size_t t) {
      return fmt::format("{:.0f}°", look_apart_deg(shown.truth, shown.answers[a], t));
    }));
    table.rows.push_back({names[a], mean_look_deg(motions, a),
                          cell_of(mean_distance(motions, a, {head_place}, is_any))});
  }
  add_pictures(shown, head_instants(shown), rows, out);
  out.tables = {table};
  return out;
}

// The order is that of compare_devices(): the Kinect's own joints, then the three answers of the
// model.
constexpr std::array<const char*, 4> device_rows{"Kinect as it is", "Kinect alone", "nodes alone",
                                                 "both"};
constexpr std::array<FigureColour, 4> device_colours{FigureColour::kinect, FigureColour::kinect,
                                                     FigureColour::imu, FigureColour::both};

/// True if the Kinect of the take tracked or inferred this joint in this frame.
bool is_seen_place(const ComparedMotion& motion, std::size_t cell) {
  return motion.states[cell] != 0;
}

/// The table of figure 10: the mean distances over all joints, over hidden joints and over seen
/// joints.
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
  const auto hidden = [](const ComparedMotion& motion, std::size_t cell) {
    return motion.hidden[cell] != 0;
  };
  // Each row is one answer. The second and third column divide the joints of the first into hidden
  // and seen ones.
  for (std::size_t a = 0; a < device_rows.size(); ++a) {
    table.rows.push_back({std::string(device_rows[a]),
                          cell_of(mean_distance(motions, a, joints, is_any)),
                          cell_of(mean_distance(motions, a, joints, hidden)),
                          cell_of(mean_distance(motions, a, joints, is_seen_place))});
  }
  return table;
}

/// The first stretch in which a limb is hidden. All pictures are from this stretch, so that they
/// show the same limb. If no limb is hidden, the stretch is the whole motion.
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

/// Figure 10: the answers to a Kinect, to nodes and to both, while a limb is hidden.
PosePictures device_figure(const AnsweredTakes& all) {
  const auto& motions = all.motions;
  PosePictures out = begun_figure(10, "a Kinect, nodes, and both, while the Kinect loses a limb",
                                  "the Kinect and the nodes", all);
  if (motions.empty()) return out;
  const ComparedMotion& shown = motions.front();
  const auto [from, to] = first_hidden(shown);
  out.caption = fmt::format(
      "{}: the right arm is hidden from the Kinect from {} to {}. One model computes the pose from "
      "the Kinect alone, from the nodes alone and from both. Below: mean distance to the truth. {}",
      shown.take, second_of(shown, from), second_of(shown, to), how_compared);
  std::vector<AnswerRow> rows;
  for (std::size_t a = 0; a < device_rows.size(); ++a) {
    // The first row shows the Kinect itself. Its hidden joints are left out and not drawn at their
    // last position.
    rows.push_back({device_rows[a],
                    [&shown, a](std::size_t t) {
                      return a == 0 ? seen_figure_of(shown, t)
                                    : figure_of(shown.answers[a], t, device_colours[a]);
                    },
                    [&shown, a](std::size_t t) { return error_text(shown, a, t); }});
  }
  add_pictures(shown, even_instants(from, to), rows, out);
  out.tables = {device_table(all)};
  return out;
}

/// The path of a model: the given one, else the model that comes with kinalign. Empty if neither
/// exists. The figures therefore need no flags.
std::string model_or_shipped(const std::string& given, const std::string& name) {
  if (!given.empty()) return given;
  return shipped_model(name).value_or("");
}

PosePictures without_model(PosePictures figure, const std::string& how) {
  figure.absent = "No model was given, and the program has no shipped model. " + how;
  return figure;
}

/// Makes figure 10, or a note that its model is missing.
Result<PosePictures> make_device_figure(const NodeFigureOptions& o, const FigureTakes& takes,
                                        Call& call) {
  // All rows but the first need a model for fusion, so without a model the whole figure is left
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

/// Makes figures 8 and 9, or notes that their models are missing.
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
    // The second model must have a node on the head; otherwise the figure's title would be wrong.
    if (std::find(nodes.begin(), nodes.end(), "head") == nodes.end()) {
      return Failure(
          Error{with_head, 0, "a model with a node on the head", "a model without this node"});
    }
  }
  const AnsweredTakes all =
      answered(takes.nodes, takes.nodes_tested,
               [&](const ComparedTake& take) { return compare_poses(solvers, take, call); });
  // Both figures show the same answers, so each take is read once.
  return std::vector<PosePictures>{pose_figure(all), head_figure(all, solvers.size() > 1)};
}

}  // namespace

Result<std::vector<PosePictures>> node_figures(const NodeFigureOptions& o, Call& call) {
  // The page shows the figures in the order 8, 9, 10.
  const FigureTakes takes = KA_TRY(figure_takes(o, call));
  auto out = KA_TRY(make_pose_figures(o, takes, call));
  out.push_back(KA_TRY(make_device_figure(o, takes, call)));
  return out;
}

}  // namespace kinalign
