// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"
#include "apps/kinalign/learn/answer_output.h"
#include "apps/kinalign/learn/shipped_models.h"
#include "apps/kinalign/learn/worn_nodes.h"
#include "apps/kinalign/live/live_runs.h"
#include "apps/kinalign/verbs.h"
#include "apps/kinalign/verbs/describe_model.h"
#include "apps/kinalign/verbs/inputs.h"

#include "kinalign/models/pose/pose_model.h"

#include <nlohmann/json.hpp>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

/// The options of `kinalign pose`.
struct PoseWords {
  std::vector<std::string> in;
  std::string model, stream, body;
  WornWords worn;
  LiveWords live;
};

/// The command line of `kinalign pose`. -o may be missing in a live run only.
Usage describe_pose(PoseWords& o) {
  Usage usage;
  usage.positionals = {{"IN", "a take, a recording, a manifest or a file of nodes", &o.in, 0}};
  usage.flags = {model_flag(o.model),
                 text_flag("stream", "stream of nodes (default: the only one)", &o.stream, "NAME")};
  for (Field& field : worn_flags(o.worn)) usage.flags.push_back(std::move(field));
  usage.flags.push_back(body_flag(o.body, "the mean of the training people"));
  for (Field& field : live_flags(o.live)) usage.flags.push_back(std::move(field));
  usage.check = [&o](const Common& common, const Sources&) -> Result<void> {
    KA_TRY(check(o.worn));
    KA_TRY(check_body(o.body));
    KA_TRY(check(o.live, o.in));
    if (!o.live.live.empty()) KA_TRY(live_options(o.worn));
    if (!o.live.live.empty() && common.out.empty()) return {};
    return check_out(common, {".bvh"}, "-o FILE.bvh");
  };
  return usage;
}

/// The JSON member "body": the bones are those of the model or of --body.
Json body_of_answer(const PoseModel& model, const PoseWords& o) {
  return about_body(model.body.skeleton, o.body.empty() ? "the model" : "--body");
}

/// Reads and checks the model. The bones of --body are set before the first answer.
Result<PoseSolver> solver_of(const std::string& path, const PoseWords& o, Call& call) {
  const std::string bytes = KA_TRY(read_whole(call.surroundings.files, path, most_model_bytes));
  PoseSolver out = KA_TRY(PoseSolver::make(KA_TRY(read_pose_model(bytes, path))));
  const auto body = KA_TRY(body_of_words(o.body, out.model().body.skeleton, call));
  if (body) out.use_body(*body);
  return out;
}

/// True if there is a node on the head with at least two samples; a single sample has no duration.
bool has_head(const NamedNodes& nodes) {
  const auto head = node_at(nodes.names, "head");
  return head && nodes.tracks[*head].stamps.size() > 1;
}

/// The model of --model. Without the flag, a model that comes with kinalign: "pose_head" if there
/// is a node on the head, else "pose".
Result<std::string> model_for(const NamedNodes& nodes, const PoseWords& o) {
  return model_named(o.model, has_head(nodes) ? "pose_head" : "pose");
}

/// Computes the poses and writes them. The nodes in the stream decide about the model, so it is
/// chosen first; then the nodes are calibrated. `nodes` is moved into the calibration, so its names
/// are copied before.
Result<Json> solve_into(NamedNodes nodes, const PoseWords& o, Call& call) {
  const std::string path = KA_TRY(model_for(nodes, o));
  PoseSolver solver = KA_TRY(solver_of(path, o, call));
  const PoseModel& model = solver.model();
  NamedNodes names{nodes.stream, nodes.names, {}, {}};
  const PosedNodes posed =
      KA_TRY(calibrated_nodes(model.layout, model.body.skeleton, std::move(nodes), o.worn));
  const NodeFrames calibrated = on_bones(posed.calibration, posed.even.worn);
  // The data chose the model, so the JSON states its path.
  Json about{{"stream", names.stream},          {"frames", calibrated.frames()},
             {"rate_hz", model.layout.rate_hz}, {"joints", model.body.skeleton.joints()},
             {"method", model.facts.method},    {"model", path},
             {"body", body_of_answer(model, o)}};
  about.update(about_nodes(model.layout, posed, calibrated, names));
  KA_TRY(write_answer(solver.clip(calibrated, posed.even.start), model.layout.rate_hz, path, call));
  return about;
}

std::string pose_text(const Json& about, const std::string& out) {
  return answer_line(about, out) + body_line(about) + node_lines(about);
}

/// Computes the poses for data that a running `record` receives. If -o names a file, the clip is
/// written there.
Result<int> solve_live(const PoseWords& o, Call& call) {
  // At the start of a live run the nodes are not known, so the default is the model without a node
  // on the head.
  const std::string path = KA_TRY(model_named(o.model, "pose"));
  PoseSolver solver = KA_TRY(solver_of(path, o, call));
  LiveJob job{o.live, o.stream, "", {}};
  job.worn = KA_TRY(live_options(o.worn));
  KA_TRY(keep_free(call));
  Clip clip;
  Json about = KA_TRY(run_live_pose(solver, job, clip, call));
  about["body"] = body_of_answer(solver.model(), o);
  return end_live(std::move(clip), path, pose_text(about, call.common.out), about, call);
}

/// Computes the poses of one file and writes them. The exit code is 1 if there are warnings.
Result<int> run_pose(PoseWords& o, Call& call) {
  if (!o.live.live.empty()) return solve_live(o, call);
  const std::string& in = o.in.front();
  KA_TRY(keep_inputs(call.common.out, o.in));
  const auto work = [&]() -> Result<Json> {
    return solve_into(KA_TRY(nodes_of(in, {o.stream}, call)), o, call);
  };
  const Json about = KA_TRY(answered(in, work, call));
  call.console.wrote(call.common.out);
  return print_answer(pose_text(about, call.common.out), about, call);
}

}  // namespace

/// The verb `kinalign pose`.
Verb pose_verb() {
  return make_verb<PoseWords>(
      {.name = "pose",
       .summary = "compute a person's pose from a few inertial nodes",
       .text = "A model computes the whole body from nodes on waist, forearms and shanks. The "
               "person holds a T-pose for a second or more, which shows how the nodes are worn. If "
               "a node is lost, or the arms hang instead of a T-pose, a warning says so and the "
               "exit code is 1. If a sixth node is on the head, a model for six nodes is used.",
       .examples = {{"kinalign pose take.h5 -o pose.bvh", "a skeleton that Blender opens"},
                    {"kinalign pose recording.toml -o pose.bvh --tpose 2,5 --heading shared",
                     "nodes with magnetometers, the T-pose from second 2 to 5"},
                    {"kinalign pose --live 7040 -o pose.bvh",
                     "live data from a kinalign record with --live-port 7040"}},
       .common = {"out", "force", "json"}},
      describe_pose, run_pose);
}

}  // namespace kinalign
