// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"
#include "apps/kinalign/learn/node_source.h"
#include "apps/kinalign/learn/shipped_models.h"
#include "apps/kinalign/text/describe_file.h"
#include "apps/kinalign/verbs.h"
#include "apps/kinalign/verbs/describe_model.h"
#include "apps/kinalign/verbs/inputs.h"

#include "kinalign/core/numbers.h"
#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/formats/take/guarded.h"
#include "kinalign/models/pose/pose_model.h"
#include "kinalign/sources/formats.h"
#include "kinalign/view/report_words.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

constexpr double longest_lost_s = 2.0;    // a node that is lost longer is told
constexpr double most_turn_deg_s = 30.0;  // of a node in a T-pose that is held still

struct PoseWords {
  std::vector<std::string> in;
  std::string model, stream, t_pose, headings = "auto";
};

/// "START,END" in seconds; absent where the text is empty.
struct Seconds {
  double from = 0.0, to = 0.0;
};

Result<std::optional<Seconds>> t_pose_seconds(const std::string& text) {
  if (text.empty()) return std::optional<Seconds>();
  const std::size_t comma = text.find(',');
  Seconds out;
  if (comma != std::string::npos && parse_number(text.substr(0, comma), out.from) &&
      parse_number(text.substr(comma + 1), out.to) && out.from >= 0.0 && out.to > out.from) {
    return std::optional(out);
  }
  return Failure(Error{"--tpose", 0, "START,END in seconds, such as 1.5,4", shown(text)});
}

Usage describe_pose(PoseWords& o) {
  Usage usage;
  usage.positionals = {{"IN", "a take, a recording, a manifest or a file of nodes", &o.in}};
  usage.flags = {
      {"model", "the model's file (default: the shipped one)", &o.model, 0.0, 0.0, {}, "FILE"},
      {"stream", "which stream (default: the only one of nodes)", &o.stream, 0.0, 0.0, {}, "NAME"},
      {"tpose",
       "when the T-pose is held, s (default: the first still second)",
       &o.t_pose,
       0.0,
       0.0,
       {},
       "START,END"},
      {"heading",
       "whether nodes share a heading, or how they are worn says it",
       &o.headings,
       0.0,
       0.0,
       {"auto", "shared", "mounting"}}};
  usage.check = [&o](const Common& common, const Sources&) -> Result<void> {
    KA_TRY(t_pose_seconds(o.t_pose));
    if (common.out.ends_with(".bvh")) return {};
    return Failure(Error{"-o", 0, "-o FILE.bvh", common.out.empty() ? "none" : shown(common.out)});
  };
  return usage;
}

/// The model's nodes in a stream: [N] which of the stream's, absent where it has none.
using NodeChoice = std::vector<std::optional<std::size_t>>;

Result<NodeChoice> choose(const PoseLayout& layout, const NamedNodes& nodes) {
  NodeChoice out;
  std::size_t leaves = 0;
  for (const std::string& wanted : layout.nodes) {
    out.push_back(node_at(nodes.names, wanted));
    if (out.back() && nodes.tracks[*out.back()].stamps.size() < 2) out.back().reset();
    if (out.back() && wanted != layout.nodes.back()) ++leaves;
  }
  if (out.back() && leaves >= 2) return out;
  std::string wanted, found;
  for (std::size_t n = 0; n < layout.leaves(); ++n)
    wanted += (n == 0 ? "" : ", ") + layout.nodes[n];
  for (std::size_t s = 0; s < nodes.names.size(); ++s) {
    if (nodes.tracks[s].stamps.size() < 2) continue;
    found += (found.empty() ? "" : ", ") + harmless(nodes.names[s]);
  }
  return Failure(Error{"", 0,
                       "a node " + layout.nodes.back() + " and two of " + wanted + " with samples",
                       found.empty() ? "none" : found, ErrorKind::no_such_node});
}

/// What the T-pose was taken from.
struct ChosenTPose {
  TPose frames;
  double from_s = 0.0, to_s = 0.0;
  bool found = false;  // by itself
};

