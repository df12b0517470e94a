// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/take_inputs.h"

#include "kinalign/core/file_version.h"
#include "kinalign/sources/input_facts.h"
#include "kinalign/take/remembered_path.h"

#include <algorithm>

namespace kinalign {

std::vector<TakeInput> inputs_of(Manifest manifest, const std::string& base,
                                 const std::vector<InputFacts>& known) {
  std::vector<TakeInput> out;
  const auto has = [&out](const std::string& name) {
    return std::any_of(out.begin(), out.end(),
                       [&](const TakeInput& one) { return one.name == name; });
  };
  for (const std::string* path : paths_in(manifest)) {
    const std::string name = remembered_path(*path);
    if (!has(name)) out.push_back({name, path_in(base, *path)});
  }
  const std::string beside(out.empty() ? base : kinalign::folder(out.front().path));
  for (const InputFacts& input : known) {
    if (!has(input.name)) out.push_back({input.name, beside + std::string(file_name(input.name))});
  }
  return out;
}

Result<bool> same_inputs(FileSystem& files, const std::vector<TakeInput>& inputs,
                         const TakeSummary& summary, std::int64_t made_ns,
                         const Progress& progress) {
  if (inputs.size() != summary.inputs.size()) return false;
  for (const TakeInput& input : inputs) {
    const auto known =
        std::find_if(summary.inputs.begin(), summary.inputs.end(),
                     [&](const InputFacts& facts) { return facts.name == input.name; });
    const auto version = version_of(input.path);
    if (known == summary.inputs.end() || !version || version->size != known->bytes) return false;
    if (version->changed_ns < made_ns) continue;
    if (KA_TRY(facts_of(files, input.path, "hashing", progress)).sha256 != known->sha256)
      return false;
  }
  return true;
}

}  // namespace kinalign
