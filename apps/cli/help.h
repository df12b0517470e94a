// SPDX-License-Identifier: Apache-2.0
// What the program says of itself: help pages, the man page, completions. All from the verbs'
// descriptions.
#pragma once

#include "apps/cli/verb.h"

#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// `text` in lines of at most `width` characters, those behind the first one moved to `indent`.
std::string wrapped(std::string_view text, std::size_t indent, std::size_t width = 80);

/// "0.1.0"
std::string program_version();

/// The list of verbs; a group of them is one line.
std::string overview(const std::vector<Verb>& verbs);
/// The verbs of one group: "dataset".
std::string group_page(const std::string& group, const std::vector<Verb>& verbs);

/// One verb's page; its first line is an example that works.
std::string help_page(const Page& page, const Usage& usage);

/// kinalign(1) in roff.
std::string man_page(const std::vector<Verb>& verbs);

/// A script for `shell`: bash, zsh or fish.
std::string completion_script(const std::string& shell, const std::vector<Verb>& verbs);

/// `kinalign align [--gap-ms NUMBER] ... FILE`, without the flags: what --help's usage line says.
std::string usage_line(const Page& page, const Usage& usage);

/// A flag as a page lists it: "-o, --out TEXT", its meaning with the standard value.
struct FlagText {
  std::string flag, meaning;
};
FlagText flag_text(const Field& field);

}  // namespace kinalign