Result<ChosenTPose> choose_t_pose(const std::string& wanted, const WornFrames& worn,
                                  double rate_hz) {
  ChosenTPose out;
  if (const auto seconds = KA_TRY(t_pose_seconds(wanted))) {
    const double frames = static_cast<double>(worn.frames());
    out.frames.first =
        static_cast<std::size_t>(std::min(std::ceil(seconds->from * rate_hz), frames));
    const auto end =
        static_cast<std::size_t>(std::min(std::floor(seconds->to * rate_hz) + 1.0, frames));
    if (end <= out.frames.first) {
      return Failure(Error{"--tpose", 0,
                           fmt::format("seconds within 0 to {:.1f}", frames / rate_hz),
                           shown(wanted)});
    }
    out.frames.count = end - out.frames.first;
  } else {
    const auto still = first_still(worn, rate_hz);
    if (!still) {
      return Failure(Error{"", 0,
                           "a second in which no node turns faster than 20 deg/s, for the T-pose",
                           "none (--tpose START,END names one)"});
    }
    out.frames = *still;
    out.found = true;
  }
  out.from_s = static_cast<double>(out.frames.first) / rate_hz;
  out.to_s = static_cast<double>(out.frames.first + out.frames.count) / rate_hz;
  return out;
}

/// The nodes on the model's grid, calibrated, and what is to be said of them.
struct PosedNodes {
  EvenNodes even;
  ChosenTPose t_pose;
  NodeCalibration calibration;
};

Result<PosedNodes> calibrated_nodes(const PoseModel& model, NamedNodes nodes,
                                    const NodeChoice& choice, const PoseWords& o) {
  const PoseLayout& layout = model.layout;
  std::vector<NodeTrack> tracks(layout.nodes.size());
  CalibrationOptions options;
  for (std::size_t n = 0; n < choice.size(); ++n) {
    options.worn.emplace_back();
    if (!choice[n]) continue;
    tracks[n] = std::move(nodes.tracks[*choice[n]]);
    options.worn.back() = nodes.worn[*choice[n]];
    KA_TRY(complete(tracks[n]));
  }
  PosedNodes out;
  out.even = KA_TRY(even_nodes(tracks, layout.rate_hz));
  out.t_pose = KA_TRY(choose_t_pose(o.t_pose, out.even.worn, layout.rate_hz));
  options.t_pose = out.t_pose.frames;
  if (o.headings == "shared") options.headings = Headings::shared;
  if (o.headings == "mounting") options.headings = Headings::mounting;
  out.calibration = KA_TRY(calibrate(layout, model.body.skeleton, out.even.worn, options));
  return out;
}

/// The share of frames in which a node is valid, and its longest loss, s.
struct NodePresence {
  double valid = 0.0, longest_lost_s = 0.0;
};

NodePresence presence_of(const NodeFrames& nodes, std::size_t node, double rate_hz) {
  std::size_t run = 0, longest = 0, valid = 0;
  for (std::size_t t = 0; t < nodes.frames(); ++t) {
    const bool is_valid = nodes.valid[t * nodes.nodes + node] != 0;
    run = is_valid ? 0 : run + 1;
    longest = std::max(longest, run);
    valid += is_valid ? 1 : 0;
  }
  return {static_cast<double>(valid) / static_cast<double>(nodes.frames()),
          static_cast<double>(longest) / rate_hz};
}

/// Of a node: its warning, if there is one.
std::string warning_of(const PosedNodes& posed, const PoseLayout& layout, std::size_t node,
                       const NodePresence& presence) {
  const std::string& name = layout.nodes[node];
  const auto& worn = posed.calibration.nodes[node];
  if (presence.valid == 0.0) return name + " has no samples: its limb is a guess";
  if (!worn) return name + " has no samples in the T-pose, and is left out: its limb is a guess";
  if (presence.longest_lost_s >= longest_lost_s) {
    return fmt::format("{} is missing for {:.1f} s: there its limb is a guess", name,
                       presence.longest_lost_s);
  }
  const bool is_checked =
      posed.calibration.worn_as_told || posed.calibration.headings == Headings::mounting;
  if (!is_checked || worn->tilt_deg <= most_tilt_deg) return "";
  if (worn_place(name)->on_arm) {
    return fmt::format("{} is held {:.0f} deg off a T-pose: arms hung, or it is worn another way",
                       name, worn->tilt_deg);
  }
  return fmt::format("{} is worn {:.0f} deg off what docs/pose.md says", name, worn->tilt_deg);
}

