// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/learn/eval_methods.h"

#include "apps/kinalign/learn/projected.h"
#include "apps/kinalign/verbs/describe_model.h"

#include "kinalign/compare/linear.h"
#include "kinalign/models/filters.h"
#include "kinalign/models/joint_names.h"

#include <algorithm>
#include <memory>

namespace kinalign {

namespace {

constexpr std::string_view projects = "+project";

/// An answer without a model: the base joints of the filtered input.
Answer filtered(const DenoiseLayout& layout, const std::function<void(JointFrames&)>& filter) {
  return [&layout, filter](const JointFrames& body) {
    JointFrames copy = body;
    fill_missing(copy, false);
    filter(copy);
    return Denoised{base_joints(layout, std::move(copy)), {}};
  };
}

/// The pairs of the takes that the method learns from.
std::vector<const Pair*> learnt_of(const EvalTask& task) {
  std::vector<const Pair*> out;
  for (const Pair& pair : task.pairs) {
    const auto& learnt = task.training.learnt;
    if (std::find(learnt.begin(), learnt.end(), pair.take) != learnt.end()) out.push_back(&pair);
  }
  return out;
}

/// The inputs of the takes that the method does not learn from; projection computes their answers
/// ahead.
std::vector<JointFrames> tested_of(const EvalTask& task) {
  std::vector<JointFrames> out;
  for (const Pair& pair : task.pairs) {
    if (std::find(task.training.learnt.begin(), task.training.learnt.end(), pair.take) ==
        task.training.learnt.end()) {
      out.push_back(pair.input);
    }
  }
  return out;
}

}  // namespace

/// Methods without training first, then the trained ones; those with a hidden space also with
/// projection.
const std::vector<EvalMethod>& eval_methods() {
  static const std::vector<EvalMethod> all = [] {
    std::vector<EvalMethod> out{{"raw", "the Kinect as it is"},
                                {"hold", "the last tracked place"},
                                {"savgol", "Savitzky-Golay, 9 frames, order 2"},
                                {"one-euro", "One-Euro filter"},
                                {"kalman", "Kalman smoother"},
                                {"offset", "mean offset of each joint"},
                                {"offset+kalman", "Kalman smoother, then the mean offset"},
                                {"ridge", "ridge regression over 9 frames"}};
    for (const TrainedMethod& one : trained_methods()) {
      if (one.task != Learns::denoise) continue;
      out.push_back({one.name, one.summary, true});
      if (one.has_code) {
        out.push_back(
            {one.name + std::string(projects), "the same, projected to constraints", true});
      }
    }
    return out;
  }();
  return all;
}

bool is_trained(const std::string& method) {
  const auto& all = eval_methods();
  return std::any_of(all.begin(), all.end(),
                     [&](const EvalMethod& one) { return one.name == method && one.trained; });
}

std::string trained_part(const std::string& method) {
  return method.ends_with(projects) ? method.substr(0, method.size() - projects.size()) : method;
}

Result<DenoiseLayout> eval_layout(const Pairs& pairs) {
  DenoiseLayout out =
      KA_TRY(denoise_layout(pairs.inputs, pairs.outputs, pairs.rate_hz, pairs.parents));
  // For the steadying, bones join only joints that a Kinect has: no filter answers the suit's
  // joints in between. If the Kinect has none of the joints, the suit's own bones count.
  auto bones = kinect_parents_of(kinect_names(out.outputs));
  const bool known = std::any_of(bones.begin(), bones.end(), [](int one) { return one >= 0; });
  if (known) out.parents = std::move(bones);
  return out;
}

Result<Answer> trained_answer(const std::string& method, const std::string& file,
                              const DenoiseLayout& layout, const std::vector<JointFrames>& bodies,
                              Call& call) {
  if (method.ends_with(projects)) {
    return KA_TRY(projected_answers(file, layout, bodies, call)).answer;
  }
  return answer_of_model(KA_TRY(read_whole(call.surroundings.files, file, most_model_bytes)), file);
}

Result<Answer> answer_of_model(const std::string& bytes, const std::string& name) {
  auto denoiser =
      std::make_shared<Denoiser>(KA_TRY(Denoiser::make(KA_TRY(read_denoise_model(bytes, name)))));
  return Answer([denoiser](const JointFrames& body) { return denoiser->answer(body); });
}

Result<Answer> make_answer(const EvalTask& task, Call& call) {
  const std::string& method = task.training.method;
  const DenoiseLayout& layout = task.layout;
  const double rate = layout.rate_hz;
  if (method == "raw") return filtered(layout, [](JointFrames&) {});
  if (method == "hold") return filtered(layout, [rate](JointFrames& body) { hold(body, rate); });
  if (method == "savgol") {
    return filtered(layout, [&layout](JointFrames& body) {
      smooth(layout.smoothing, 3 * body.joints, body.positions);
    });
  }
  if (method == "one-euro") {
    return filtered(layout, [rate](JointFrames& body) { one_euro({}, body, rate); });
  }
  if (method == "kalman") {
    return filtered(layout, [rate](JointFrames& body) { kalman_smooth({}, body, rate); });
  }
  if (method == "offset" || method == "offset+kalman") {
    const auto fit = std::make_shared<MeanOffset>(layout, learnt_of(task));
    const bool smoothed = method != "offset";
    return Answer([fit, smoothed, &layout, rate](const JointFrames& body) {
      JointFrames copy = body;
      if (smoothed) kalman_smooth({}, copy, rate);
      return Denoised{fit->clean(layout, copy), {}};
    });
  }
  if (method == "ridge") {
    const auto fit = std::make_shared<Ridge>(layout, learnt_of(task));
    return Answer([fit, &layout](const JointFrames& body) {
      return Denoised{fit->clean(layout, body), {}};
    });
  }
  TrainingWanted wanted = task.training;
  wanted.method = trained_part(method);
  const std::string model = KA_TRY(trained_model(wanted, call));
  return trained_answer(method, model, layout, tested_of(task), call);
}

}  // namespace kinalign
