// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"
#include "apps/kinalign/learn/answer_output.h"
#include "apps/kinalign/learn/point_source.h"
#include "apps/kinalign/learn/projected.h"
#include "apps/kinalign/learn/shipped_models.h"
#include "apps/kinalign/live/live_runs.h"
#include "apps/kinalign/text/describe_file.h"
#include "apps/kinalign/verbs.h"
#include "apps/kinalign/verbs/describe_model.h"
#include "apps/kinalign/verbs/inputs.h"

#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/formats/points/trc.h"
#include "kinalign/formats/take/guarded.h"
#include "kinalign/infer/safetensors.h"
#include "kinalign/models/denoise_model.h"
#include "kinalign/models/even_grid.h"
#include "kinalign/models/joint_names.h"
#include "kinalign/models/skeleton_of_points.h"
#include "kinalign/sources/formats.h"
#include "kinalign/view/report_words.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

constexpr double longest_gap_s = 0.2;     // samples further apart are not interpolated
constexpr double longest_unseen_s = 2.0;  // a joint missing for longer gets a warning

/// The options of `kinalign denoise`. `in` is empty in a live run.
struct Denoise {
  std::vector<std::string> in;
  std::string model, stream;
  bool project = false;
  LiveWords live;
};

/// The command line of `kinalign denoise`. A live run may end without a file; a run on a file may
/// not.
Usage describe_denoise(Denoise& o) {
  Usage usage;
  usage.positionals = {{"IN", "a take, a recording, a manifest or a Kinect's file", &o.in, 0}};
  usage.flags = {
      text_flag(
          "model",
          "a model's file, or the name of a shipped model (default: the shipped model that fits)",
          &o.model, "FILE"),
      text_flag("stream", "stream of joints (default: the only one)", &o.stream, "NAME"),
      {"project",
       "keep standing feet in place and bone lengths constant, by steps in the hidden space of a "
       "model of cnn or cnn-manifold",
       &o.project}};
  for (Field& field : live_flags(o.live)) usage.flags.push_back(std::move(field));
  usage.check = [&o](const Common& common, const Sources&) -> Result<void> {
    KA_TRY(check(o.live, o.in));
    // Projection optimises the whole motion at once, which a live run does not have.
    if (!o.live.live.empty() && o.project) {
      return Failure(
          Error{"--project", 0, "a file or a take, because it needs the whole motion", "--live"});
    }
    // A live run sends its frames as it goes, so a file is optional. TRC is not offered there.
    if (!o.live.live.empty() && (common.out.empty() || common.out.ends_with(".bvh"))) return {};
    if (!o.live.live.empty()) {
      return Failure(Error{"-o", 0, "-o FILE.bvh, with --live", shown(common.out)});
    }
    if (common.out.ends_with(".bvh") || common.out.ends_with(".trc")) return {};
    return Failure(
        Error{"-o", 0, "-o FILE.bvh or FILE.trc", common.out.empty() ? "none" : shown(common.out)});
  };
  return usage;
}

/// The denoised joints with their input, and the JSON about them.
/// Input [T,Jin] and answer [T,Jout] have the same T frames on the model's grid.
struct Cleaned {
  EvenFrames input;
  Denoised answer;
  Json about;
};

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