Json about_pose(const PoseModel& model, const PosedNodes& posed, const NodeFrames& nodes,
                const NamedNodes& named, const NodeChoice& choice) {
  const PoseLayout& layout = model.layout;
  Json each = Json::object(), warnings = Json::array();
  double valid = 0.0;
  const double fastest = fastest_turn_deg(posed.even.worn, posed.t_pose.frames);
  if (fastest > most_turn_deg_s) {
    warnings.push_back(
        fmt::format("in the T-pose a node turned at {:.0f} deg/s: it was not held still", fastest));
  }
  for (std::size_t n = 0; n < layout.nodes.size(); ++n) {
    const NodePresence presence = presence_of(nodes, n, layout.rate_hz);
    const auto& worn = posed.calibration.nodes[n];
    each[layout.nodes[n]] = {{"called", choice[n] ? Json(named.names[*choice[n]]) : Json()},
                             {"valid", presence.valid},
                             {"tilt_deg", worn ? Json(worn->tilt_deg) : Json()}};
    valid += presence.valid / static_cast<double>(layout.nodes.size());
    const std::string warning = warning_of(posed, layout, n, presence);
    if (!warning.empty()) warnings.push_back(warning);
  }
  const NodeCalibration& calibration = posed.calibration;
  return {{"stream", named.stream},
          {"frames", nodes.frames()},
          {"rate_hz", layout.rate_hz},
          {"joints", model.body.skeleton.joints()},
          {"method", model.facts.method},
          {"valid", valid},
          {"nodes", std::move(each)},
          {"t_pose",
           {{"from_s", posed.t_pose.from_s},
            {"to_s", posed.t_pose.to_s},
            {"found", posed.t_pose.found},
            {"fastest_deg_s", fastest}}},
          {"headings", calibration.headings == Headings::shared ? "shared" : "mounting"},
          {"facing", calibration.facing == Facing::arms ? "arms" : "mounting"},
          {"spread_deg", calibration.spread_deg},
          {"worn_as_told", calibration.worn_as_told},
          {"warnings", std::move(warnings)}};
}

bool is_finite(const Clip& clip) {
  const auto is_number = [](double value) { return std::isfinite(value); };
  const ClipFrames& frames = clip.frames;
  return std::all_of(frames.local_positions.begin(), frames.local_positions.end(), is_number) &&
         std::all_of(frames.local_rotations.begin(), frames.local_rotations.end(), is_number);
}

Result<Json> solve_into(PoseSolver& solver, NamedNodes nodes, const PoseWords& o, Call& call) {
  const PoseModel& model = solver.model();
  const NodeChoice choice = KA_TRY(choose(model.layout, nodes));
  NamedNodes names{nodes.stream, nodes.names, {}, {}};
  PosedNodes posed = KA_TRY(calibrated_nodes(model, std::move(nodes), choice, o));
  const NodeFrames calibrated = on_bones(posed.calibration, posed.even.worn);
  Json about = about_pose(model, posed, calibrated, names, choice);
  Clip clip = solver.clip(calibrated, posed.even.start);
  if (!is_finite(clip)) {
    return Failure(Error{o.model, 0, "a model that answers with numbers", "others"});
  }
  OutputFile file =
      KA_TRY(OutputFile::create(call.surroundings.files, call.common.out, call.common.overwrite()));
  KA_TRY(write_bvh(bvh_from_clip(std::move(clip), 1.0 / model.layout.rate_hz),
                   [&](std::string_view text) { return file.write(text); }));
  KA_TRY(file.commit());
  return about;
}

/// Solves and writes; errors without a file name `in`.
Result<Json> solve_named(PoseSolver& solver, Result<NamedNodes> nodes, const PoseWords& o,
                         Call& call) {
  auto about = solve_into(solver, KA_TRY(std::move(nodes)), o, call);
  if (!about && about.error().file.empty()) about.error().file = o.in.front();
  return about;
}

/// The same of a take, in a child process.
Result<Json> solve_take(PoseSolver& solver, const PoseWords& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  const std::string& in = o.in.front();
  const auto work = [&]() -> Result<std::string> {
    return KA_TRY(solve_named(solver, nodes_of_take(files, in, o.stream), o, call)).dump();
  };
  Json about = Json::parse(KA_TRY(run_guarded(GuardLimits{}, blame(in), work)), nullptr, false);
  if (about.is_object()) return about;
  return Failure(Error{in, 0, "a take that can be read", "another answer"});
}

