// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/dataset/splits_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace kinalign {

// The lines follow others of a verb, so each begins with two spaces.
std::string splits_text(const std::vector<SplitFile>& splits) {
  std::string out;
  for (const SplitFile& one : splits) {
    out += fmt::format("  {} names {} of these takes: make it again with kinalign dataset split\n",
                       one.path, one.takes);
  }
  return out;
}

nlohmann::ordered_json splits_json(const std::vector<SplitFile>& splits) {
  auto out = nlohmann::ordered_json::array();
  for (const SplitFile& one : splits) out.push_back({{"file", one.path}, {"takes", one.takes}});
  return out;
}

}  // namespace kinalign
