// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/learn/eval_methods.h"

#include "apps/kinalign/learn/projected.h"
#include "apps/kinalign/verbs/describe_model.h"

#include "kinalign/compare/linear.h"
#include "kinalign/models/filters.h"
#include "kinalign/models/joint_names.h"

#include <algorithm>
#include <functional>
#include <map>
#include <memory>

namespace kinalign {

namespace {

constexpr std::string_view projects = "+project";

/// Makes a method without a model: it filters the input and answers with the input joint that
/// corresponds to each output joint. `layout` must live longer than the returned function.
Answer filtered(const DenoiseLayout& layout, const std::function<void(JointFrames&)>& filter) {
  return [&layout, filter](const JointFrames& body) {
    JointFrames copy = body;
    // A filter needs a position in every frame, so missing joints are filled first.
    fill_missing(copy, false);
    filter(copy);
    return Denoised{base_joints(layout, std::move(copy)), {}};
  };
}

/// The pairs from which the method learns. They are chosen by take: a take may have several pairs,
/// which are all used or all left out.
std::vector<const Pair*> learnt_of(const EvalTask& task) {
  std::vector<const Pair*> out;
  for (const Pair& pair : task.pairs) {
    const auto& learnt = task.training.learnt;
    if (std::find(learnt.begin(), learnt.end(), pair.take) != learnt.end()) out.push_back(&pair);
  }
  return out;
}

/// The inputs of all other takes. The projection computes the answers to them in advance. They
/// include the takes that are only used to stop a training in time.
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

/// All methods: first those without training, then trained ones. A trained method with a hidden
/// space also has a variant with projection. The names appear in commands and tables, so they must
/// not change.
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
      out.push_back({one.name, one.summary});
      if (one.has_code) {
        out.push_back({one.name + std::string(projects), "the same, projected to constraints"});
      }
    }
    return out;
  }();
  return all;
}

bool is_trained(const std::string& method) { return find_trained(trained_part(method)) != nullptr; }

std::string trained_part(const std::string& method) {
  return method.ends_with(projects) ? method.substr(0, method.size() - projects.size()) : method;
}

// The layout decides which joints are compared. All methods of a run have the same layout.
Result<DenoiseLayout> eval_layout(const Pairs& pairs) {
  DenoiseLayout out =
      KA_TRY(denoise_layout(pairs.inputs, pairs.outputs, pairs.rate_hz, pairs.parents));
  // Steadying gives bones a constant length. Its bones connect only joints that a Kinect has,
  // because filters do not answer the suit's joints in between. If no joint has a Kinect's name,
  // the suit's own bones are used.
  auto bones = kinect_parents_of(kinect_names(out.outputs));
  const bool known = std::any_of(bones.begin(), bones.end(), [](int one) { return one >= 0; });
  if (known) out.parents = std::move(bones);
  return out;
}

Result<Answer> trained_answer(const std::string& method, const std::string& file,
                              const DenoiseLayout& layout, const std::vector<JointFrames>& bodies,
                              Call& call) {
  // All bodies are projected in one run of kinalign-learn, because starting it takes a second.
  if (method.ends_with(projects)) {
    return KA_TRY(projected_answers(file, layout, bodies, call)).answer;
  }
  return answer_of_model(KA_TRY(read_whole(call.surroundings.files, file, most_model_bytes)), file);
}

std::array<DenoiseMarks, 2> both_marks(const DenoiseMarker& marker, const Steadier& steadier,
                                       const Answer& answer, const Pair& pair, Denoised plain) {
  // The marks are computed before the plain answer is moved.
  const DenoiseMarks marks = marker.marks_of(pair, plain.positions, plain.spread);
  const Denoised steadied = steadier.steadied(answer, pair.input, std::move(plain));
  return {marks, marker.marks_of(pair, steadied.positions, steadied.spread)};
}

Result<Answer> answer_of_model(const std::string& bytes, const std::string& name) {
  auto denoiser =
      // The function shares the Denoiser, which can't be copied. Only one thread at a time may call
      // the function.
      std::make_shared<Denoiser>(KA_TRY(Denoiser::make(KA_TRY(read_denoise_model(bytes, name)))));
  return Answer([denoiser](const JointFrames& body) { return denoiser->answer(body); });
}

// Each branch returns a function that answers for one body. Fitted methods keep their coefficients
// in it.
Result<Answer> make_answer(const EvalTask& task, Call& call) {
  const std::string& method = task.training.method;
  const DenoiseLayout& layout = task.layout;
  const double rate = layout.rate_hz;
  const std::map<std::string, std::function<void(JointFrames&)>> filters{
      // The method "raw" changes nothing, so its errors are those of the Kinect.
      {"raw", [](JointFrames&) {}},
      {"hold", [rate](JointFrames& body) { hold(body, rate); }},
      {"savgol",
       [&](JointFrames& body) { smooth(layout.smoothing, 3 * body.joints, body.positions); }},
      {"one-euro", [rate](JointFrames& body) { one_euro({}, body, rate); }},
      {"kalman", [rate](JointFrames& body) { kalman_smooth({}, body, rate); }}};
  if (const auto filter = filters.find(method); filter != filters.end()) {
    return filtered(layout, filter->second);
  }
  if (method == "offset" || method == "offset+kalman") {
    // "offset" and "ridge" learn from the same takes as the networks, so that the comparison is
    // fair.
    const auto fit = std::make_shared<MeanOffset>(layout, learnt_of(task));
    const bool smoothed = method != "offset";
    return Answer([fit, smoothed, &layout, rate](const JointFrames& body) {
      JointFrames copy = body;
      // In "offset+kalman" the filter comes first, then the offset.
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
  // All other names belong to trained methods, because the parser has refused unknown names.
  TrainingWanted wanted = task.training;
  wanted.method = trained_part(method);
  const std::string model = KA_TRY(trained_model(wanted, call));
  return trained_answer(method, model, layout, tested_of(task), call);
}

}  // namespace kinalign
