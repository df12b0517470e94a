// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/eval/comparison.h"

#include "kinalign/models/windows_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

/// Computes the marks of a model for poses or fusion. Returns the rows that kinalign-learn prints
/// (apps/kinalign-learn/marks.h) as one JSON array.
Result<std::string> rows_of_trial(const Trial& trial, Call& call) {
  std::string model = trial.model;
  // A finished model has its own file. Without a model, the method is trained on the takes of the
  // fold.
  if (model.empty()) model = KA_TRY(trained_model(trial.training, call));
  const auto rows = KA_TRY(rows_of_model(trial.training, model, call));
  // kinalign-learn prints one JSON object a line. Each is parsed here, so that only valid JSON gets
  // into the cache.
  Json out = Json::array();
  for (const std::string& row : rows) out.push_back(Json::parse(row));
  return out.dump();
}

/// The name of a mark in the rows of kinalign-learn, and its name in the table. Rows for several
/// states of the nodes have the same marks, which need different names in the table.
struct RowMark {
  std::string_view row, table;
};

/// The marks of a pose that the table shows for a state of the nodes. For calibrated nodes the
/// table shows all marks. For the other states it shows two marks, which tell how much worse the
/// pose is.
std::vector<RowMark> pose_marks_of(const std::string& nodes) {
  if (nodes == "calibrated") {
    return {{"sip_deg", "sip_deg"},
            {"angle_deg", "angle_deg"},
            {"head_deg", "head_deg"},
            {"position_cm", "position_cm"},
            {"jitter_ratio", "jitter"}};
  }
  // The headings of nodes drift while they are worn. This state is 20 minutes after the
  // calibration.
  if (nodes == "20 minutes later") {
    return {{"sip_deg", "later_sip_deg"}, {"position_cm", "later_position_cm"}};
  }
  // The name of this state is the name of the lost node and " lost".
  if (nodes.ends_with(" lost")) {
    return {{"sip_deg", "lost_sip_deg"}, {"position_cm", "lost_position_cm"}};
  }
  // The table has no columns for any other state.
  return {};
}

/// Adds the values of each person in a row, under the names of the table.
void add_people(const Json& row, const std::vector<RowMark>& names, MethodMarks& out) {
  for (const auto& [person, values] : row.at("people").items()) {
    for (const RowMark& name : names) {
      // If no joint of a person was hidden, the row has 0 for their error; that value means
      // nothing.
      if (name.row == "hidden_cm" && values.at("hidden") == 0) continue;
      // Nodes alone can't measure where the body is in the room.
      if (name.row == "place_cm" && row.at("devices") == "nodes") continue;
      const double value = values.at(std::string(name.row)).get<double>();
      // add() takes the mean over seeds, folds and states of the same name.
      out.marks[std::string(name.table)][person].add(value);
    }
  }
}

/// Finds the table's row of a method and variant, or adds it. The next call may add a row and move
/// the others, so the reference must not be kept.
MethodMarks& row_for(const std::string& method, const std::string& variant,
                     std::vector<MethodMarks>& all) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const MethodMarks& one) {
    return one.method == method && one.variant == variant;
  });
  return found != all.end() ? *found : all.emplace_back(MethodMarks{method, variant});
}

/// Adds each person's mean error of the nodes' headings after 60 s. Only rows about headings have
/// "after_deg", one row for each node. A person's value is the mean over the nodes.
void add_headings(const Json& rows, const std::string& method, MethodMarks& out) {
  std::map<std::string, Mean> people;
  for (const Json& row : rows) {
    if (!row.contains("after_deg") || row.at("method") != method) continue;
    for (const auto& [person, value] : row.at("people").items()) {
      people[person].add(value.get<double>());
    }
  }
  // The mean over the nodes is taken first, so that each seed has the same weight for a person.
  for (const auto& [person, mean] : people) out.marks["heading_deg"][person].add(*mean.value());
}

/// Puts the rows of one trial into the rows of the table. Rows with "devices" are about fusion,
/// rows with "nodes" about poses. Every model for fusion is compared with the method "filter",
/// which has no network; its rows are the same for every model.
void add_rows(const std::string& name, const Json& rows, std::vector<MethodMarks>& out) {
  // The columns in body_comparison() have the same order.
  static const std::vector<RowMark> fusion{{"all_cm", "position_cm"},
                                           {"hidden_cm", "hidden_cm"},
                                           {"seen_trunk_cm", "seen_trunk_cm"},
                                           {"seen_arms_cm", "seen_arms_cm"},
                                           {"seen_legs_cm", "seen_legs_cm"},
                                           {"place_cm", "place_cm"},
                                           {"sip_deg", "sip_deg"}};
  for (const Json& row : rows) {
    const auto method = row.at("method").get<std::string>();
    // A row has the name of the model's method. The table has the name that the user gave.
    const std::string& called = method == "filter" ? method : name;
    if (row.contains("devices")) {
      MethodMarks& marks = row_for(called, row.at("devices").get<std::string>(), out);
      add_people(row, fusion, marks);
      // Headings stand only in the row about both devices.
      if (marks.variant == "both") add_headings(rows, method, marks);
    } else if (row.contains("nodes")) {
      add_people(row, pose_marks_of(row.at("nodes").get<std::string>()), row_for(called, "", out));
    }
  }
}

/// Sums up the cached texts. A cached text may be damaged, so an error of JSON gives an empty
/// result, and marks_for() computes the marks again.
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

/// Lists each take once, with its person, action and part of the split. A take with gaps has
/// several stretches.
std::vector<FoldTake> takes_of_windows(const Windows& windows) {
  std::vector<FoldTake> out;
  std::set<std::size_t> known;
  for (const Stretch& stretch : windows.stretches) {
    // Only the first stretch of a take adds the take to the list.
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
  // Only the facts about the windows are used here. kinalign-learn reads the file again for each
  // trial.
  const Windows windows = KA_TRY(read_windows(bytes, file));
  out.dataset = windows.facts.dataset;
  out.takes = takes_of_windows(windows);
  // Marks of angles are in degrees, marks of distances in centimetres.
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
  // Every value belongs to one person, so means are always over people.
  out.over = "people";
  out.mark = rows_of_trial;
  out.sum_up = sum_up_rows;
  return out;
}

}  // namespace kinalign
