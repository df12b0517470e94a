// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/eval/comparison.h"

#include "kinalign/models/windows_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

/// Marks a model for poses or fusion. Returns the rows of kinalign-learn
/// (apps/kinalign-learn/marks.h) as one array.
Result<std::string> rows_of_trial(const Trial& trial, Call& call) {
  std::string model = trial.model;
  // A finished model has its own file. Otherwise the method is trained on the fold's takes.
  if (model.empty()) model = KA_TRY(trained_model(trial.training, call));
  const auto rows = KA_TRY(rows_of_model(trial.training, model, call));
  // The program prints one JSON object a line. They are parsed here once, so the cache never holds
  // text that is no JSON.
  Json out = Json::array();
  for (const std::string& row : rows) out.push_back(Json::parse(row));
  return out.dump();
}

/// The name of a mark in the rows of kinalign-learn, and in the table.
/// Several states of the nodes give the same marks. The table needs them under different names.
struct RowMark {
  std::string_view row, table;
};

/// The marks of a pose that the table shows for this state of the nodes.
/// The table shows the full marks only for calibrated nodes. For the other states, two marks tell
/// how much is lost.
std::vector<RowMark> pose_marks_of(const std::string& nodes) {
  if (nodes == "calibrated") {
    return {{"sip_deg", "sip_deg"},
            {"angle_deg", "angle_deg"},
            {"head_deg", "head_deg"},
            {"position_cm", "position_cm"},
            {"jitter_ratio", "jitter"}};
  }
  // Headings drift while nodes are worn. This state shows the answer 20 minutes after the
  // calibration.
  if (nodes == "20 minutes later") {
    return {{"sip_deg", "later_sip_deg"}, {"position_cm", "later_position_cm"}};
  }
  // The state's name begins with that of the lost node.
  if (nodes.ends_with(" lost")) {
    return {{"sip_deg", "lost_sip_deg"}, {"position_cm", "lost_position_cm"}};
  }
  // A state that the table does not show has no columns.
  return {};
}

/// Adds each person's values of a row under the names of the table.
void add_people(const Json& row, const std::vector<RowMark>& names, MethodMarks& out) {
  for (const auto& [person, values] : row.at("people").items()) {
    for (const RowMark& name : names) {
      // A person without hidden joints has no error for them. The value in the row is then 0 and
      // means nothing.
      if (name.row == "hidden_cm" && values.at("hidden") == 0) continue;
      // Nodes alone can't know the place of the body in the room.
      if (name.row == "place_cm" && row.at("devices") == "nodes") continue;
      const double value = values.at(std::string(name.row)).get<double>();
      // add() averages over seeds, folds and states of the same name.
      out.marks[std::string(name.table)][person].add(value);
    }
  }
}

/// The row of the table for that method and variant; added if it is missing.
/// The reference may become invalid when the next row is added, so it must not be kept.
MethodMarks& row_for(const std::string& method, const std::string& variant,
                     std::vector<MethodMarks>& all) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const MethodMarks& one) {
    return one.method == method && one.variant == variant;
  });
  return found != all.end() ? *found : all.emplace_back(MethodMarks{method, variant});
}

/// Adds each person's mean error of the nodes' headings after 60 s.
/// Only rows about headings have "after_deg", one for each node. A person's value is the mean over
/// the nodes.
void add_headings(const Json& rows, const std::string& method, MethodMarks& out) {
  std::map<std::string, Mean> people;
  for (const Json& row : rows) {
    if (!row.contains("after_deg") || row.at("method") != method) continue;
    for (const auto& [person, value] : row.at("people").items()) {
      people[person].add(value.get<double>());
    }
  }
  // The mean over nodes is made first, so each seed counts once for a person.
  for (const auto& [person, mean] : people) out.marks["heading_deg"][person].add(*mean.value());
}

