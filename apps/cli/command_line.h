// SPDX-License-Identifier: Apache-2.0
// From the words of a command line to a verb's options. Written by hand: the flags come from core's
// Fields, errors must name the nearest known flag and the range, and each value must know where it
// came from; a library for command lines would be told all of that by more code than this.
#pragma once

#include "apps/cli/verb.h"

#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// The flags that a verb takes beside its own, for parsing and for its help page.
Fields common_fields(Common& common, const Page& page);

/// Options that may also come from the environment and from files, of those above.
bool is_common_setting(const std::string& name);

/// What stood on the command line.
struct Parsed {
  bool help = false;
  Sources given;  // options set by a flag
};

/// Fails with an Error whose `file` is the flag or word at fault: "--gap-ms". Flags as
/// `--flag value` or `--flag=value`; switches as `--flag` or `--no-flag`; -o, -q, -v, -h; words
/// behind `--` are no flags.
Result<Parsed> parse_words(const std::vector<std::string>& words, const Usage& usage,
                           const Fields& common);

/// The line under an unknown word: "did you mean align?"; empty where nothing is near.
std::string suggestion(const std::string& word, const std::vector<std::string>& known);

}  // namespace kinalign
