// SPDX-License-Identifier: Apache-2.0
// The program's help: help pages, the man page, completions. All are made from the verbs'
// descriptions.
#pragma once

#include "apps/cli/verb.h"

#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Breaks `text` into lines of at most `width` characters; all but the first begin at column
/// `indent`.
std::string wrapped(std::string_view text, std::size_t indent, std::size_t width = 80);

/// The version, such as "0.1.0".
std::string program_version();

/// The list of verbs; each group is one line.
std::string overview(const std::vector<Verb>& verbs);
/// The verbs of one group, such as "dataset".
std::string group_page(const std::string& group, const std::vector<Verb>& verbs);

/// The page of one verb. Its first line is an example that works.
std::string help_page(const Page& page, const Usage& usage);

/// The page kinalign(1) in roff.
/// Help, man page and completions can't disagree, because none of them is written by hand.
std::string man_page(const std::vector<Verb>& verbs);

/// A script for `shell`: bash, zsh or fish.
std::string completion_script(const std::string& shell, const std::vector<Verb>& verbs);

/// The usage line of a help page: `kinalign align FILE [FLAGS]`.
std::string usage_line(const Page& page, const Usage& usage);

/// A flag as a page lists it: "-o, --out TEXT", and its meaning with the default.
struct FlagText {
  std::string flag, meaning;
};
FlagText flag_text(const Field& field);

}  // namespace kinalign
