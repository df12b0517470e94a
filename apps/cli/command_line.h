// SPDX-License-Identifier: Apache-2.0
// Turns the words of a command line into a verb's options. It is written by hand: the flags come
// from core's Fields, errors name the nearest known flag and the range, and each value knows its
// source. Teaching a library all of that would take more code.
#pragma once

#include "apps/cli/verb.h"

#include <string>
#include <vector>

namespace kinalign {

/// The flags that a verb takes besides its own, for parsing and for its help page.
Fields common_fields(Common& common, const Page& page);

/// True for those of the common options that the environment and settings files may set.
bool is_common_setting(const std::string& name);

/// The result of parsing a command line.
struct Parsed {
  bool help = false;
  Sources given;  // options set by a flag
};

/// Fails with an Error whose `file` is the flag or word at fault: "--gap-ms". Accepts `--flag
/// value`, `--flag=value`, switches as `--flag` or `--no-flag`, and -o, -q, -v, -h. Words after
/// `--` are not flags.
/// The values go straight into the options to which the fields point.
Result<Parsed> parse_words(const std::vector<std::string>& words, const Usage& usage,
                           const Fields& common);

/// The line below an unknown word: "did you mean align?". Empty if no known word is similar.
std::string suggestion(const std::string& word, const std::vector<std::string>& known);

}  // namespace kinalign