std::string heading_line(const Json& about) {
  if (about.at("headings") == "mounting") return "each node's own, by how it is worn";
  return about.at("facing") == "arms" ? "one for all nodes, by arms that come down"
                                      : "one for all nodes, by how they are worn";
}

std::string t_pose_line(const Json& about) {
  const Json& t_pose = about.at("t_pose");
  std::string out = fmt::format("{:.1f} to {:.1f} s{}, no node turned faster than {:.0f} deg/s",
                                t_pose.at("from_s").get<double>(), t_pose.at("to_s").get<double>(),
                                t_pose.at("found").get<bool>() ? ", the first still stretch" : "",
                                t_pose.at("fastest_deg_s").get<double>());
  std::string arms;
  for (const auto& [name, node] : about.at("nodes").items()) {
    const WornPlace* place = worn_place(name);
    if (place == nullptr || !place->on_arm || node.at("tilt_deg").is_null()) continue;
    arms += fmt::format("{}{:.0f}", arms.empty() ? "" : " and ", node.at("tilt_deg").get<double>());
  }
  const bool is_checked =
      about.at("worn_as_told").get<bool>() || about.at("headings") == "mounting";
  if (!is_checked) return out + "; forearms not checked";
  return arms.empty() ? out : out + "; forearms " + arms + " deg off";
}

void print_pose(const Json& about, const std::string& out, Call& call) {
  std::size_t there = 0;
  for (const auto& [name, node] : about.at("nodes").items()) {
    if (node.at("valid").get<double>() > 0.0) ++there;
  }
  std::string text = fmt::format(
      "{}: {} frames at {:g} Hz, {} joints\nnodes    {} of {}, {:.1f} % valid\nT-pose   {}\n"
      "heading  {}\n",
      harmless(out), grouped(about.at("frames").get<std::size_t>()),
      about.at("rate_hz").get<double>(), about.at("joints").get<std::size_t>(), there,
      about.at("nodes").size(), 100.0 * about.at("valid").get<double>(), t_pose_line(about),
      heading_line(about));
  for (const Json& warning : about.at("warnings")) {
    text += fmt::format("warning  {}\n", harmless(warning.get<std::string>()));
  }
  call.console.print(text);
  call.console.print_json(about.dump(1, ' ', false, Json::error_handler_t::replace));
}

Result<int> run_pose(PoseWords& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  const std::string& in = o.in.front();
  KA_TRY(keep_inputs(call.common.out, o.in));
  const std::string path = o.model.empty() ? KA_TRY(shipped_model("pose")) : o.model;
  const std::string bytes = KA_TRY(read_whole(files, path, most_model_bytes));
  PoseSolver solver = KA_TRY(PoseSolver::make(KA_TRY(read_pose_model(bytes, path))));
  const bool is_take = KA_TRY(kind_of_file(files, in)) == FileKind::take;
  const Json about =
      KA_TRY(is_take ? solve_take(solver, o, call)
                     : solve_named(solver, nodes_of_file(in, o.stream, call), o, call));
  call.console.wrote(call.common.out);
  print_pose(about, call.common.out, call);
  return about.at("warnings").empty() ? 0 : 1;
}

}  // namespace

Verb pose_verb() {
  return make_verb<PoseWords>(
      {.name = "pose",
       .summary = "a person's pose from a few inertial nodes",
       .text =
           "A model answers with the whole body to nodes on waist, forearms and shanks. The person "
           "holds a T-pose for a second or more: it says how the nodes are worn. A node that is "
           "lost, and arms that hung in place of a T-pose, are told, and the exit code is 1.",
       .examples = {{"kinalign pose take.h5 -o pose.bvh", "a skeleton that Blender opens"},
                    {"kinalign pose recording.toml -o pose.bvh --tpose 2,5 --heading shared",
                     "nodes with magnetometers, the T-pose from second 2 to 5"}},
       .common = {"out", "force", "json"}},
      describe_pose, run_pose);
}

}  // namespace kinalign
