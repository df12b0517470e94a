// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/distinct_names.h"

#include <map>
#include <set>
#include <string_view>

namespace kinalign {

std::vector<std::string> distinct_names(const std::vector<std::string>& names) {
  // All given names count as taken from the start, so that a new name never equals one of them.
  std::set<std::string> taken(names.begin(), names.end());
  std::map<std::string_view, int> times;
  std::vector<std::string> out;
  for (const std::string& name : names) {
    int& number = times[name];
    std::string other = name;
    while (++number > 1 && !taken.insert(other = name + "#" + std::to_string(number)).second) {
    }
    out.push_back(std::move(other));
  }
  return out;
}

}  // namespace kinalign
