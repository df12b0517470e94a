// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/learn/projected.h"

#include "apps/cli/console.h"
#include "apps/kinalign/learn/worker.h"
#include "apps/kinalign/verbs/scratch.h"

#include "kinalign/infer/safetensors.h"

#include <nlohmann/json.hpp>

#include <map>
#include <memory>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

// A larger file of answers is refused, to protect the memory. It has the answers to all bodies and
// their mirror images.
constexpr std::size_t most_projected_bytes = std::size_t{4} << 30U;

/// The computed answers. A function of type Answer gets only a body and no index, so the positions
/// of the body are the key.
using KnownAnswers = std::map<std::vector<float>, std::vector<float>>;

/// Writes bodies as SafeTensors for kinalign-learn: "0.positions" [frame, joint, 3] in m, "0.seen"
/// [frame, joint], "1.positions" and so on.
std::string written_bodies(const std::vector<JointFrames>& bodies) {
  TensorFile file;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const JointFrames& body = bodies[i];
    const std::size_t frames = body.frames();
    file.tensors[std::to_string(i) + ".positions"] = {{frames, body.joints, 3}, body.positions};
    file.tensors[std::to_string(i) + ".seen"] = {{frames, body.joints},
                                                 {body.seen.begin(), body.seen.end()}};
  }
  return write_safetensors(file);
}

ConstraintGaps gaps_of(const Json& json) {
  return {json.value("feet_cm", 0.0), json.value("bone_cm", 0.0)};
}

}  // namespace

Result<ProjectedAnswers> projected_answers(const std::string& path, const DenoiseLayout& layout,
                                           const std::vector<JointFrames>& bodies, Call& call) {
  FileSystem& files = call.surroundings.files;
  std::vector<JointFrames> all = bodies;
  // A Steadier also needs the answer to the mirror image, so it is computed in the same run.
  for (const JointFrames& body : bodies) {
    all.push_back(body);
    mirror(all.back(), mirror_partners(layout.inputs));
  }
  const Scratch scratch = KA_TRY(Scratch::make());
  const std::string in = scratch.name() + "/bodies.safetensors",
                    out = scratch.name() + "/answers.safetensors",
                    job_file = scratch.name() + "/job.json";
  // The member "project" in place of "method" tells kinalign-learn to project and not to train.
  const Json job{{"schema", "kinalign.training_job/1"},
                 {"project", path},
                 {"bodies", in},
                 {"out", out},
                 {"threads", call.jobs}};
  KA_TRY(write_whole(files, in, written_bodies(all), Overwrite::yes));
  KA_TRY(write_whole(files, job_file, job.dump(), Overwrite::yes));
  // The last line has the errors of the constraints before and after. The answers are in the file.
  const Json last = Json::parse(KA_TRY(run_worker(job_file, {.progress = call.console.progress()})),
                                nullptr, false);
  TensorFile answers =
      KA_TRY(read_safetensors(KA_TRY(read_whole(files, out, most_projected_bytes)), out));
  auto known = std::make_shared<KnownAnswers>();
  for (std::size_t i = 0; i < all.size(); ++i) {
    (*known)[std::move(all[i].positions)] =
        std::move(answers.tensors[std::to_string(i) + ".positions"].values);
  }
  ProjectedAnswers result;
  result.answer = [known](const JointFrames& body) {
    // at() throws for an unknown body, but callers ask only for bodies that they gave.
    return Denoised{known->at(body.positions), {}};
  };
  result.before = gaps_of(last.value("before", Json::object()));
  result.after = gaps_of(last.value("after", Json::object()));
  return result;
}

}  // namespace kinalign
