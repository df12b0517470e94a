// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"
#include "apps/kinalign/learn/answer_output.h"
#include "apps/kinalign/learn/fused_input.h"
#include "apps/kinalign/learn/shipped_models.h"
#include "apps/kinalign/live/live_runs.h"
#include "apps/kinalign/verbs.h"
#include "apps/kinalign/verbs/describe_model.h"
#include "apps/kinalign/verbs/inputs.h"

#include "kinalign/models/fuse/fuse_model.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <span>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

// A heading of a node with a larger standard deviation gives a warning.
constexpr double most_unsure_deg = 10.0;
// If the Kinect corrects a heading by more, the node is worn elsewhere.
constexpr double most_turned_deg = 40.0;

/// The options of `kinalign fuse`. `kinect` and `nodes` are names of streams.
struct FuseWords {
  std::vector<std::string> in;
  std::string model, kinect, nodes, body;
  WornWords worn;
  LiveWords live;
};

/// The command line of `kinalign fuse`. -o may be missing in a live run only.
Usage describe_fuse(FuseWords& o) {
  Usage usage;
  usage.positionals = {
      {"IN", "a take, a recording or a manifest with a Kinect and nodes", &o.in, 0}};
  usage.flags = {
      model_flag(o.model),
      text_flag("kinect", "stream of the Kinect (default: the only stream of joints)", &o.kinect,
                "NAME"),
      text_flag("nodes", "stream of the nodes (default: the only one)", &o.nodes, "NAME")};
  for (Field& field : worn_flags(o.worn)) usage.flags.push_back(std::move(field));
  usage.flags.push_back(body_flag(o.body, "the lengths that the Kinect measures"));
  for (Field& field : live_flags(o.live)) usage.flags.push_back(std::move(field));
  usage.check = [&o](const Common& common, const Sources&) -> Result<void> {
    KA_TRY(check(o.worn));
    KA_TRY(check_body(o.body));
    KA_TRY(check(o.live, o.in));
    // A live run keeps frames for a limited time only, so live_options() checks --tpose against it.
    if (!o.live.live.empty()) KA_TRY(live_options(o.worn));
    if (!o.live.live.empty() && common.out.empty()) return {};
    return check_out(common, {".bvh"}, "-o FILE.bvh");
  };
  return usage;
}

/// Adds the correction of each node's heading at the end of the run. Adds warnings if a correction
/// is large or uncertain.
void add_heading_warnings(const std::vector<std::string>& names,
                          const std::vector<HeadingState>& states, Json& about) {
  // `states` has one element for each frame and node. The last frame has the corrections after the
  // whole run.
  about["found_headings"] = headings_json(names, std::span(states).last(names.size()));
  for (const auto& [name, found] : about["found_headings"].items()) {
    const auto spread = found.at("spread_deg").get<double>();
    const auto turned = found.at("turned_deg").get<double>();
    // A node without samples has no real heading, and it has its own warning.
    const bool is_there = about.at("nodes").at(name).at("valid").get<double>() > 0.0;
    if (is_there && std::abs(turned) > most_turned_deg && spread <= most_unsure_deg) {
      about["warnings"].push_back(
          fmt::format("{}: its heading differs by {:.0f} deg from the Kinect's; was it swapped "
                      "with another node, or worn in another orientation?",
                      name, turned));
    }
    // A node with an uncertain heading gets a warning but is still used.
    if (!is_there || spread <= most_unsure_deg) continue;
    about["warnings"].push_back(
        fmt::format("{}: its heading is uncertain by the Kinect (± {:.0f} deg)", name, spread));
  }
}

/// Fuses both devices and writes the answer. --body gives the lengths of the bones. Without it they
/// are those that the Kinect measured, or the model's.
Result<Json> fuse_into(Fuser& fuser, BothDevices both, const FuseWords& o, Call& call) {
  const FusedInput given = KA_TRY(fused_input(fuser.model(), std::move(both), o.worn));
  const PoseLayout& layout = fuser.model().layout.nodes;
  // --body overrides the lengths that the Kinect measured, and these override the model's lengths.
  const auto own = KA_TRY(body_of_words(o.body, fuser.model().body.skeleton, call));
  fuser.use_body(own ? *own : given.body);
  Json about = about_fused(fuser.model(), given);
  const std::string by = given.is_sized ? "the Kinect" : "the model";
  about["body"] = about_body(fuser.model().body.skeleton, own ? "--body" : by);
  // The headings are computed once, for the warnings and for the clip.
  const auto headings = fuser.headings(given.input);
  add_heading_warnings(layout.nodes, headings, about);
  KA_TRY(
      write_answer(fuser.clip(given.input, headings, given.start), layout.rate_hz, o.model, call));
  return about;
}

