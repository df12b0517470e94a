// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"
#include "apps/cli/json_text.h"
#include "apps/kinalign/learn/answer_output.h"
#include "apps/kinalign/learn/point_source.h"
#include "apps/kinalign/learn/projected.h"
#include "apps/kinalign/learn/shipped_models.h"
#include "apps/kinalign/live/live_runs.h"
#include "apps/kinalign/text/describe_file.h"
#include "apps/kinalign/verbs.h"
#include "apps/kinalign/verbs/describe_model.h"
#include "apps/kinalign/verbs/inputs.h"

#include "kinalign/evaluate/sequence.h"
#include "kinalign/formats/points/trc.h"
#include "kinalign/formats/take/guarded.h"
#include "kinalign/infer/safetensors.h"
#include "kinalign/models/denoise_model.h"
#include "kinalign/models/even_grid.h"
#include "kinalign/models/joint_names.h"
#include "kinalign/models/skeleton_of_points.h"
#include "kinalign/sources/formats.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

constexpr double longest_gap_s = 0.2;  // samples that are further apart are not interpolated

/// The options of `kinalign denoise`. A live run has an empty `in`.
struct Denoise {
  std::vector<std::string> in;
  std::string model, stream;
  bool project = false;
  LiveWords live;
};

/// The command line of `kinalign denoise`. -o may be missing in a live run only.
Usage describe_denoise(Denoise& o) {
  Usage usage;
  usage.positionals = {{"IN", "a take, a recording, a manifest or a Kinect's file", &o.in, 0}};
  usage.flags = {
      model_flag(o.model),
      text_flag("stream", "stream of joints (default: the only one)", &o.stream, "NAME"),
      {"project",
       "keep standing feet in place and bone lengths constant, by steps in the hidden space of a "
       "model of cnn or cnn-manifold",
       &o.project}};
  for (Field& field : live_flags(o.live)) usage.flags.push_back(std::move(field));
  usage.check = [&o](const Common& common, const Sources&) -> Result<void> {
    KA_TRY(check(o.live, o.in));
    // Projection needs the whole motion at once, which a live run does not have.
    if (!o.live.live.empty() && o.project) {
      return Failure(
          Error{"--project", 0, "a file or a take, because it needs the whole motion", "--live"});
    }
    if (o.live.live.empty()) return check_out(common, {".bvh", ".trc"}, "-o FILE.bvh or FILE.trc");
    // A live run can send its frames, so it needs no file. It can't write TRC.
    if (common.out.empty()) return {};
    return check_out(common, {".bvh"}, "-o FILE.bvh, with --live");
  };
  return usage;
}

/// The cleaned joints, their input, and the JSON about both. Input and answer have the same frames,
/// at the model's frame rate.
struct Cleaned {
  EvenFrames input;
  Denoised answer;
  Json about;
};

/// The mean distance, m, between the model's joints and the tracked joints of the Kinect with the
/// same names. It shows how much the model changes, and needs no truth.
Mean moves_m(const DenoiseModel& model, const Cleaned& cleaned) {
  Mean out;
  const std::size_t in = model.layout.inputs.size(), joints = model.layout.outputs.size();
  const auto names = kinect_names(model.layout.outputs);
  for (std::size_t t = 0; t < cleaned.input.body.frames(); ++t) {
    for (std::size_t j = 0; j < joints; ++j) {
      const auto from = index_of(model.layout.inputs, names[j]);
      // The state 2 means "tracked". Joints that the Kinect only guessed may move far, so they are
      // left out.
      if (!from || cleaned.input.body.seen[t * in + *from] != 2) continue;
      const float* a = &cleaned.input.body.positions[(t * in + *from) * 3];
      const float* b = &cleaned.answer.positions[(t * joints + j) * 3];
      out.add(static_cast<double>(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2])));
    }
  }
  return out;
}

