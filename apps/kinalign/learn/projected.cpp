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

// The limit protects the memory. It holds answers for all bodies and their mirror images.
constexpr std::size_t most_projected_bytes = std::size_t{4} << 30U;

/// Computed answers, found by the positions of the body.
/// The answer function has no index, only the body itself. Equal positions are the same body, so
/// they serve as the key.
using KnownAnswers = std::map<std::vector<float>, std::vector<float>>;

/// The bodies as a SafeTensors file for kinalign-learn: "0.positions" [T,J,3] m and "0.seen" [T,J],
/// and so on.
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
  // A steadier asks for the mirror image as well. It is computed in the same run.
  for (const JointFrames& body : bodies) {
    all.push_back(body);
    mirror(all.back(), mirror_partners(layout.inputs));
  }
  const Scratch scratch = KA_TRY(Scratch::make());
  const std::string in = scratch.name() + "/bodies.safetensors",
                    out = scratch.name() + "/answers.safetensors",
                    job_file = scratch.name() + "/job.json";
  // "project" in place of "method" tells the worker not to train.
  const Json job{{"schema", "kinalign.training_job/1"},
                 {"project", path},
                 {"bodies", in},
                 {"out", out},
                 {"threads", call.jobs}};
  KA_TRY(write_whole(files, in, written_bodies(all), Overwrite::yes));
  KA_TRY(write_whole(files, job_file, job.dump(), Overwrite::yes));
  // The last line has the gaps before and after. The answers themselves are in the file.
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
    // at() throws for an unknown body. Callers ask only for those that they gave.
    return Denoised{known->at(body.positions), {}};
  };
  result.before = gaps_of(last.value("before", Json::object()));
  result.after = gaps_of(last.value("after", Json::object()));
  return result;
}

}  // namespace kinalign
