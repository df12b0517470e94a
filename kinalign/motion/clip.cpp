// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/clip.h"

#include <set>
#include <string>
#include <string_view>

namespace kinalign {

Result<void> validate(const Skeleton& skeleton) {
  const std::size_t joints = skeleton.joints();
  if (skeleton.joint_names.size() != joints || skeleton.rest_offsets.size() != joints) {
    return Failure(
        Error{"", 0, "a name, a parent and an offset for each joint", "different numbers"});
  }
  std::set<std::string_view> names;
  for (std::size_t j = 0; j < joints; ++j) {
    const int parent = skeleton.parents[j];
    if (parent < -1 || parent >= static_cast<int>(j)) {
      return Failure(Error{"", 0, "each parent before its children",
                           "joint '" + shown(skeleton.joint_names[j]) + "'"});
    }
    if (!names.insert(skeleton.joint_names[j]).second) {
      return Failure(
          Error{"", 0, "different joint names", "'" + shown(skeleton.joint_names[j]) + "' twice"});
    }
  }
  for (const EndSite& end : skeleton.end_sites) {
    if (end.parent < 0 || end.parent >= static_cast<int>(joints)) {
      return Failure(Error{"", 0, "end sites on joints of the skeleton",
                           "an end site on joint " + std::to_string(end.parent)});
    }
  }
  return {};
}

}  // namespace kinalign