/// Sorts the rows of one trial into the rows of the table. Rows with "devices" are of fusion, rows
/// with "nodes" of poses; the filter keeps its own name, since it is the same for every model.
/// "filter" is the method without a network that every fusion model is compared with.
void add_rows(const std::string& name, const Json& rows, std::vector<MethodMarks>& out) {
  // The order is that of the columns in body_comparison().
  static const std::vector<RowMark> fusion{{"all_cm", "position_cm"},
                                           {"hidden_cm", "hidden_cm"},
                                           {"seen_trunk_cm", "seen_trunk_cm"},
                                           {"seen_arms_cm", "seen_arms_cm"},
                                           {"seen_legs_cm", "seen_legs_cm"},
                                           {"place_cm", "place_cm"},
                                           {"sip_deg", "sip_deg"}};
  for (const Json& row : rows) {
    const auto method = row.at("method").get<std::string>();
    // The text calls each model by its method. The table has the name that the user gave.
    const std::string& called = method == "filter" ? method : name;
    if (row.contains("devices")) {
      MethodMarks& marks = row_for(called, row.at("devices").get<std::string>(), out);
      add_people(row, fusion, marks);
      // Headings are shown in the row of both devices only.
      if (marks.variant == "both") add_headings(rows, method, marks);
    } else if (row.contains("nodes")) {
      add_people(row, pose_marks_of(row.at("nodes").get<std::string>()), row_for(called, "", out));
    }
  }
}

/// Cached texts may be damaged, so an error of JSON gives no rows, and the marks are computed
/// again.
/// The function must not fail: an empty result makes marks_for() compute the marks again.
std::vector<MethodMarks> sum_up_rows(const std::string& name, const std::vector<FoldMarks>& folds) {
  try {
    std::vector<MethodMarks> out;
    for (const FoldMarks& fold : folds) {
      for (const std::string& text : fold.texts) add_rows(name, Json::parse(text), out);
    }
    return out;
  } catch (const Json::exception&) {
    return {};
  }
}

/// Each take once, with its person, action and part.
/// A stretch is a part of a take between gaps, and a take may have several of them.
std::vector<FoldTake> takes_of_windows(const Windows& windows) {
  std::vector<FoldTake> out;
  std::set<std::size_t> known;
  for (const Stretch& stretch : windows.stretches) {
    // The set knows takes by their index; the first stretch of a take stands for all.
    if (!known.insert(stretch.take).second) continue;
    const WindowsFacts::Take& take = windows.facts.takes[stretch.take];
    out.push_back({take.name, take.subject, take.action, run_of(take.name),
                   windows.facts.parts[stretch.part]});
  }
  return out;
}

}  // namespace

Result<Comparison> body_comparison(const Eval& o, Learns task, const std::string& bytes,
                                   const std::string& file) {
  Comparison out;
  // The windows are read for their facts only. kinalign-learn reads the file again for each trial.
  const Windows windows = KA_TRY(read_windows(bytes, file));
  out.dataset = windows.facts.dataset;
  out.takes = takes_of_windows(windows);
  // Angles are in degrees, distances in centimetres.
  if (task == Learns::pose) {
    out.columns = {{"sip_deg", "SIP, °"},
                   {"angle_deg", "angle, °"},
                   {"head_deg", "head, °"},
                   {"position_cm", "position, cm"},
                   {"jitter", "jitter, × truth", 2},
                   {"later_sip_deg", "20 min: SIP, °"},
                   {"later_position_cm", "20 min: position, cm"},
                   {"lost_sip_deg", "lost: SIP, °"},
                   {"lost_position_cm", "lost: position, cm"}};
    out.note = "nodes as calibrated, after 20 minutes, with one lost";
  } else {
    out.columns = {{"position_cm", "all, cm"},
                   {"hidden_cm", "hidden, cm"},
                   {"seen_trunk_cm", "seen trunk, cm"},
                   {"seen_arms_cm", "seen arms, cm"},
                   {"seen_legs_cm", "seen legs, cm"},
                   {"place_cm", "place, cm"},
                   {"sip_deg", "SIP, °"},
                   {"heading_deg", "headings after 60 s, °"}};
    out.note = o.input.empty() ? "a simulated Kinect" : "the Kinect " + o.input;
  }
  // Every row is about one person, so the statistics are always over people.
  out.over = "people";
  out.mark = rows_of_trial;
  out.sum_up = sum_up_rows;
  return out;
}

}  // namespace kinalign
