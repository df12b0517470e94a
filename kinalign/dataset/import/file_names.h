// SPDX-License-Identifier: Apache-2.0
// Subject, action and run of a file of motion by its folder and its name, for collections that
// state them nowhere else.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

struct FileSays {
  std::string subject;    // empty: nothing says it
  std::string action;     // empty: the name is a number alone
  std::uint32_t run = 0;  // 0: none
};

/// In the order of `names`, "anna/walk_02.bvh":
///   01_02.bvh                CMU's: subject 01, run 2, no action
///   down_1Char00.bvh         Perception Neuron's: action down, run 1; Char00 is a character
///   walk_02.bvh              action walk, run 2
///   anna/walk.bvh            subject anna: all files lie in folders, of which the topmost that
///                            differ are people's; or all lie in this one folder
std::vector<FileSays> read_file_names(const std::vector<std::string>& names);

}  // namespace kinalign