/// The mean of the standard deviations, m, that the model states for its joints. Joints whose input
/// joint was missing are left out, because the network can't know the error of a guess.
Mean spread_m(const DenoiseModel& model, const Cleaned& cleaned) {
  Mean out;
  const std::size_t in = model.layout.inputs.size(), joints = model.layout.outputs.size();
  const auto stands = inputs_of_outputs(model.layout);
  for (std::size_t i = 0; i < cleaned.answer.spread.size(); ++i) {
    // The element i belongs to joint i % joints in frame i / joints. `stands` has the input joint
    // that corresponds to each output joint.
    const std::size_t seen = i / joints * in + stands[i % joints];
    if (cleaned.input.body.seen[seen] != 0) {
      out.add(static_cast<double>(cleaned.answer.spread[i]));
    }
  }
  return out;
}

/// The input joints that were missing for `longest_unseen_s` or longer, each with the longest such
/// time, s.
Json long_missing(const DenoiseModel& model, const EvenFrames& input) {
  // The keys of the object are the names of the joints, in the model's order.
  Json out = Json::object();
  const std::size_t joints = model.layout.inputs.size();
  for (std::size_t j = 0; j < joints; ++j) {
    std::size_t run = 0, longest = 0;
    for (std::size_t t = 0; t < input.body.frames(); ++t) {
      // `run` counts the frames since the joint was last seen.
      run = input.body.seen[t * joints + j] == 0 ? run + 1 : 0;
      longest = std::max(longest, run);
    }
    const double seconds = static_cast<double>(longest) / input.rate_hz;
    if (seconds >= longest_unseen_s) out[model.layout.inputs[j]] = seconds;
  }
  return out;
}

/// The JSON about an answer. `warnings`: the warnings about the input. Shares are fractions from 0
/// to 1 of all input joints in all frames. Distances are in centimetres.
Json about(const DenoiseModel& model, const Cleaned& cleaned, const std::string& stream,
           std::vector<std::string> warnings) {
  const auto& seen = cleaned.input.body.seen;
  Json out{{"stream", stream},
           {"frames", cleaned.input.body.frames()},
           {"rate_hz", cleaned.input.rate_hz},
           {"joints", model.layout.outputs.size()},
           {"method", model.facts.method},
           {"missing", share_of(seen, 0)},
           {"inferred", share_of(seen, 1)},
           {"moved_cm", 100.0 * moves_m(model, cleaned).value_or(0.0)},
           {"long_missing_s", long_missing(model, cleaned.input)}};
  for (std::string& one : missing_warnings(out.at("long_missing_s"))) {
    warnings.push_back(std::move(one));
  }
  out["warnings"] = std::move(warnings);
  const auto spread = spread_m(model, cleaned).value();
  // The factor radius_90 turns the standard deviation of one axis into the radius that contains 90
  // % of the errors.
  if (spread) out["radius_90_cm"] = 100.0 * radius_90 * *spread;
  return out;
}

/// The joints that the model gets as input, with the name of their stream.
struct SeenJoints {
  std::string stream;
  EvenFrames frames;
  std::vector<std::string> warnings{};
};

/// Reads the joints of a file and resamples them to the model's frame rate.
Result<SeenJoints> seen_joints(const DenoiseLayout& layout, const Denoise& o, Call& call) {
  const NamedPoints named = KA_TRY(points_of(o.in.front(), {o.stream}, call));
  // File formats name the joints differently, so they first get the names of a Kinect.
  EvenFrames frames = KA_TRY(even_frames(layout.inputs, kinect_names(named.joints), named.frames,
                                         {layout.rate_hz, longest_gap_s})
                                 .map_error(in_file(o.in.front())));
  std::vector<std::string> warnings = warnings_of(named, frames);
  return SeenJoints{named.stream, std::move(frames), std::move(warnings)};
}

