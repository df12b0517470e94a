// SPDX-License-Identifier: Apache-2.0
// Derives subject, action and run of a motion file from its folder and name, for collections that
// state them nowhere else.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The facts that a name states.
struct FileSays {
  std::string subject;    // empty: not stated
  std::string action;     // empty: the name is only a number
  std::uint32_t run = 0;  // 0: none
};

/// The results in the order of `names`, "anna/walk_02.bvh":
///   01_02.bvh                CMU's: subject 01, run 2, no action
///   down_1Char00.bvh         Perception Neuron's: action down, run 1; Char00 is a character
///   walk_02.bvh              action walk, run 2
///   anna/walk.bvh            subject anna, if all files lie in folders: the topmost folders that
///                            differ are the people's, or all files are in this one folder
std::vector<FileSays> read_file_names(const std::vector<std::string>& names);

/// The value of a text of one to six digits; absent for other texts.
std::optional<std::uint32_t> whole_number(std::string_view text);

/// Takes `lead` and that many digits, at most six, off the front of `text`. False if they are not
/// there; `text` is unchanged then.
bool take_digits(std::string_view& text, std::string_view lead, std::size_t digits,
                 std::uint32_t& out);

}  // namespace kinalign
