// SPDX-License-Identifier: Apache-2.0
// Turns the words of a command line into a verb's options. The parser is written by hand, because
// no library uses core's Fields. Its errors name the most similar flag and the allowed range, and
// each option knows the source of its value.
#pragma once

#include "apps/cli/verb.h"

#include <string>
#include <vector>

namespace kinalign {

/// The flags that a verb shares with other verbs, for parsing and for the help page.
Fields common_fields(Common& common, const Page& page);

/// True if the environment and settings files may set this common option.
bool is_common_setting(const std::string& name);

/// The result of parsing a command line.
struct Parsed {
  bool help = false;
  Sources given;  // options set by a flag
};

/// Parses the words and sets the options that the fields point to. Accepts `--flag value`,
/// `--flag=value`, `--flag` and `--no-flag` for switches, and -o, -q, -v, -h. Words after `--` are
/// not flags. If a word is wrong, the Error's `file` is that flag or word: "--gap-ms".
Result<Parsed> parse_words(const std::vector<std::string>& words, const Usage& usage,
                           const Fields& common);

/// The line printed below an unknown word: "did you mean align?". Empty if no known word is
/// similar.
std::string suggestion(const std::string& word, const std::vector<std::string>& known);

}  // namespace kinalign
