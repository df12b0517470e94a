// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign-learn/marks.h"

#include "kinalign/learn/fuse/fuse_marks.h"
#include "kinalign/learn/pose/pose_marks.h"
#include "kinalign/models/model_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <iostream>
#include <map>
#include <utility>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<Devices, 3> all_devices{Devices::both, Devices::kinect, Devices::nodes};

std::string name_of(Devices devices) {
  static constexpr std::array<std::string_view, 3> names{"both", "kinect", "nodes"};
  return std::string(names[static_cast<std::size_t>(devices)]);
}

/// Wraps the model in a function. `fuser` must live as long as the function.
Fusion fusion_of(Fuser& fuser) {
  return [&](const FuseInput& input) { return fuser.solve(input); };
}

/// The errors of a fusion as members of a JSON object.
Json errors_json(const FuseErrors& errors) {
  return {{"all_cm", errors.all_cm},
          {"hidden_cm", errors.hidden_cm},
          {"seen_trunk_cm", errors.seen_trunk_cm},
          {"seen_arms_cm", errors.seen_arms_cm},
          {"seen_legs_cm", errors.seen_legs_cm},
          {"place_cm", errors.place_cm},
          {"sip_deg", errors.sip_deg},
          {"frames", errors.frames},
          {"hidden", errors.hidden}};
}

/// The errors of a pose as members of a JSON object. Jitter is given as a ratio to the truth's
/// jitter, so 1 is as smooth as the truth.
Json errors_json(const PoseErrors& errors) {
  return {{"sip_deg", errors.sip_deg},
          {"angle_deg", errors.angle_deg},
          {"head_deg", errors.head_deg},
          {"position_cm", errors.position_cm},
          {"jitter_ratio", errors.jitter_ratio()},
          {"frames", errors.frames}};
}

// Prints one line. The line is flushed at once, because the parent program reads line by line.
void print_row(const Json& row) { std::cout << row.dump() << std::endl; }

/// The errors of each person, sorted by the person's name.
template <class Errors>
Json people_json(const std::map<std::string, Errors>& people) {
  Json out = Json::object();
  for (const auto& [name, errors] : people) out[name] = errors_json(errors);
  return out;
}

/// Prints a row for each state of the nodes, such as one node lost. The argument 0 chooses the
/// first leaf as the lost node; with the usual nodes that is the left wrist.
Result<void> print_pose_marks(const TrainingJob& job, const Windows& windows, PoseModel model) {
  const std::string method = model.facts.method;
  auto solver = KA_TRY(PoseSolver::make(std::move(model)));
  const PoseData data = KA_TRY(pose_data(windows, job.truth, solver.model().layout.nodes));
  for (const PoseMark& mark : KA_TRY(pose_marks(solver, data, 0))) {
    print_row({{"method", method},
               {"nodes", mark.nodes},
               {"answer", errors_json(mark.answer)},
               {"smoothed", errors_json(mark.smoothed)},
               {"people", people_json(mark.people)}});
  }
  return {};
}

void print_marks_of(const std::string& method, const std::vector<FuseMark>& marks) {
  for (const FuseMark& mark : marks) {
    Json row{{"method", method}, {"devices", name_of(mark.devices)}};
    row.update(errors_json(mark.all));
    row["people"] = people_json(mark.people);
    print_row(row);
  }
}

/// Prints a row for each node: the error of its heading before and after the correction.
void print_headings(const std::string& method, const std::vector<HeadingMark>& marks) {
  for (const HeadingMark& mark : marks) {
    print_row({{"method", method},
               {"node", mark.node},
               {"before_deg", mark.before_deg},
               {"after_deg", mark.after_deg},
               {"worst_deg", mark.worst_deg},
               {"people", mark.people}});
  }
}

/// Prints the rows of a model for fusion and of the filter, which fuses without learning. Both have
/// a row for each choice of devices and a row for each node's heading.
Result<void> print_fuse_marks(const TrainingJob& job, const Windows& windows, FuseModel model) {
  auto fuser = KA_TRY(Fuser::make(std::move(model)));
  // The model, and not the job, decides which nodes are simulated.
  const FuseLayout layout = fuser.model().layout;
  const FuseData data =
      KA_TRY(fuse_data(windows, job.truth, layout.nodes.nodes, fuse_options(job.input, windows)));
  const std::vector<Devices> all{all_devices.begin(), all_devices.end()};
  // Without learning, headings are found from the Kinect's joints only.
  const HeadingsOf by_joints = [&](const FuseInput& input) {
    FuseInput own = input;
    unexchange(layout, own);
    const HeadingFilter filter(layout, data.pose.body);
    return node_headings(filter, own.nodes, directions_of_joints(filter, own.kinect));
  };
  const HeadingsOf by_model = [&](const FuseInput& input) { return fuser.headings(input); };
  const Fusion filter = [&](const FuseInput& input) {
    FuseInput own = input;
    unexchange(layout, own);
    // The filter gets corrected headings like the model, so that the comparison is fair.
    own.nodes = with_headings(std::move(own.nodes), by_joints(own));
    return filtered_pose(layout, data.pose.body, own);
  };
  const std::string& method = fuser.model().facts.method;
  print_marks_of(method, KA_TRY(fuse_marks(fusion_of(fuser), layout, data, all)));
  print_marks_of("filter", KA_TRY(fuse_marks(filter, layout, data, all)));
  print_headings(method, heading_marks(by_model, layout, data));
  print_headings("filter", heading_marks(by_joints, layout, data));
  return {};
}

}  // namespace

Result<std::string> pose_metrics_json(const PoseModel& model, const PoseData& data) {
  if (data.tested.empty()) return std::string();
  auto solver = KA_TRY(PoseSolver::make(model));
  Json out;
  for (const PoseMark& mark : KA_TRY(pose_marks(solver, data, 0))) {
    std::string state = mark.nodes;  // "20 minutes later"
    // The keys of the JSON have no blanks.
    std::replace(state.begin(), state.end(), ' ', '_');
    out[state + "_position_cm"] = mark.smoothed.position_cm;
    out[state + "_sip_deg"] = mark.smoothed.sip_deg;
    out[state + "_angle_deg"] = mark.smoothed.angle_deg;
  }
  return out.dump();
}

/// The marks of a model for fusion, as the model's file states them in JSON.
Result<std::string> fuse_metrics_json(const FuseModel& model, const FuseData& data) {
  if (data.pose.tested.empty()) return std::string();
  auto fuser = KA_TRY(Fuser::make(model));
  Json out;
  for (const FuseMark& mark : KA_TRY(fuse_marks(fusion_of(fuser), model.layout, data,
                                                {all_devices.begin(), all_devices.end()}))) {
    out[name_of(mark.devices) + "_position_cm"] = mark.all.all_cm;
    out[name_of(mark.devices) + "_hidden_cm"] = mark.all.hidden_cm;
  }
  return out.dump();
}

// If the file has no stream of this name, the Kinect is simulated; that is no error.
FuseDataOptions fuse_options(const std::string& input, const Windows& windows) {
  FuseDataOptions out;
  if (windows.facts.find(input) != nullptr) out.kinect = input;
  return out;
}

Result<void> print_marks(const TrainingJob& job, const Windows& windows, const std::string& model) {
  const std::string task = KA_TRY(task_of_model(model, job.evaluate));
  if (task == "fuse") {
    return print_fuse_marks(job, windows, KA_TRY(read_fuse_model(model, job.evaluate)));
  }
  return print_pose_marks(job, windows, KA_TRY(read_pose_model(model, job.evaluate)));
}

}  // namespace kinalign