/// Does the same with a take, which a child process reads. The child returns positions and states
/// as SafeTensors, which is much smaller than JSON.
Result<SeenJoints> seen_joints_of_take(const DenoiseLayout& layout, const Denoise& o, Call& call) {
  const std::string& in = o.in.front();
  const auto work = [&]() -> Result<std::string> {
    const SeenJoints seen = KA_TRY(seen_joints(layout, o, call));
    const JointFrames& body = seen.frames.body;
    TensorFile out;
    out.metadata["about"] = json_text(Json{{"stream", seen.stream},
                                           {"start_ns", to_ns(seen.frames.start)},
                                           {"warnings", seen.warnings}});
    out.tensors["positions"] = {{body.frames(), body.joints, 3}, body.positions};
    out.tensors["seen"] = {{body.frames(), body.joints}, {body.seen.begin(), body.seen.end()}};
    return write_safetensors(out);
  };
  TensorFile sent =
      KA_TRY(read_safetensors(KA_TRY(run_guarded(GuardLimits{}, blame(in), work)), in));
  SeenJoints out;
  try {  // the child read a file that may be damaged, so its text may be wrong
    const Json about = Json::parse(sent.metadata["about"]);
    about.at("stream").get_to(out.stream);
    out.frames.start = utc_time(about.at("start_ns").get<std::int64_t>());
    about.at("warnings").get_to(out.warnings);
  } catch (const Json::exception&) {
    return Failure(Error{in, 0, "a take that can be read", "an unreadable answer"});
  }
  out.frames.rate_hz = layout.rate_hz;
  // The model's layout gives the number of joints, so the child does not return it.
  out.frames.body.joints = layout.inputs.size();
  out.frames.body.positions = std::move(sent.tensors["positions"].values);
  const auto& seen = sent.tensors["seen"].values;
  out.frames.body.seen.assign(seen.begin(), seen.end());
  return out;
}

/// The model's answer, projected onto constraints and then steadied like every answer (Steadier).
/// kinalign-learn computes the projection, because it needs gradients of the network. `path`: the
/// model's file.
Result<Denoised> clean_with_constraints(const DenoiseModel& model, const std::string& path,
                                        const JointFrames& body, Json& about, Call& call) {
  const auto projected = KA_TRY(projected_answers(path, model.layout, {body}, call));
  about["projected"] = {{"feet_cm", {projected.before.feet_cm, projected.after.feet_cm}},
                        {"bone_cm", {projected.before.bone_cm, projected.after.bone_cm}}};
  // The steadier asks for the answers to the body and to its mirror image. Both have been
  // projected.
  const Steadier steadier(model.steadying, model.layout);
  return steadier.steadied(projected.answer, body, projected.answer(body));
}

/// Writes the joints as points in the format TRC. The stamp of frame t is t / rate after the first
/// frame.
Result<void> write_trc(FileSystem& files, const DenoiseModel& model, const Cleaned& cleaned,
                       const Common& common) {
  TextOut out = KA_TRY(TextOut::create(files, common.out, common.overwrite()));
  const std::size_t joints = model.layout.outputs.size(), frames = cleaned.input.body.frames();
  PointFrames points;
  for (std::size_t t = 0; t < frames; ++t) {
    // Each stamp is computed from the first one, so that rounding errors do not add up.
    const double ns = static_cast<double>(t) * 1e9 / cleaned.input.rate_hz;
    points.stamps.push_back(cleaned.input.start + Duration(std::llround(ns)));
  }
  points.positions.assign(cleaned.answer.positions.begin(), cleaned.answer.positions.end());
  // The model gives a position for every joint, so all joints have the state "tracked".
  points.state.assign(frames * joints, Tracking::tracked);
  TrcWriter writer =
      KA_TRY(TrcWriter::begin({model.layout.outputs, cleaned.input.rate_hz, frames,
                               std::string(file_name(common.out)), cleaned.input.start},
                              out));
  KA_TRY(writer.append(points));
  KA_TRY(writer.finish());
  return out.commit();
}

