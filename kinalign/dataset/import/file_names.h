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

/// The facts that the name of a file states.
struct FileSays {
  std::string subject;    // empty: not stated
  std::string action;     // empty: the name is only a number
  std::uint32_t run = 0;  // 0: none
};

/// The facts of each name, in the order of `names`. A name may contain folders:
///   01_02.bvh                CMU's form: subject 01, run 2, no action
///   down_1Char00.bvh         Perception Neuron's form: action down, run 1; Char00 is ignored
///   walk_02.bvh              action walk, run 2
///   anna/walk.bvh            subject anna, if all files lie in folders
/// The folders of people are the topmost folders that differ between the files. If all files lie in
/// one folder, that folder is the person.
std::vector<FileSays> read_file_names(const std::vector<std::string>& names);

/// The value of a text with one to six digits; absent for other texts.
std::optional<std::uint32_t> whole_number(std::string_view text);

/// Removes `lead` and exactly `digits` digits (at most six) from the front of `text`, and stores
/// the number. If they are not there, it returns false and `text` is unchanged.
bool take_digits(std::string_view& text, std::string_view lead, std::size_t digits,
                 std::uint32_t& out);

}  // namespace kinalign