/// The printed summary. The correction of each heading has its standard deviation, both in degrees.
std::string fuse_text(const Json& about, const std::string& out) {
  std::string found;
  for (const auto& [name, one] : about.at("found_headings").items()) {
    found += fmt::format("{}{} {:+.0f} ± {:.0f}", found.empty() ? "" : ", ", harmless(name),
                         one.at("turned_deg").get<double>(), one.at("spread_deg").get<double>());
  }
  return answer_line(about, out) + "kinect   " + seen_text(about) + "\n" + body_line(about) +
         node_lines(about) + fmt::format("turned   by the Kinect, deg: {}\n", found);
}

/// Fuses the data that a running `record` receives. If -o names a file, the clip is written there.
Result<int> fuse_live(Fuser& fuser, const FuseWords& o, Call& call) {
  LiveJob job{o.live, o.nodes, o.kinect, {}};
  job.worn = KA_TRY(live_options(o.worn));
  KA_TRY(keep_free(call));
  Clip clip;
  // A live run uses the model's body, unless --body gives another one.
  if (const auto own = KA_TRY(body_of_words(o.body, fuser.model().body.skeleton, call))) {
    fuser.use_body(*own);
  }
  Json about = KA_TRY(run_live_fuse(fuser, job, clip, call));
  about["body"] = about_body(fuser.model().body.skeleton, o.body.empty() ? "the model" : "--body");
  return end_live(std::move(clip), o.model, fuse_text(about, call.common.out), about, call);
}

/// Fuses one file and writes the result. The exit code is 1 if there are warnings.
Result<int> run_fuse(FuseWords& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  o.model = KA_TRY(model_named(o.model, "fuse"));
  const std::string bytes = KA_TRY(read_whole(files, o.model, most_model_bytes));
  Fuser fuser = KA_TRY(Fuser::make(KA_TRY(read_fuse_model(bytes, o.model))));
  if (!o.live.live.empty()) return fuse_live(fuser, o, call);
  const std::string& in = o.in.front();
  KA_TRY(keep_inputs(call.common.out, o.in));
  const auto work = [&]() -> Result<Json> {
    BothDevices both;
    // The nodes are read first, so if both fail the error is about the nodes.
    both.nodes = KA_TRY(nodes_of(in, {o.nodes, "--nodes"}, call));
    both.kinect = KA_TRY(points_of(in, {o.kinect, "--kinect"}, call));
    return fuse_into(fuser, std::move(both), o, call);
  };
  const Json about = KA_TRY(answered(in, work, call));
  call.console.wrote(call.common.out);
  return print_answer(fuse_text(about, call.common.out), about, call);
}

}  // namespace

/// The verb `kinalign fuse`.
Verb fuse_verb() {
  return make_verb<FuseWords>(
      {.name = "fuse",
       .summary = "compute a person's pose from a Kinect and inertial nodes together",
       .text = "A model computes the whole body and its place in front of the Kinect. While the "
               "Kinect loses a limb, the nodes measure it; while it sees the limb, it corrects the "
               "node's heading. The person holds a T-pose for a second or more, as for pose.",
       .examples = {{"kinalign fuse take.h5 -o fused.bvh", "a skeleton that Blender opens"},
                    {"kinalign fuse take.h5 -o fused.bvh --kinect kinect --nodes imu --tpose 2,5",
                     "the streams by name, the T-pose from second 2 to 5"},
                    {"kinalign fuse --live 7040 -o fused.bvh",
                     "live data from a kinalign record with --live-port 7040"}},
       .common = {"out", "force", "json"}},
      describe_fuse, run_fuse);
}

}  // namespace kinalign