/// Writes the joints as points (TRC), or as a BVH with rotations and bones of constant length.
Result<void> write_cleaned(const DenoiseModel& model, const Cleaned& cleaned, const Denoise& o,
                           Call& call) {
  if (call.common.out.ends_with(".trc")) {
    return write_trc(call.surroundings.files, model, cleaned, call.common);
  }
  const DenoiseLayout& layout = model.layout;
  Clip clip = KA_TRY(skeleton_of_points({layout.outputs, layout.parents}, cleaned.answer.positions,
                                        cleaned.input.start, layout.rate_hz));
  return write_answer(std::move(clip), layout.rate_hz, o.model, call);
}

/// The printed summary: frames, joints, missing input and the stated deviation. With --project also
/// the errors of the constraints before and after.
std::string cleaned_text(const Json& about, const std::string& out) {
  std::string text =
      answer_line(about, out) +
      fmt::format("cleaned  joints moved by {:.1f} cm on average, bones of one length each\n",
                  about.at("moved_cm").get<double>()) +
      "seen     " + seen_text(about) + "\n";
  // A model that states no deviation has no such member.
  if (about.contains("radius_90_cm")) {
    text += fmt::format(
        "sure     9 of 10 visible joints lie within {:.1f} cm, if the data is like the training "
        "data\n",
        about.at("radius_90_cm").get<double>());
  }
  if (about.contains("projected")) {
    // [0] is the error before the projection, [1] the error after it.
    const auto value_of = [&](const char* what, std::size_t i) {
      return about.at("projected").at(what).at(i).get<double>();
    };
    text += fmt::format(
        "project  standing feet move {:.2f} cm per frame, before {:.2f}; bones vary by {:.1f} cm, "
        "before {:.1f}\n",
        value_of("feet_cm", 1), value_of("feet_cm", 0), value_of("bone_cm", 1),
        value_of("bone_cm", 0));
  }
  return text;
}

/// Cleans the data that a running `record` receives. If -o names a file, the clip is written there
/// at the end, after Ctrl-C, too.
Result<int> clean_live(Denoiser& denoiser, const Denoise& o, Call& call) {
  const LiveJob job{o.live, "", o.stream, {}};
  // A file that can't be written is an error before the run, not after it.
  KA_TRY(keep_free(call));
  Clip clip;
  const Json about = KA_TRY(run_live_denoise(denoiser, job, clip, call));
  const std::string text =
      answer_line(about, call.common.out) + "seen     " + seen_text(about) + "\n";
  return end_live(std::move(clip), o.model, text, about, call);
}

/// Cleans one file and writes the result. The exit code is 1 if there are warnings.
Result<int> run_denoise(Denoise& o, Call& call) {
  FileSystem& files = call.surroundings.files;
  // Without --model the model "denoise" is used, which comes with kinalign.
  o.model = KA_TRY(model_named(o.model, "denoise"));
  const std::string bytes = KA_TRY(read_whole(files, o.model, most_model_bytes));
  // make() checks the whole model, so a wrong model fails before any input is read.
  Denoiser denoiser = KA_TRY(Denoiser::make(KA_TRY(read_denoise_model(bytes, o.model))));
  if (!o.live.live.empty()) return clean_live(denoiser, o, call);
  KA_TRY(keep_inputs(call.common.out, o.in));
  const DenoiseModel& model = denoiser.model();
  const bool is_take = KA_TRY(kind_of_file(files, o.in.front())) == FileKind::take;
  SeenJoints seen = KA_TRY(is_take ? seen_joints_of_take(model.layout, o, call)
                                   : seen_joints(model.layout, o, call));
  Cleaned cleaned{std::move(seen.frames), {}, Json::object()};
  // about() makes a new object below, so the members about the projection are kept until then.
  Json of_projection = Json::object();
  cleaned.answer =
      o.project
          ? KA_TRY(clean_with_constraints(model, o.model, cleaned.input.body, of_projection, call))
          : denoiser.clean(cleaned.input.body);
  cleaned.about = about(model, cleaned, seen.stream, std::move(seen.warnings));
  cleaned.about.update(of_projection);
  KA_TRY(write_cleaned(model, cleaned, o, call));
  call.console.wrote(call.common.out);
  return print_answer(cleaned_text(cleaned.about, call.common.out), cleaned.about, call);
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