/// The distances, m, by which the model moved joints that the Kinect tracked. An output joint is
/// compared with the input joint of the same name.
/// This measure of the model's work needs no truth.
std::vector<double> moves(const DenoiseModel& model, const Cleaned& cleaned) {
  std::vector<double> out;
  const std::size_t in = model.layout.inputs.size(), joints = model.layout.outputs.size();
  const auto names = kinect_names(model.layout.outputs);
  for (std::size_t t = 0; t < cleaned.input.body.frames(); ++t) {
    for (std::size_t j = 0; j < joints; ++j) {
      const auto from = index_of(model.layout.inputs, names[j]);
      // 2 is the state "tracked". A joint that the Kinect only guessed is expected to be moved far.
      if (!from || cleaned.input.body.seen[t * in + *from] != 2) continue;
      const float* a = &cleaned.input.body.positions[(t * in + *from) * 3];
      const float* b = &cleaned.answer.positions[(t * joints + j) * 3];
      out.push_back(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
    }
  }
  return out;
}

/// The stated standard deviations, m, of output joints whose input joint was seen. Others are left
/// out: a network does not know how far off a guess is.
std::vector<double> spread_of_seen(const DenoiseModel& model, const Cleaned& cleaned) {
  std::vector<double> out;
  const std::size_t in = model.layout.inputs.size(), joints = model.layout.outputs.size();
  const auto stands = inputs_of_outputs(model.layout);
  for (std::size_t i = 0; i < cleaned.answer.spread.size(); ++i) {
    // Entry i is joint i % joints of frame i / joints. `stands` gives the input joint that stands
    // for it.
    const std::size_t seen = i / joints * in + stands[i % joints];
    if (cleaned.input.body.seen[seen] != 0) {
      out.push_back(static_cast<double>(cleaned.answer.spread[i]));
    }
  }
  return out;
}

/// The input joints that were missing for `longest_unseen_s` or longer, each with its longest time,
/// s.
Json long_missing(const DenoiseModel& model, const EvenFrames& input) {
  // An object keeps the names of joints as its keys, in the order of the layout.
  Json out = Json::object();
  const std::size_t joints = model.layout.inputs.size();
  for (std::size_t j = 0; j < joints; ++j) {
    std::size_t run = 0, longest = 0;
    for (std::size_t t = 0; t < input.body.frames(); ++t) {
      // A frame with the joint ends the stretch; the longest one is kept.
      run = input.body.seen[t * joints + j] == 0 ? run + 1 : 0;
      longest = std::max(longest, run);
    }
    const double seconds = static_cast<double>(longest) / input.rate_hz;
    if (seconds >= longest_unseen_s) out[model.layout.inputs[j]] = seconds;
  }
  return out;
}

/// A warning that concerns more joints states their number instead of their names.
constexpr std::size_t most_named = 4;

/// One warning for all joints that were missing for the same time.
std::vector<std::string> missing_warnings(const Json& long_missing) {
  std::map<std::string, std::vector<std::string>> joints;
  // Joints that vanish together, such as a whole leg behind a table, get one line.
  for (const auto& [joint, seconds] : long_missing.items()) {
    joints[fmt::format("{:.1f}", seconds.get<double>())].push_back(harmless(joint));
  }
  std::vector<std::string> out;
  for (const auto& [seconds, names] : joints) {
    const std::string who = names.size() > most_named ? fmt::format("{} joints", names.size())
                                                      : fmt::format("{}", fmt::join(names, ", "));
    const bool is_one = names.size() == 1;
    out.push_back(fmt::format("{} {} missing for {} s: during this time {} a guess", who,
                              is_one ? "is" : "are", seconds, is_one ? "it is" : "they are"));
  }
  return out;
}

/// The JSON about an answer. `warnings`: those about the input.
/// Shares are fractions from 0 to 1 over all input cells [T,Jin]; distances are in centimetres.
Json about(const DenoiseModel& model, const Cleaned& cleaned, const std::string& stream,
           std::vector<std::string> warnings) {
  const auto& seen = cleaned.input.body.seen;
  const auto missing = std::count(seen.begin(), seen.end(), 0);
  const auto inferred = std::count(seen.begin(), seen.end(), 1);
  const double all = static_cast<double>(std::max<std::size_t>(seen.size(), 1));
  Json out{{"stream", stream},
           {"frames", cleaned.input.body.frames()},
           {"rate_hz", cleaned.input.rate_hz},
           {"joints", model.layout.outputs.size()},
           {"method", model.facts.method},
           {"missing", static_cast<double>(missing) / all},
           {"inferred", static_cast<double>(inferred) / all},
           {"moved_cm", 100.0 * mean_of(moves(model, cleaned))},
           {"long_missing_s", long_missing(model, cleaned.input)}};
  for (std::string& one : missing_warnings(out.at("long_missing_s"))) {
    warnings.push_back(std::move(one));
  }
  out["warnings"] = std::move(warnings);
  const std::vector<double> spread = spread_of_seen(model, cleaned);
  // radius_90 turns a standard deviation per axis into the radius that contains 90 % of the errors.
  if (!spread.empty()) out["radius_90_cm"] = 100.0 * radius_90 * mean_of(spread);
  return out;
}

/// The joints that a model gets as input.
struct SeenJoints {
  std::string stream;
  EvenFrames frames;
  std::vector<std::string> warnings{};
};

/// Brings the joints to the model's grid. Errors name the file `in`.
/// `points` is passed as a result, so takes and other files are handled in one expression.
Result<SeenJoints> seen_joints(const DenoiseLayout& layout, Result<NamedPoints> points,
                               const std::string& in) {
  const NamedPoints named = KA_TRY(std::move(points));
  // The joints are renamed to the Kinect's names first, since layouts of files name them
  // differently.
  auto frames = even_frames(layout.inputs, kinect_names(named.joints), named.frames,
                            {layout.rate_hz, longest_gap_s});
  if (frames) {
    std::vector<std::string> warnings = warnings_of(named, *frames);
    return SeenJoints{named.stream, *std::move(frames), std::move(warnings)};
  }
  Error error = frames.error();
  if (error.file.empty()) error.file = in;
  return Failure(error);
}

/// Does the same for a take, which is read in a child process.
Result<SeenJoints> seen_joints_of_take(const DenoiseLayout& layout, const std::string& in,
                                       const std::string& stream, Call& call) {
  // The child sends positions and states as a SafeTensors file, which is far more compact than
  // JSON.
  const auto work = [&]() -> Result<std::string> {
    const SeenJoints seen =
        KA_TRY(seen_joints(layout, points_of_take(call.surroundings.files, in, stream), in));
    const JointFrames& body = seen.frames.body;
    TensorFile out;
    out.metadata = {{"stream", seen.stream},
                    {"start_ns", std::to_string(to_ns(seen.frames.start))},
                    {"warnings", Json(seen.warnings).dump()}};
    out.tensors["positions"] = {{body.frames(), body.joints, 3}, body.positions};
    out.tensors["seen"] = {{body.frames(), body.joints}, {body.seen.begin(), body.seen.end()}};
    return write_safetensors(out);
  };
  TensorFile answer_file =
      KA_TRY(read_safetensors(KA_TRY(run_guarded(GuardLimits{}, blame(in), work)), in));
  SeenJoints out;
  out.stream = answer_file.metadata["stream"];
  out.frames.start = utc_time(std::stoll(answer_file.metadata["start_ns"]));
  Json::parse(answer_file.metadata["warnings"]).get_to(out.warnings);
  out.frames.rate_hz = layout.rate_hz;
  // The layout is known here, so the child does not repeat it.
  out.frames.body.joints = layout.inputs.size();
  out.frames.body.positions = std::move(answer_file.tensors["positions"].values);
  const auto& seen = answer_file.tensors["seen"].values;
  out.frames.body.seen.assign(seen.begin(), seen.end());
  return out;
}

/// The model's answer, projected onto constraints, then steadied like every answer. `path`: the
/// model's file.
/// The projection is computed by kinalign-learn, because it needs gradients of the network.
Result<Denoised> clean_with_constraints(const DenoiseModel& model, const std::string& path,
                                        const JointFrames& body, Json& about, Call& call) {
  const auto projected = KA_TRY(projected_answers(path, model.layout, {body}, call));
  about["projected"] = {{"feet_cm", {projected.before.feet_cm, projected.after.feet_cm}},
                        {"bone_cm", {projected.before.bone_cm, projected.after.bone_cm}}};
  // Projected answers exist for the body and its mirror image, which are all that the steadier asks
  // for.
  const Steadier steadier(model.steadying, model.layout);
  return steadier.steadied(projected.answer, body, projected.answer(body));
}

/// Writes the joints as points. Frame t is stamped t / rate after the first frame.
Result<void> write_trc(FileSystem& files, const DenoiseModel& model, const Cleaned& cleaned,
                       const Common& common) {
  TextOut out = KA_TRY(TextOut::create(files, common.out, common.overwrite()));
  const std::size_t joints = model.layout.outputs.size(), frames = cleaned.input.body.frames();
  PointFrames points;
  for (std::size_t t = 0; t < frames; ++t) {
    // Each stamp is computed from the first one, so rounding does not add up.
    const double ns = static_cast<double>(t) * 1e9 / cleaned.input.rate_hz;
    points.stamps.push_back(cleaned.input.start + Duration(std::llround(ns)));
  }
  points.positions.assign(cleaned.answer.positions.begin(), cleaned.answer.positions.end());
  // The model answers every joint in every frame, so all of them count as tracked.
  points.state.assign(frames * joints, Tracking::tracked);
  TrcWriter writer =
      KA_TRY(TrcWriter::begin({model.layout.outputs, cleaned.input.rate_hz, frames,
                               std::string(file_name(common.out)), cleaned.input.start},
                              out));
  KA_TRY(writer.append(points));
  KA_TRY(writer.finish());
  return out.commit();
}

/// Writes the joints as a BVH, whose bones have constant lengths.
Result<void> write_skeleton(FileSystem& files, const DenoiseModel& model, const Cleaned& cleaned,
                            const Common& common) {
  OutputFile file = KA_TRY(OutputFile::create(files, common.out, common.overwrite()));
  const DenoiseLayout& layout = model.layout;
  // A BVH has rotations and constant bones. Positions are turned into them here.
  Clip clip = KA_TRY(skeleton_of_points({layout.outputs, layout.parents}, cleaned.answer.positions,
                                        cleaned.input.start, layout.rate_hz));
  KA_TRY(write_bvh(bvh_from_clip(std::move(clip), 1.0 / layout.rate_hz),
                   [&](std::string_view text) { return file.write(text); }));
  return file.commit();
}

Result<void> write_cleaned(FileSystem& files, const DenoiseModel& model, const Cleaned& cleaned,
                           const Common& common) {
  return common.out.ends_with(".trc") ? write_trc(files, model, cleaned, common)
                                      : write_skeleton(files, model, cleaned, common);
}

/// Prints the summary: frames, joints, missing input, stated spread and, with --project,
/// constraints before and after.
void print(const Json& about, const std::string& out, Call& call) {
  std::string text = fmt::format(
      "{}: {} frames at {:g} Hz, {} joints\ncleaned  joints moved by {:.1f} cm on average, bones "
      "of one "
      "length each\n",
      harmless(out), grouped(about.at("frames").get<std::size_t>()),
      about.at("rate_hz").get<double>(), about.at("joints").get<std::size_t>(),
      about.at("moved_cm").get<double>());
  text += fmt::format("seen     {:.1f} % missing, {:.1f} % inferred\n",
                      100.0 * about.at("missing").get<double>(),
                      100.0 * about.at("inferred").get<double>());
  // The member is missing if the model states no spread.
  if (about.contains("radius_90_cm")) {
    text += fmt::format(
        "sure     9 of 10 visible joints lie within {:.1f} cm, if the data is like the training "
        "data\n",
        about.at("radius_90_cm").get<double>());
  }
  if (about.contains("projected")) {
    // Index 0 is the value before the projection, 1 the value after it.
    const auto value_of = [&](const char* what, std::size_t i) {
      return about.at("projected").at(what).at(i).get<double>();
    };
    text += fmt::format(
        "project  standing feet move {:.2f} cm per frame, before {:.2f}; bones vary by {:.1f} cm, "
        "before {:.1f}\n",
        value_of("feet_cm", 1), value_of("feet_cm", 0), value_of("bone_cm", 1),
        value_of("bone_cm", 0));
  }
  print_answer(std::move(text), about, call);
}

Result<SeenJoints> seen_joints_of_file(const DenoiseLayout& layout, const Denoise& o, Call& call) {
  const std::string& in = o.in.front();
  if (KA_TRY(kind_of_file(call.surroundings.files, in)) == FileKind::take) {
    return seen_joints_of_take(layout, in, o.stream, call);
  }
  return seen_joints(layout, points_of_file(in, o.stream, call), in);
}

/// Denoises the samples that a running record receives. Writes a file if -o names one.
/// The clip grows during the run and is written at its end, also after Ctrl-C.
Result<int> clean_live(Denoiser& denoiser, const Denoise& o, Call& call) {
  const LiveJob job{o.live, "", o.stream, {}};
  // The output is tested before the run starts.
  KA_TRY(keep_free(call));
  Clip clip;
  const Json about = KA_TRY(run_live_denoise(denoiser, job, clip, call));
  const std::string& out = call.common.out;
  if (!out.empty()) {
    KA_TRY(write_answer(std::move(clip), denoiser.model().layout.rate_hz, o.model, call));
    call.console.wrote(out);
  }
  // Progress lines end with the run; this summary is the last output.
  print_live(
      fmt::format("{}: {} frames at {:g} Hz, {} joints\nseen     {:.1f} % missing, {:.1f} % "
                  "inferred\n",
                  out.empty() ? "live" : harmless(out),
                  grouped(about.at("frames").get<std::size_t>()), about.at("rate_hz").get<double>(),
                  about.at("joints").get<std::size_t>(), 100.0 * about.at("missing").get<double>(),
                  100.0 * about.at("inferred").get<double>()) +
          live_lines(about),
      about, call);
  return about.at("warnings").empty() ? 0 : 1;
}

/// Denoises one file and writes the result. The exit code is 1 if there were warnings.
Result<int> run_denoise(Denoise& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  // The shipped model is the default, so the verb works without any flag.
  o.model = KA_TRY(model_named(o.model, "denoise"));
  const std::string bytes = KA_TRY(read_whole(files, o.model, most_model_bytes));
  // make() checks the whole model, so a wrong file fails before any input is read.
  Denoiser denoiser = KA_TRY(Denoiser::make(KA_TRY(read_denoise_model(bytes, o.model))));
  if (!o.live.live.empty()) return clean_live(denoiser, o, call);
  KA_TRY(keep_inputs(call.common.out, o.in));
  const DenoiseModel& model = denoiser.model();
  SeenJoints seen = KA_TRY(seen_joints_of_file(model.layout, o, call));
  Cleaned cleaned{std::move(seen.frames), {}, Json::object()};
  // The members about the projection are kept apart, since about() makes a new object.
  Json of_projection = Json::object();
  cleaned.answer =
      o.project
          ? KA_TRY(clean_with_constraints(model, o.model, cleaned.input.body, of_projection, call))
          : denoiser.clean(cleaned.input.body);
  cleaned.about = about(model, cleaned, seen.stream, std::move(seen.warnings));
  cleaned.about.update(of_projection);
  KA_TRY(write_cleaned(files, model, cleaned, call.common));
  call.console.wrote(call.common.out);
  print(cleaned.about, call.common.out, call);
  return cleaned.about.at("warnings").empty() ? 0 : 1;
}

}  // namespace

/// The verb `kinalign denoise`.
Verb denoise_verb() {
  return make_verb<Denoise>(
      {.name = "denoise",
       .summary = "clean a Kinect's skeleton and give it bones of constant length",
       .text = "A model moves rough joints to the positions that a precise system would have "
               "measured. The new file has the joints and the rate of the model. If a joint is "
               "missing for 2 s or longer, a warning names it and the exit code is 1. --project "
               "needs the program kinalign-learn.",
       .examples =
           {{"kinalign denoise kinect.csv -o clean.bvh", "a skeleton that Blender opens"},
            {"kinalign denoise take.h5 -o clean.trc --stream kinect --model own.safetensors",
             "a take's stream, with a model of your own"},
            {"kinalign denoise kinect.csv -o clean.bvh --model cnn.safetensors --project",
             "keeps standing feet in place"},
            {"kinalign denoise --live 7040 -o clean.bvh",
             "live data from a kinalign record with --live-port 7040"}},
       .common = {"out", "force", "json"}},
      describe_denoise, run_denoise);
}

}  // namespace kinalign
